#include "simulation/simulation.hpp"

#include <fmt/format.h>

#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "core/archive.hpp"
#include "core/error.hpp"
#include "core/log.hpp"
#include "core/timer.hpp"
#include "environment/environment.hpp"
#include "simulation/energy_bound.hpp"
#include "simulation/meetings.hpp"
#include "simulation/pin_doubts.hpp"
#include "simulation/snapshots.hpp"
#include "simulation/step_loop.hpp"

namespace weft::simulation {
namespace {

// More than any scene has; what was read is held against it.
constexpr int kMostFrames = 1 << 30;

// Times are not part of a state: two runs take different ones.
template <class Archive>
void serialize(Archive& archive, FrameReport& report) {
  serialize_values(archive, report.frame, report.time, report.steps, report.rejected_steps, report.inexact_steps,
                   report.error_estimate, report.solver_error, report.newton_iterations, report.linear_iterations,
                   report.proximities, report.constraints, report.min_distance, report.max_strain, report.stretch_share,
                   report.kinetic_energy, report.potential_energy, report.elastic_energy, report.pinched_pairs,
                   report.lagging_particles);
  serialize_each(archive, report.warnings, [&](std::string& text) { serialize_plain(archive, text); });
}

// Throws Error(scene_invalid) where a run cannot begin so.
void check_start(const scene::Scene& scene, StepLoop& steps) {
  const std::vector<MeetingPlace> places = steps.find_meetings();
  if (places.empty()) return;
  throw Error(ExitCode::scene_invalid, "{}: expected surfaces that are apart at the start{}, got {}; {}",
              scene.file.string(), untangles(scene) ? ", or can be untangled" : "", describe(places),
              untangles(scene)
                  ? "'weft thumbnail --start' draws it as it was; move one of them"
                  : "'weft thumbnail --start' draws it; move one of them, leave it out of contact, or give "
                    "a cloth start = \"untangle\"");
}

}  // namespace

struct Simulation::Impl {
  explicit Impl(const scene::Scene& s);

  FrameReport advance();
  double time() const { return frame / scene.time.fps; }
  void measure_energies(FrameReport& report) const;
  void measure(FrameReport& report) const;
  void report_obstructions(FrameReport& report);
  frame::SnapshotPtr make_snapshot() const;
  template <class Archive>
  void serialize(Archive& archive);

  scene::Scene scene;
  environment::Environment environment;
  int frame;  // negative in the preroll
  StepLoop steps;
  SnapshotMaker snapshots;
  frame::SnapshotPtr current;
  FrameReport start_report;  // of frame 0
  std::optional<EnergyBound> energy_bound;
};

Simulation::Impl::Impl(const scene::Scene& s)
    : scene(s),
      environment(scene),
      frame(-scene.preroll_frames()),
      steps(scene, environment, time()),
      snapshots(scene, environment) {
  if (untangles(scene)) steps.untangle();
  check_start(scene, steps);
  current = make_snapshot();
  measure_energies(start_report);
  start_report.max_strain = steps.cloth().max_strain(steps.progress().now.particles());
  measure(start_report);
  energy_bound.emplace(scene, start_report);
  for (const std::string& text : find_jumps(scene, environment)) log::warn(text);
}

FrameReport Simulation::Impl::advance() {
  FrameReport report;
  report.frame = frame + 1;
  // Frame k is at k / fps exactly, whatever the steps between.
  report.time = report.frame / scene.time.fps;
  {
    const Stopwatch watch(report.simulate);
    StepLoop::Checkpoint start = steps.checkpoint();
    try {
      steps.advance(time(), report.time, report);
      measure_energies(report);
      if (std::optional<std::string> warning = energy_bound->check(report.frame, report))
        report.warnings.push_back(*std::move(warning));
    } catch (const Error&) {
      steps.return_to(std::move(start));
      throw;
    }
  }
  frame = report.frame;
  measure(report);
  report_obstructions(report);
  current = make_snapshot();
  return report;
}

void Simulation::Impl::measure_energies(FrameReport& report) const {
  const Moment& now = steps.progress().now;
  report.kinetic_energy = steps.cloth().kinetic_energy(now.v);
  report.potential_energy = steps.cloth().potential_energy(now.particles(), scene.physics.gravity);
  report.elastic_energy = steps.cloth().elastic_energy(now.particles());
}

void Simulation::Impl::measure(FrameReport& report) const {
  const Moment& now = steps.progress().now;
  report.constraints = static_cast<int>(steps.held());
  report.min_distance = std::numeric_limits<double>::infinity();
  const CollisionStage* collisions = steps.collisions();
  if (collisions == nullptr) return;
  report.proximities = collisions->proximities();
  report.constraints += collisions->response().active(now.x);
  report.min_distance = collisions->min_distance();
}

void Simulation::Impl::report_obstructions(FrameReport& report) {
  const CollisionStage::Pinches pinches = steps.take_pinches();
  report.pinched_pairs = pinches.pairs;
  for (const std::string& text : pinches.begun) report.warnings.push_back(fmt::format("frame {}: {}", frame, text));
  const YieldingPins::Lags lags = steps.take_lags();
  report.lagging_particles = lags.particles;
  for (const std::string& text : lags.turns) report.warnings.push_back(fmt::format("frame {}: {}", frame, text));
}

frame::SnapshotPtr Simulation::Impl::make_snapshot() const {
  const Moment& now = steps.progress().now;
  std::vector<std::vector<float>> heat;
  for (std::size_t c = 0; c < scene.cloths.size() && scene.render.heat != scene::HeatQuantity::none; ++c) {
    if (scene.render.heat == scene::HeatQuantity::strain) {
      heat.push_back(steps.cloth().strain_per_particle(c, now.particles()));
      continue;
    }
    heat.emplace_back();
    for (Index i = steps.cloth().first_particle(c); i < steps.cloth().first_particle(c + 1); ++i)
      heat.back().push_back(static_cast<float>(now.v[i].norm()));
  }
  return snapshots.make(frame, time(), environment, now.particles(), std::move(heat));
}

template <class Archive>
void Simulation::Impl::serialize(Archive& archive) {
  archive.value(frame);
  if constexpr (Archive::kReads)
    require(frame >= -scene.preroll_frames() && frame < kMostFrames, "a frame of the scene");
  steps.serialize(archive);
  energy_bound->serialize(archive);
  simulation::serialize(archive, start_report);
  steps.serialize_contacts(archive, time());
}

StartView view_start(const scene::Scene& scene) {
  const environment::Environment environment(scene);
  const int frame = -scene.preroll_frames();
  const double time = frame / scene.time.fps;
  StepLoop steps(scene, environment, time);
  StartView view;
  view.snapshot =
      SnapshotMaker(scene, environment).make(frame, time, environment, steps.progress().now.particles(), {});
  view.places = steps.find_meetings();
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
  return impl_->steps.cloth().masses().size();
}

MatrixSize Simulation::matrix() const {
  const solver::BlockMatrix& matrix = impl_->steps.problem().memory().system.matrix;
  return {matrix.full().columns.size(), matrix.isotropic().columns.size()};
}

ParticleState Simulation::state() const {
  const Moment& now = impl_->steps.progress().now;
  return {now.particles(), now.v, impl_->steps.cloth().masses()};
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
        {cloth.name, frame::ObjectKind::cloth, cloth.mesh.positions.size(),
         cloth.mesh.topology.quads.empty() ? cloth.mesh.topology.triangles.size() : cloth.mesh.topology.quads.size()});
  for (const environment::BodyObject& body : impl_->environment.bodies)
    objects.push_back({body.name, body.character ? frame::ObjectKind::character : frame::ObjectKind::obstacle,
                       body.mesh.positions.size(), body.mesh.topology.triangles.size()});
  return objects;
}

}  // namespace weft::simulation
