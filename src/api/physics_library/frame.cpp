#include <fmt/format.h>

#include <stdexcept>
#include <utility>

#include "api/physics_library/data.hpp"

namespace weft {

Frame::Frame(std::shared_ptr<const Data> data) : data_(std::move(data)) {}

int Frame::number() const {
  return data_->number;
}
double Frame::time() const {
  return data_->time;
}
const Report& Frame::report() const {
  return data_->report;
}
std::span<const Object> Frame::objects() const {
  return data_->objects;
}

const Object& Frame::object(std::string_view name) const {
  for (const Object& object : data_->objects)
    if (object.name == name) return object;
  throw std::out_of_range(
      fmt::format("expected one of the objects {}, got {}", fmt::join(library::names_of(data_->objects), ", "), name));
}

}  // namespace weft

namespace weft::library {

Report report_of(const simulation::FrameReport& report) {
  std::vector<EnclosedAir> enclosed;
  for (const simulation::EnclosedAir& air : report.enclosed) enclosed.push_back({air.cloth, air.volume, air.pressure});
  return {.wall_s = report.simulate.wall_s,
          .cpu_s = report.simulate.cpu_s,
          .steps = report.steps,
          .rejected_steps = report.rejected_steps,
          .newton_iterations = report.newton_iterations,
          .linear_iterations = report.linear_iterations,
          .near_pairs = report.proximities,
          .constraints = report.constraints,
          .min_distance = report.min_distance,
          .max_strain = report.max_strain,
          .stretch_ratio = report.stretch_ratio,
          .kinetic_energy = report.kinetic_energy,
          .potential_energy = report.potential_energy,
          .elastic_energy = report.elastic_energy,
          .air_energy = report.air_energy,
          .pin_work = report.pin_work,
          .error_estimate = report.error_estimate,
          .solver_error = report.solver_error,
          .pinched_pairs = report.pinched_pairs,
          .lagging_particles = report.lagging_particles,
          .enclosed_air = std::move(enclosed),
          .warnings = report.warnings};
}

Frame make_frame(Frame::Data data) {
  const auto shared = std::make_shared<Frame::Data>(std::move(data));
  for (std::size_t c = 0; c < shared->velocities.size(); ++c) {
    Object& object = shared->objects[c];
    object.velocities = view_as<Vector>(shared->velocities[c]);
    object.strains = shared->strains[c];
    object.contact_forces = view_as<Vector>(shared->contact_forces[c]);
  }
  return Frame(shared);
}

}  // namespace weft::library
