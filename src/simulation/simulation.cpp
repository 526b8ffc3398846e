#include "simulation/simulation.hpp"

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
#include <variant>

#include "core/archive.hpp"
#include "core/error.hpp"
#include "core/log.hpp"
#include "core/timer.hpp"
#include "environment/environment.hpp"
#include "scene/layers.hpp"
#include "simulation/energy_bound.hpp"
#include "simulation/intersections.hpp"
#include "simulation/pin_warnings.hpp"
#include "simulation/snapshots.hpp"
#include "simulation/step_loop.hpp"

namespace weft::simulation {
namespace {

// Bound for frame numbers that are read from a saved state; no scene has more frames.
constexpr int kMaxFrames = 1 << 30;

// Computation times are not part of the state, because they differ between runs.
template <class Archive>
void serialize(Archive& archive, FrameReport& report) {
  serialize_values(archive, report.frame, report.time, report.steps, report.rejected_steps, report.inexact_steps,
                   report.error_estimate, report.solver_error, report.newton_iterations, report.linear_iterations,
                   report.proximities, report.constraints, report.min_distance, report.max_strain, report.stretch_ratio,
                   report.kinetic_energy, report.potential_energy, report.elastic_energy, report.air_energy,
                   report.pin_work, report.solver_work, report.pinched_pairs, report.lagging_particles);
  serialize_each(archive, report.enclosed, [&](frame::EnclosedAir& air) {
    serialize_plain(archive, air.cloth);
    serialize_values(archive, air.volume, air.pressure);
  });
  serialize_each(archive, report.attachments, [&](frame::AttachmentLoad& attachment) {
    serialize_plain(archive, attachment.name);
    serialize_values(archive, attachment.load, attachment.holds);
  });
  serialize_each(archive, report.warnings, [&](std::string& text) { serialize_plain(archive, text); });
}

// Whether something touches a character with hanging arms, which are in the way of most skirts.
bool touches_hanging_arms(const scene::Scene& scene, const std::vector<IntersectionPlace>& places) {
  return std::ranges::any_of(scene.characters, [&](const scene::Character& character) {
    const auto* file = std::get_if<scene::CharacterFile>(&character.source);
    return file != nullptr && !file->stance_arms && character.dressing > 0 &&
           std::ranges::any_of(places, [&](const IntersectionPlace& place) {
             return place.a == character.name || place.b == character.name;
           });
  });
}

// Throws Error(scene_invalid) if surfaces touch or cross at the start.
void check_start(const scene::Scene& scene, StepLoop& steps) {
  const std::vector<IntersectionPlace> places = steps.find_intersections();
  if (places.empty()) return;
  throw Error(
      ExitCode::scene_invalid, "{}: expected surfaces that are apart at the start{}, got {}; {}{}", scene.file.string(),
      may_be_untangled(scene) ? ", or can be untangled" : "", describe(places),
      may_be_untangled(scene) ? "'weft thumbnail --start' draws it as it was; move one of them"
                              : "'weft thumbnail --start' draws it; move one of them, leave it out of contact, or give "
                                "a cloth start = \"untangle\"",
      touches_hanging_arms(scene, places) ? "; where arms are in the way, stance_arms = 45 holds them off the body"
                                          : "");
}

// The scene and its environment with some of the cloths only; `cloths`: their numbers.
struct DressedScene {
  DressedScene(const scene::Scene& of, const environment::Environment& whole, std::span<const std::size_t> cloths)
      : scene(of), environment(whole.with_cloths(cloths)) {
    scene.cloths.clear();
    for (const std::size_t c : cloths) scene.cloths.push_back(of.cloths[c]);
  }
  scene::Scene scene;
  environment::Environment environment;
};

// Writes into the environment when each cloth is put on.
void set_put_on_times(const scene::Scene& scene, const std::vector<scene::Layer>& layers,
                      environment::Environment& environment) {
  for (const scene::Layer& layer : layers)
    for (const std::size_t c : layer.cloths)
      environment.cloths[c].put_on = (layer.first_frame + scene.preroll_frames()) / scene.time.fps;
}

}  // namespace

struct Simulation::Impl {
  explicit Impl(const scene::Scene& s);

  void begin_layer(std::size_t number);
  void put_on_next();
  void make_start();
  bool all_dressed() const { return layer + 1 == layers.size(); }
  FrameReport advance();
  double time() const { return frame / scene.time.fps; }
  double next_time() const { return (frame + 1) / scene.time.fps; }
  void drive(std::size_t obstacle, const scene::Pose& end);
  void set_motion(std::size_t obstacle);
  void measure_energies(FrameReport& report) const;
  void measure(FrameReport& report) const;
  void report_obstructions(FrameReport& report) const;
  frame::SnapshotPtr make_snapshot() const;
  std::vector<Vec3> particles_of_all() const;
  template <class Archive>
  void serialize(Archive& archive);

  scene::Scene scene;
  environment::Environment environment;
  std::vector<scene::Layer> layers;
  std::size_t layer = 0;                        // number of the last layer that is put on
  std::unique_ptr<DressedScene> dressed_scene;  // null if all cloths are put on
  int frame;                                    // negative during the preroll
  std::unique_ptr<StepLoop> steps;
  SnapshotMaker snapshots;
  frame::SnapshotPtr current;
  FrameReport start_report;  // of frame 0
  std::optional<EnergyBound> energy_bound;
  std::map<std::size_t, std::array<scene::PoseKey, 2>> driven;  // obstacles, with their keys over the last frame
};

Simulation::Impl::Impl(const scene::Scene& s)
    : scene(s),
      environment(scene),
      layers(scene::list_layers(scene)),
      frame(-scene.preroll_frames()),
      snapshots(scene, environment) {
  set_put_on_times(scene, layers, environment);
  // Checks each later layer alone against the bodies where they start, so that a layer that does not fit is refused
  // before anything is simulated.
  for (std::size_t later = 1; later < layers.size(); ++later) {
    DressedScene alone(scene, environment, layers[later].cloths);
    StepLoop trial(alone.scene, alone.environment, time());
    trial.untangle();
    check_start(alone.scene, trial);
  }
  begin_layer(0);
  make_start();
  put_on_next();
  current = make_snapshot();
  measure_energies(start_report);
  start_report.max_strain = steps->cloth().max_strain(steps->progress().now.particles());
  measure(start_report);
  const std::span<const double> masses = steps->cloth().masses();
  energy_bound.emplace(scene, std::accumulate(masses.begin(), masses.end(), 0.0), start_report);
  for (const std::string& text : find_jumps(scene, environment)) log::warn(text);
}

// Makes the step loop of all cloths up to this layer, with all of them at their start.
void Simulation::Impl::begin_layer(std::size_t number) {
  layer = number;
  dressed_scene = all_dressed() ? nullptr : std::make_unique<DressedScene>(scene, environment, layers[layer].dressed);
  steps = std::make_unique<StepLoop>(dressed_scene ? dressed_scene->scene : scene,
                                     dressed_scene ? dressed_scene->environment : environment, time());
}

// Puts on the cloths whose time has come, outside of those that are already dressed.
void Simulation::Impl::put_on_next() {
  while (!all_dressed() && layers[layer + 1].first_frame <= frame) {
    const std::unique_ptr<DressedScene> inner_scene = std::move(dressed_scene);  // the step loop refers to it
    const std::unique_ptr<StepLoop> inner = std::move(steps);
    begin_layer(layer + 1);
    const std::vector<std::size_t>&now = layers[layer].dressed, &before = layers[layer - 1].dressed;
    std::vector<std::size_t> numbers;  // number of each cloth dressed before, among those dressed now
    for (const std::size_t c : before)
      numbers.push_back(static_cast<std::size_t>(std::ranges::find(now, c) - now.begin()));
    steps->copy_state_from(*inner, numbers);
    make_start();
  }
}

// Lifts bodies and untangles cloth at the start of a layer. Throws Error(scene_invalid) if surfaces still touch or
// cross.
void Simulation::Impl::make_start() {
  const scene::Scene& dressed = dressed_scene ? dressed_scene->scene : scene;
  if (const double lift = layer == 0 ? steps->lift_bodies() : 0; lift > 0)
    log::info(fmt::format("lifted bodies by up to {:.2g} mm off what they touch at the start", 1e3 * lift));
  if (may_be_untangled(dressed)) steps->untangle();
  check_start(dressed, *steps);
}

FrameReport Simulation::Impl::advance() {
  if (!all_dressed()) put_on_next();
  FrameReport report;
  report.frame = frame + 1;
  // Frame k is at exactly k / fps, whatever the steps in between.
  report.time = report.frame / scene.time.fps;
  {
    const Stopwatch watch(report.simulate);
    StepLoop::Checkpoint start = steps->checkpoint();
    try {
      steps->advance(time(), report.time, report);
      measure_energies(report);
      report_obstructions(report);
      std::ranges::move(energy_bound->check(report), std::back_inserter(report.warnings));
    } catch (const Error&) {
      steps->return_to(std::move(start));
      throw;
    }
  }
  frame = report.frame;
  measure(report);
  current = make_snapshot();
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
  report.constraints += collisions->response().active(now.x);
  report.min_distance = collisions->min_distance();
}

void Simulation::Impl::report_obstructions(FrameReport& report) const {
  const CollisionStage::Pinches pinches = steps->take_pinches();
  report.pinched_pairs = pinches.pairs;
  for (const std::string& text : pinches.begun)
    report.warnings.push_back(fmt::format("frame {}: {}", report.frame, text));
  const YieldingPins::Lags lags = steps->take_lags();
  report.lagging_particles = lags.particles;
  for (const std::string& text : lags.turns) report.warnings.push_back(fmt::format("frame {}: {}", report.frame, text));
}

frame::SnapshotPtr Simulation::Impl::make_snapshot() const {
  const SystemState& now = steps->progress().now;
  std::vector<std::vector<float>> heat;
  std::vector<std::vector<Vec3>> moved;
  for (std::size_t b = 0; b < environment.bodies.size(); ++b) moved.push_back(steps->vertices_of(b));
  if (!all_dressed()) return snapshots.make(frame, time(), environment, particles_of_all(), {}, std::move(moved));
  for (std::size_t c = 0; c < scene.cloths.size() && scene.render.heat != scene::HeatQuantity::none; ++c) {
    if (scene.render.heat == scene::HeatQuantity::strain) {
      heat.push_back(steps->cloth().strain_per_particle(c, now.particles()));
      continue;
    }
    heat.emplace_back();
    for (Index i = steps->cloth().first_particle(c); i < steps->cloth().first_particle(c + 1); ++i)
      heat.back().push_back(static_cast<float>(now.v[i].norm()));
  }
  return snapshots.make(frame, time(), environment, now.particles(), std::move(heat), std::move(moved));
}

// Positions of the particles of all cloths [m]; a cloth that is not put on is at its start.
std::vector<Vec3> Simulation::Impl::particles_of_all() const {
  std::vector<Vec3> all;
  const std::vector<std::size_t>& dressed = layers[layer].dressed;
  for (std::size_t c = 0; c < scene.cloths.size(); ++c) {
    const std::vector<Vec3>& start = environment.cloths[c].start;
    const auto found = std::ranges::find(dressed, c);
    const auto number = static_cast<std::size_t>(found - dressed.begin());
    const Vec3* from =
        found == dressed.end() ? start.data() : steps->progress().now.x.data() + steps->cloth().first_particle(number);
    all.insert(all.end(), from, from + start.size());
  }
  return all;
}

void Simulation::Impl::drive(std::size_t obstacle, const scene::Pose& end) {
  const environment::PoseSample now = environment.pose(obstacle, time());
  driven[obstacle] = {{{time(), {now.position, now.rotation}}, {next_time(), {end.position, end.rotation}}}};
  set_motion(obstacle);
}

void Simulation::Impl::set_motion(std::size_t obstacle) {
  const auto& keys = driven.at(obstacle);
  const scene::PoseTrack motion{scene::Interpolation::linear, {keys.begin(), keys.end()}};
  environment.set_motion(obstacle, motion);
  if (dressed_scene) dressed_scene->environment.set_motion(obstacle, motion);
}

template <class Archive>
void Simulation::Impl::serialize(Archive& archive) {
  for (auto& [obstacle, keys] : driven) {
    for (scene::PoseKey& key : keys) {
      serialize_values(archive, key.time);
      archive.raw(key.pose.position.data(), 3 * sizeof(double));
      archive.raw(key.pose.rotation.coeffs().data(), 4 * sizeof(double));
    }
    if constexpr (Archive::kReads) {
      require(keys[0].time < keys[1].time, "a way forward in time");
      set_motion(obstacle);
    }
  }
  archive.value(frame);
  std::uint64_t last = layer;
  archive.value(last);
  if constexpr (Archive::kReads) {
    require(frame >= -scene.preroll_frames() && frame < kMaxFrames, "a frame of the scene");
    require(last < layers.size(), "a layer of the scene");
    if (last != layer) begin_layer(last);
  }
  steps->serialize(archive);
  energy_bound->serialize(archive);
  simulation::serialize(archive, start_report);
  steps->serialize_contacts(archive, time());
}

StartView view_start(const scene::Scene& scene) {
  const environment::Environment environment(scene);
  const int frame = -scene.preroll_frames();
  const double time = frame / scene.time.fps;
  StartView view;
  std::vector<Vec3> particles;
  for (const environment::ClothObject& cloth : environment.cloths)
    particles.insert(particles.end(), cloth.start.begin(), cloth.start.end());
  view.snapshot = SnapshotMaker(scene, environment).make(frame, time, environment, particles, {});
  // Layers are put on one after the other, so each one is checked alone.
  for (const scene::Layer& layer : scene::list_layers(scene)) {
    const DressedScene dressed_scene(scene, environment, layer.cloths);
    StepLoop steps(dressed_scene.scene, dressed_scene.environment, time);
    const std::vector<IntersectionPlace> places = steps.find_intersections();
    view.places.insert(view.places.end(), places.begin(), places.end());
  }
  if (!view.places.empty()) view.description = describe(view.places);
  return view;
}

Simulation::Simulation(const scene::Scene& scene) : impl_(std::make_unique<Impl>(scene)) {}
Simulation::~Simulation() = default;

frame::SnapshotPtr Simulation::snapshot() const {
  return impl_->current;
}
FrameReport Simulation::advance() {
  return impl_->advance();
}
std::size_t Simulation::particles() const {
  std::size_t count = 0;
  for (const environment::ClothObject& cloth : impl_->environment.cloths) count += cloth.start.size();
  return count;
}

MatrixSize Simulation::matrix() const {
  const solver::BlockMatrix& matrix = impl_->steps->problem().memory().system.matrix;
  return {matrix.full().columns.size(), matrix.isotropic().columns.size()};
}

ParticleState Simulation::state() const {
  const SystemState& now = impl_->steps->progress().now;
  const ClothSystem& cloth = impl_->steps->cloth();
  const std::size_t count = at(cloth.first_particle(cloth.cloths()));  // without the frames of bodies
  return {now.particles().first(count), std::span(now.v).first(count), cloth.masses().first(count)};
}

ClothMotion Simulation::motion_of(std::size_t cloth) const {
  const std::vector<std::size_t>& dressed = impl_->layers[impl_->layer].dressed;
  const auto found = std::ranges::find(dressed, cloth);
  if (found == dressed.end()) return {};
  const auto number = static_cast<std::size_t>(found - dressed.begin());
  const ClothSystem& cloths = impl_->steps->cloth();
  const SystemState& now = impl_->steps->progress().now;
  const Index first = cloths.first_particle(number), end = cloths.first_particle(number + 1);
  return {std::span(now.v).subspan(at(first), at(end - first)), cloths.strain_per_particle(number, now.particles())};
}

std::vector<std::vector<Vec3>> Simulation::contact_forces() const {
  const std::vector<Vec3> forces = impl_->steps->contact_forces();
  const std::vector<std::size_t>& dressed = impl_->layers[impl_->layer].dressed;
  std::vector<std::vector<Vec3>> of_cloths(impl_->scene.cloths.size());
  for (std::size_t number = 0; number < dressed.size(); ++number)
    of_cloths[dressed[number]].assign(forces.begin() + impl_->steps->cloth().first_particle(number),
                                      forces.begin() + impl_->steps->cloth().first_particle(number + 1));
  return of_cloths;
}

void Simulation::drive(std::size_t obstacle, const scene::Pose& end) {
  impl_->drive(obstacle, end);
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
  impl_->current = impl_->make_snapshot();
}

FrameReport Simulation::initial_report() const {
  return impl_->start_report;
}

std::vector<ObjectInfo> Simulation::objects() const {
  std::vector<ObjectInfo> objects;
  for (const environment::ClothObject& cloth : impl_->environment.cloths)
    objects.push_back(
        {cloth.name, cloth.lengths.empty() ? frame::ObjectKind::cloth : frame::ObjectKind::rope,
         cloth.mesh.positions.size(),
         cloth.mesh.topology.quads.empty() ? cloth.mesh.topology.triangles.size() : cloth.mesh.topology.quads.size()});
  for (const environment::BodyObject& body : impl_->environment.bodies)
    objects.push_back({body.name, body.character ? frame::ObjectKind::character : frame::ObjectKind::obstacle,
                       body.mesh.positions.size(), body.mesh.topology.triangles.size()});
  return objects;
}

}  // namespace weft::simulation
