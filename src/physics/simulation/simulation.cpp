#include "physics/simulation/simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "core/archive.hpp"
#include "core/error.hpp"
#include "core/log.hpp"
#include "core/timer.hpp"
#include "physics/simulation/energy_bound.hpp"
#include "physics/simulation/intersections.hpp"
#include "physics/simulation/step_loop.hpp"

namespace weft::simulation {
namespace {

// Bound for frame numbers that are read from a saved state; no run has more frames.
constexpr int kMaxFrames = 1 << 30;

// Computation times are not part of the state, because they differ between runs.
template <class Archive>
void serialize(Archive& archive, FrameReport& report) {
  serialize_values(archive, report.frame, report.time, report.steps, report.rejected_steps, report.inexact_steps,
                   report.error_estimate, report.solver_error, report.newton_iterations, report.linear_iterations,
                   report.proximities, report.constraints, report.min_distance, report.max_strain, report.stretch_ratio,
                   report.kinetic_energy, report.potential_energy, report.elastic_energy, report.air_energy,
                   report.pin_work, report.solver_work, report.pinched_pairs, report.lagging_particles);
  serialize_each(archive, report.enclosed, [&](EnclosedAir& air) {
    serialize_plain(archive, air.cloth);
    serialize_values(archive, air.volume, air.pressure);
  });
  serialize_each(archive, report.attachments, [&](AttachmentLoad& attachment) {
    serialize_plain(archive, attachment.name);
    serialize_values(archive, attachment.load, attachment.holds);
  });
  serialize_each(archive, report.warnings, [&](std::string& text) { serialize_plain(archive, text); });
}

// What to do about these places: the advice of the model, then that of the first body that has
// advice and is in one of the places.
std::string advice_of(const model::Model& model, const std::vector<IntersectionPlace>& places) {
  const auto is_in_one = [&](const auto& object) {
    return std::ranges::any_of(
        places, [&](const IntersectionPlace& place) { return place.a == object.name || place.b == object.name; });
  };
  std::string advice = model.start_advice;
  if (!model.untangle_advice.empty() && std::ranges::any_of(model.cloths, is_in_one))
    advice += ", " + model.untangle_advice;
  for (const model::Body& body : model.bodies)
    if (!body.advice.empty() && is_in_one(body)) return advice + "; " + body.advice;
  return advice;
}

// Throws Error(scene_invalid) if surfaces touch or cross at the start.
void check_start(const model::Model& model, StepLoop& steps) {
  const std::vector<IntersectionPlace> places = steps.find_intersections();
  if (places.empty()) return;
  throw Error(ExitCode::scene_invalid, "{}: expected surfaces that are apart at the start{}, got {}; {}", model.source,
              model.may_be_untangled() ? ", or can be untangled" : "", describe(places), advice_of(model, places));
}

}  // namespace

struct Simulation::Impl {
  explicit Impl(model::Model of);

  void begin_layer(std::size_t number);
  void put_on_next();
  void make_start() const;
  bool all_put_on() const { return layer + 1 == model.layers.size(); }
  const model::Model& put_on_model() const { return put_on_part ? *put_on_part : model; }
  FrameReport advance();
  double time() const { return frame / model.time.fps; }
  double next_time() const { return (frame + 1) / model.time.fps; }
  void drive(std::size_t body, const motion::Pose& end);
  void set_motion(std::size_t body);
  void measure_energies(FrameReport& report) const;
  void measure(FrameReport& report) const;
  void report_obstructions(FrameReport& report) const;
  template <class Archive>
  void serialize(Archive& archive);

  model::Model model;
  std::size_t layer = 0;                      // number of the last layer that is put on
  std::unique_ptr<model::Model> put_on_part;  // model of the cloths that are put on; null if all are
  int frame;                                  // negative during the preroll
  std::uint64_t changes = 0;
  std::unique_ptr<StepLoop> steps;
  FrameReport start_report;  // of frame 0
  std::optional<EnergyBound> energy_bound;
  // Bodies of allow_drive(), each with the two keys of its last drive(), if there was one.
  std::map<std::size_t, std::optional<std::array<motion::PoseKey, 2>>> driven;
};

Simulation::Impl::Impl(model::Model of) : model(std::move(of)), frame(-model.time.preroll_frames) {
  if (model.layers.empty()) {
    model::Layer& all = model.layers.emplace_back();
    all.first_frame = frame;
    all.cloths.resize(model.cloths.size());
    std::iota(all.cloths.begin(), all.cloths.end(), std::size_t{0});
    all.put_on = all.cloths;
  }
  // Checks each later layer alone against the bodies at their start positions, so that a layer that does not fit is
  // refused before anything is simulated.
  for (std::size_t later = 1; later < model.layers.size(); ++later) {
    const model::Model alone = model.with_cloths(model.layers[later].cloths);
    StepLoop trial(alone, time());
    trial.untangle();
    check_start(alone, trial);
  }
  begin_layer(0);
  make_start();
  put_on_next();
  start_report.frame = frame;
  start_report.time = time();
  measure_energies(start_report);
  const std::span<const Vec3> start = steps->progress().now.particles();
  start_report.max_strain = steps->cloth().max_strain(start);
  for (const ClothSystem::Overstretch& most : steps->cloth().overstretch(start))
    start_report.stretch_ratio = std::max(start_report.stretch_ratio, most.ratio);
  measure(start_report);
  const std::span<const double> masses = steps->cloth().masses();
  energy_bound.emplace(model, std::accumulate(masses.begin(), masses.end(), 0.0), start_report);
}

// Makes the step loop of all cloths up to this layer, each at its start position.
void Simulation::Impl::begin_layer(std::size_t number) {
  layer = number;
  put_on_part = all_put_on() ? nullptr : std::make_unique<model::Model>(model.with_cloths(model.layers[layer].put_on));
  steps = std::make_unique<StepLoop>(put_on_model(), time());
}

// Puts on each layer whose first frame is not later than the current one, outside of the cloths that are already on. If
// a layer cannot be put on, throws, and leaves the cloths that are already on as they were.
void Simulation::Impl::put_on_next() {
  while (!all_put_on() && model.layers[layer + 1].first_frame <= frame) {
    std::unique_ptr<model::Model> inner_part = std::move(put_on_part);  // `inner` refers to it
    std::unique_ptr<StepLoop> inner = std::move(steps);
    const std::size_t inner_layer = layer;
    try {
      begin_layer(inner_layer + 1);
      const std::vector<std::size_t>&now = model.layers[layer].put_on, &before = model.layers[inner_layer].put_on;
      std::vector<std::size_t> numbers;  // position of each cloth of `before` in `now`
      for (const std::size_t c : before)
        numbers.push_back(static_cast<std::size_t>(std::ranges::find(now, c) - now.begin()));
      steps->copy_state_from(*inner, numbers);
      make_start();
    } catch (...) {
      layer = inner_layer;
      steps = std::move(inner);
      put_on_part = std::move(inner_part);
      throw;
    }
  }
}

// Prepares the start of a layer that is put on: lifts bodies if it is the first layer, then untangles cloth if the
// model allows it. Throws Error(scene_invalid) if surfaces still touch or cross.
void Simulation::Impl::make_start() const {
  if (const double lift = layer == 0 ? steps->lift_bodies() : 0; lift > 0)
    log::note(fmt::format("lifted bodies by up to {:.2g} mm off what they touch at the start", 1e3 * lift));
  if (put_on_model().may_be_untangled()) steps->untangle();
  check_start(put_on_model(), *steps);
}

FrameReport Simulation::Impl::advance() {
  if (!all_put_on()) put_on_next();
  FrameReport report;
  report.frame = frame + 1;
  // Frame k is at exactly k / fps: a sum of step lengths would have rounding errors.
  report.time = report.frame / model.time.fps;
  {
    const Stopwatch watch(report.simulate);
    StepLoop::Checkpoint start = steps->checkpoint();
    const EnergyBound bound = *energy_bound;
    try {
      steps->advance(time(), report.time, report);
      measure_energies(report);
      report_obstructions(report);
      std::ranges::move(energy_bound->check(report), std::back_inserter(report.warnings));
    } catch (...) {
      steps->return_to(std::move(start));
      *energy_bound = bound;
      throw;
    }
  }
  frame = report.frame;
  measure(report);
  ++changes;
  return report;
}

void Simulation::Impl::measure_energies(FrameReport& report) const {
  const SystemState& now = steps->progress().now;
  report.kinetic_energy = steps->cloth().kinetic_energy(now.v);
  report.potential_energy = steps->cloth().potential_energy(now.particles(), steps->weather().gravity(report.time));
  report.elastic_energy = steps->cloth().elastic_energy(now.particles()) + steps->attachments().energy(now.particles());
  report.air_energy = steps->cloth().air_energy(now.particles());
  report.enclosed = steps->cloth().inflation().measure(now.particles());
  report.attachments = steps->attachments().measure();
  std::ranges::move(steps->cloth().measure_seams(now.particles()), std::back_inserter(report.attachments));
}

void Simulation::Impl::measure(FrameReport& report) const {
  const SystemState& now = steps->progress().now;
  report.constraints = static_cast<int>(steps->held());
  report.min_distance = std::numeric_limits<double>::infinity();
  const CollisionStage* collisions = steps->collisions();
  if (collisions == nullptr) return;
  report.proximities = collisions->proximities();
  report.constraints += collisions->response().count_active(now.x);
  report.min_distance = collisions->min_distance();
}

void Simulation::Impl::report_obstructions(FrameReport& report) const {
  const CollisionStage::Pinches pinches = steps->take_pinches();
  report.pinched_pairs = pinches.pairs;
  for (const std::string& text : pinches.begun)
    report.warnings.push_back(fmt::format("frame {}: {}", report.frame, text));
  const YieldingPins::LagReport lag_report = steps->take_lag_report();
  report.lagging_particles = lag_report.particles;
  for (const std::string& text : lag_report.messages)
    report.warnings.push_back(fmt::format("frame {}: {}", report.frame, text));
}

void Simulation::Impl::drive(std::size_t body, const motion::Pose& end) {
  const motion::PoseSample now = model.pose(body, time());
  driven.at(body) = std::array<motion::PoseKey, 2>{
      {{time(), {now.position, now.rotation}}, {next_time(), {end.position, end.rotation}}}};
  set_motion(body);
}

void Simulation::Impl::set_motion(std::size_t body) {
  const auto& keys = *driven.at(body);
  const motion::PoseTrack motion{motion::Interpolation::linear, {keys.begin(), keys.end()}};
  model.set_motion(body, motion);
  if (put_on_part) put_on_part->set_motion(body, motion);
}

template <class Archive>
void Simulation::Impl::serialize(Archive& archive) {
  for (auto& [body, keys] : driven) {
    bool is_driven = keys.has_value();
    archive.value(is_driven);
    if (!is_driven) continue;
    if (!keys) keys.emplace();
    for (motion::PoseKey& key : *keys) {
      serialize_values(archive, key.time);
      archive.raw(key.pose.position.data(), 3 * sizeof(double));
      archive.raw(key.pose.rotation.coeffs().data(), 4 * sizeof(double));
    }
    if constexpr (Archive::kReads) require((*keys)[0].time < (*keys)[1].time, "a way forward in time");
  }
  int saved_frame = frame;
  archive.value(saved_frame);
  std::uint64_t last = layer;
  archive.value(last);
  if constexpr (Archive::kReads) {
    require(saved_frame >= -model.time.preroll_frames && saved_frame < kMaxFrames, "a frame of the model");
    require(last < model.layers.size(), "a layer of the model");
    // Makes the step loop before set_motion(): pins that follow a body need its start pose, which
    // only the original motion of the model has.
    if (last != layer) begin_layer(last);
    frame = saved_frame;
    for (const auto& [body, keys] : driven)
      if (keys) set_motion(body);
  }
  steps->serialize(archive);
  energy_bound->serialize(archive);
  simulation::serialize(archive, start_report);
  steps->serialize_contacts(archive, time());
}

std::vector<IntersectionPlace> find_start_intersections(const model::Model& model) {
  if (model.layers.empty()) return StepLoop(model, model.start_time()).find_intersections();
  std::vector<IntersectionPlace> found;
  // Layers are put on one after the other, so each one is checked alone.
  for (const model::Layer& layer : model.layers) {
    const model::Model alone = model.with_cloths(layer.cloths);
    StepLoop steps(alone, model.start_time());
    const std::vector<IntersectionPlace> places = steps.find_intersections();
    found.insert(found.end(), places.begin(), places.end());
  }
  return found;
}

Simulation::Simulation(model::Model model) : impl_(std::make_unique<Impl>(std::move(model))) {}
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation::~Simulation() = default;

const model::Model& Simulation::model() const {
  return impl_->model;
}
int Simulation::frame() const {
  return impl_->frame;
}
double Simulation::time() const {
  return impl_->time();
}
std::uint64_t Simulation::changes() const {
  return impl_->changes;
}
FrameReport Simulation::advance() {
  return impl_->advance();
}
std::size_t Simulation::particles() const {
  std::size_t count = 0;
  for (const model::Cloth& cloth : impl_->model.cloths) count += cloth.start.size();
  return count;
}

MatrixSize Simulation::matrix() const {
  const solver::BlockMatrix& matrix = impl_->steps->problem().memory().system.matrix;
  return {matrix.full().columns.size(), matrix.isotropic().columns.size()};
}

std::vector<Vec3> Simulation::particles_of_all() const {
  std::vector<Vec3> all;
  const std::vector<std::size_t>& put_on = impl_->model.layers[impl_->layer].put_on;
  for (std::size_t c = 0; c < impl_->model.cloths.size(); ++c) {
    const std::vector<Vec3>& start = impl_->model.cloths[c].start;
    const auto found = std::ranges::find(put_on, c);
    const auto number = static_cast<std::size_t>(found - put_on.begin());
    const Vec3* from = found == put_on.end()
                           ? start.data()
                           : impl_->steps->progress().now.x.data() + impl_->steps->cloth().first_particle(number);
    all.insert(all.end(), from, from + start.size());
  }
  return all;
}

bool Simulation::all_put_on() const {
  return impl_->all_put_on();
}

std::vector<Vec3> Simulation::vertices_of(std::size_t body) const {
  return impl_->steps->vertices_of(body);
}

ParticleState Simulation::state() const {
  const SystemState& now = impl_->steps->progress().now;
  const ClothSystem& cloth = impl_->steps->cloth();
  const std::size_t count = at(cloth.first_particle(cloth.cloths()));  // without the frames of bodies
  return {now.particles().first(count), std::span(now.v).first(count), cloth.masses().first(count)};
}

ClothMotion Simulation::motion_of(std::size_t cloth) const {
  const std::vector<std::size_t>& put_on = impl_->model.layers[impl_->layer].put_on;
  const auto found = std::ranges::find(put_on, cloth);
  if (found == put_on.end()) return {};
  const auto number = static_cast<std::size_t>(found - put_on.begin());
  const ClothSystem& cloths = impl_->steps->cloth();
  const SystemState& now = impl_->steps->progress().now;
  const Index first = cloths.first_particle(number), end = cloths.first_particle(number + 1);
  return {std::span(now.v).subspan(at(first), at(end - first)), cloths.strain_per_particle(number, now.particles())};
}

std::vector<std::vector<Vec3>> Simulation::contact_forces() const {
  const std::vector<Vec3> forces = impl_->steps->contact_forces();
  const std::vector<std::size_t>& put_on = impl_->model.layers[impl_->layer].put_on;
  std::vector<std::vector<Vec3>> of_cloths(impl_->model.cloths.size());
  for (std::size_t number = 0; number < put_on.size(); ++number)
    of_cloths[put_on[number]].assign(forces.begin() + impl_->steps->cloth().first_particle(number),
                                     forces.begin() + impl_->steps->cloth().first_particle(number + 1));
  return of_cloths;
}

void Simulation::allow_drive(std::size_t body) {
  impl_->driven.try_emplace(body);
}

void Simulation::drive(std::size_t body, const motion::Pose& end) {
  impl_->drive(body, end);
}

void Simulation::set_weather(const Vec3& gravity, const Vec3& wind) {
  impl_->model.physics.keys = {{0, gravity, wind}};
  if (impl_->put_on_part) impl_->put_on_part->physics.keys = impl_->model.physics.keys;
  impl_->steps->reload_weather(impl_->time());
  impl_->energy_bound->exempt_gains();
}

bool Simulation::run_preroll(const std::function<bool()>& proceed) {
  FrameReport& report = impl_->start_report;
  while (impl_->frame < 0) {
    if (!proceed()) return false;
    const std::vector<std::string> before = report.warnings;
    report = impl_->advance();
    report.warnings.insert(report.warnings.begin(), before.begin(), before.end());
  }
  return true;
}

void Simulation::save(std::string& bytes) const {
  ByteWriter writer{std::move(bytes)};
  impl_->serialize(writer);
  bytes = std::move(writer.bytes);
}

void Simulation::restore(std::string_view bytes) {
  ByteReader reader{bytes};
  impl_->serialize(reader);
  require(reader.bytes.empty(), "an end");
  ++impl_->changes;
}

FrameReport Simulation::initial_report() const {
  return impl_->start_report;
}

}  // namespace weft::simulation
