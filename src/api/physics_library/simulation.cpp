#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <weft/simulation.hpp>

#include "api/physics_library/data.hpp"
#include "api/physics_library/model_input.hpp"
#include "core/archive.hpp"
#include "core/version.hpp"

namespace weft {

Simulation::Impl::Impl(std::unique_ptr<simulation::Simulation> of, std::string heading_of_state,
                       const SimulationOptions& options, MakeFrame make)
    : simulation(std::move(of)), heading(std::move(heading_of_state)), make_frame(std::move(make)) {
  for (const std::string& name : options.driven) {
    const std::size_t number = body(name);
    if (std::ranges::find(driven, number) != driven.end())
      throw std::invalid_argument(fmt::format("driven: expected each body once, got {} twice", name));
    driven.push_back(number);
    simulation->allow_drive(driven.back());
  }
  if (options.state.empty()) {
    simulation->run_preroll();
    update_current_frame(simulation->initial_report());
    return;
  }
  if (!options.state.starts_with(heading))
    throw std::invalid_argument("state: expected one that this version saved of the same, with the same driven bodies");
  try {
    restore(std::string_view(options.state).substr(heading.size()));
  } catch (const std::runtime_error& error) {
    throw std::invalid_argument(std::string("state: ") + error.what());
  }
  update_current_frame({});
}

void Simulation::Impl::set_weather(const Vector& gravity, const Vector& wind) {
  simulation->set_weather(library::gravity_of(gravity, "set_weather"), library::wind_of(wind, "set_weather"));
  weather = {gravity, wind};
}

void Simulation::Impl::restore(std::string_view bytes) {
  ByteReader reader{bytes};
  std::vector<Vector> saved;
  serialize_plain(reader, saved);
  require(saved.empty() || saved.size() == 2, "gravity and wind");
  if (!saved.empty()) set_weather(saved[0], saved[1]);
  simulation->restore(reader.bytes);
}

// Index of a rigid body. If none has this name, throws std::invalid_argument with the names of all rigid bodies.
std::size_t Simulation::Impl::body(std::string_view name) const {
  std::vector<std::string> names;
  const std::vector<model::Body>& bodies = simulation->model().bodies;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    if (bodies[b].deforms()) continue;
    if (bodies[b].name == name) return b;
    names.push_back(bodies[b].name);
  }
  throw std::invalid_argument(fmt::format("driven: expected bodies ({}), got {}", fmt::join(names, ", "), name));
}

void Simulation::Impl::update_current_frame(const simulation::FrameReport& report) {
  Frame::Data data = make_frame(*simulation);
  data.number = simulation->frame();
  data.time = simulation->time();
  data.report = library::report_of(report);
  for (std::size_t c = 0; c < simulation->model().cloths.size(); ++c) {
    simulation::ClothMotion motion = simulation->motion_of(c);
    data.velocities.emplace_back(motion.velocities.begin(), motion.velocities.end());
    data.strains.push_back(std::move(motion.strains));
  }
  data.contact_forces = simulation->contact_forces();
  current = library::make_frame(std::move(data));
}

Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;

const Frame& Simulation::frame() const {
  return *impl_->current;
}

const Frame& Simulation::advance() {
  library::with_public_errors([&] { impl_->update_current_frame(impl_->simulation->advance()); });
  return frame();
}

void Simulation::move(std::string_view body, const Pose& pose) {
  const std::size_t number = impl_->body(body);
  if (std::ranges::find(impl_->driven, number) == impl_->driven.end())
    throw std::invalid_argument(
        fmt::format("expected a driven body, got {}; name it in `driven` when the simulation is made", body));
  impl_->simulation->drive(number, library::pose_of(pose, std::string(body)));
}

void Simulation::set_weather(const Vector& gravity, const Vector& wind) {
  impl_->set_weather(gravity, wind);
}

std::string Simulation::save() const {
  ByteWriter writer{impl_->heading};
  serialize_plain(writer, impl_->weather);
  impl_->simulation->save(writer.bytes);
  return std::move(writer.bytes);
}

}  // namespace weft

namespace weft::library {

std::string heading_of(std::uint64_t hash, const SimulationOptions& options) {
  std::string heading = fmt::format("weft {} {:016x}", kVersion, hash);
  // The size of each name comes first, because names may contain any character.
  for (const std::string& name : options.driven) heading += fmt::format(" {}:{}", name.size(), name);
  return heading + '\n';
}

}  // namespace weft::library
