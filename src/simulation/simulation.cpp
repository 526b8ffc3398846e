#include "simulation/simulation.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <optional>

#include "core/archive.hpp"
#include "core/error.hpp"
#include "core/timer.hpp"
#include "environment/environment.hpp"
#include "integrator/step_control.hpp"
#include "integrator/stepper.hpp"
#include "simulation/cloth_system.hpp"
#include "simulation/collision_stage.hpp"
#include "simulation/energy_bound.hpp"
#include "simulation/pins.hpp"
#include "simulation/snapshots.hpp"

namespace weft::simulation {
namespace {

// Halvings of a step before cloth that cannot be kept out of an obstacle is taken for pinched: where there is room a
// shorter step finds it, where there is none it only costs.
constexpr int kHalvingsBeforePinch = 3;

integrator::Method method_of(scene::Integrator integrator) {
  switch (integrator) {
    case scene::Integrator::implicit_euler:
      return integrator::Method::implicit_euler;
    case scene::Integrator::implicit_midpoint:
      return integrator::Method::implicit_midpoint;
    case scene::Integrator::bdf2:
      return integrator::Method::bdf2;
  }
  return integrator::Method::implicit_euler;
}

integrator::NewtonParameters newton_of(const scene::Scene& scene) {
  return {scene.solver.newton_tolerance, scene.solver.newton_iterations, scene.solver.linear_tolerance,
          scene.solver.linear_iterations, scene.time.tolerance.value_or(0)};
}

std::optional<integrator::StepControl> step_control_of(const scene::Scene& scene) {
  if (!scene.time.tolerance) return std::nullopt;
  // The first step is one of Euler's, whose error in free fall is ½ h² g.
  const double first = std::sqrt(2 * *scene.time.tolerance / std::max(scene.physics.gravity.norm(), 1.0));
  return integrator::StepControl(method_of(scene.time.integrator), *scene.time.tolerance, first);
}

std::vector<Index> first_particles(const scene::Scene& scene, const ClothSystem& system) {
  std::vector<Index> first;
  for (std::size_t c = 0; c < scene.cloths.size(); ++c) first.push_back(system.first_particle(c));
  return first;
}

// More than any scene has; what was read is held against it.
constexpr int kMostFrames = 1 << 30;

// Times are not part of a state: two runs take different ones.
template <class Archive>
void exchange(Archive& archive, FrameReport& report) {
  exchange_values(archive, report.frame, report.time, report.steps, report.rejected_steps, report.inexact_steps,
                  report.error_estimate, report.newton_iterations, report.linear_iterations, report.proximities,
                  report.constraints, report.min_distance, report.max_strain, report.kinetic_energy,
                  report.potential_energy, report.elastic_energy, report.pinched_pairs);
  exchange_each(archive, report.pinches, [&](std::string& text) { exchange_plain(archive, text); });
}

/// Adds the wall and CPU time of a scope to two counters.
class Stopwatch {
 public:
  Stopwatch(double& wall, double& cpu) : wall_(wall), cpu_(cpu) {}
  ~Stopwatch() {
    wall_ += timer_.seconds();
    cpu_ += thread_cpu_seconds() - cpu_start_;
  }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  double &wall_, &cpu_;
  WallTimer timer_;
  double cpu_start_ = thread_cpu_seconds();
};

}  // namespace

// Parts that a scene does not need are not there: no collision stage where nothing collides, no forces of zero
// stiffness.
struct Simulation::Impl {
  explicit Impl(const scene::Scene& s);

  FrameReport advance();
  void measure_energies(FrameReport& report) const;
  void measure(FrameReport& report) const;
  void report_pinches(FrameReport& report);
  frame::SnapshotPtr make_snapshot() const;
  template <class Archive>
  void exchange(Archive& archive);

  // Why a step was rejected; empty where it was not.
  using Rejection = std::optional<std::string>;

  void advance_equally(double t_t0, double t_t1, FrameReport& report);
  void advance_over(double t, double h, int halvings, FrameReport& report);
  void advance_controlled(double t_t0, double t_t1, FrameReport& report);
  void accept(double h, FrameReport& report);
  [[noreturn]] void give_up(double t, double h, const std::string& reason) const;
  Rejection attempt(double t, double h, bool may_pinch, FrameReport& report);
  Rejection solve(double h, integrator::Stepper::Start start, FrameReport& report);
  void write_back();

  scene::Scene scene;
  environment::Environment environment;
  ClothSystem system;
  Pins pins;
  SnapshotMaker snapshots;
  integrator::Stepper stepper;
  std::optional<integrator::StepControl> control;  // where the scene has a tolerance instead of a step
  solver::LinearSystem linear_system;
  std::optional<CollisionStage> collisions;

  int frame;          // negative in the preroll
  double start_time;  // of the simulation, 0 without preroll [s]
  integrator::State now, next;
  double local_error = 0;          // of the step in `next`, estimated [m]
  std::vector<Vec3> acceleration;  // mean over the last step [m/s²]
  std::vector<integrator::HeldParticle> held;
  frame::SnapshotPtr current;
  FrameReport start_report;  // of frame 0
  std::optional<EnergyBound> energy_bound;
};

Simulation::Impl::Impl(const scene::Scene& s)
    : scene(s),
      environment(scene),
      system(scene, environment),
      pins(scene, environment, first_particles(scene, system)),
      snapshots(scene, environment),
      stepper(method_of(scene.time.integrator), newton_of(scene)),
      control(step_control_of(scene)),
      linear_system(system.make_linear_system()),
      frame(-scene.preroll_frames()),
      start_time(frame / scene.time.fps) {
  environment.move_to(start_time);
  for (const environment::ClothObject& cloth : environment.cloths) {
    now.x.insert(now.x.end(), cloth.motion.positions.begin(), cloth.motion.positions.end());
    now.v.insert(now.v.end(), cloth.motion.velocities.begin(), cloth.motion.velocities.end());
  }
  acceleration.assign(now.x.size(), Vec3::Zero());
  pins.held_at(start_time, environment, held);
  for (const integrator::HeldParticle& particle : held)
    now.v[static_cast<std::size_t>(particle.constraint.particle)] = particle.v_end;
  if (CollisionStage::needed(scene)) {
    collisions.emplace(scene, environment, system);
    system.use_contacts(&collisions->response());
  }
  current = make_snapshot();
  measure_energies(start_report);
  measure(start_report);
  energy_bound.emplace(scene, start_report);
}

Simulation::Impl::Rejection Simulation::Impl::solve(double h, integrator::Stepper::Start start, FrameReport& report) {
  const integrator::StepReport step =
      stepper.step(system, now, h, scene.physics.gravity, held, linear_system, next, start);
  report.newton_iterations += step.newton_iterations;
  report.linear_iterations += step.linear_iterations;
  local_error = step.local_error;
  if (step.verdict == integrator::Verdict::solved) return std::nullopt;
  return fmt::format("{} (residual {:.3g} of {:.3g} after {} iterations)", integrator::describe(step.verdict),
                     step.last_residual, step.first_residual, step.newton_iterations);
}

// One step from `now` at time t [s] over h [s] into `next`.
Simulation::Impl::Rejection Simulation::Impl::attempt(double t, double h, bool may_pinch, FrameReport& report) {
  pins.held_at(t + h, environment, held);
  system.sew(t + h - start_time);
  using Start = integrator::Stepper::Start;
  if (!collisions) return solve(h, Start::unchanged_velocity, report);
  {
    const Stopwatch watch(report.collide_wall_s, report.collide_cpu_s);
    collisions->begin_step(environment, now, held, t, h);
  }
  const std::size_t pinned = held.size();
  const int rounds = collisions->response().most_solves();
  const auto revise = [&] {
    return collisions->revise(next, [&](Index particle) {
      return stepper.constraint_force(particle, system.masses()[static_cast<std::size_t>(particle)]);
    });
  };
  for (int round = 1;; ++round) {
    held.resize(pinned);
    collisions->append_constraints(held);
    const Start start = round == 1 ? Start::unchanged_velocity : Start::next;
    if (Rejection rejection = solve(h, start, report)) return rejection;
    const Stopwatch watch(report.collide_wall_s, report.collide_cpu_s);
    if (revise() > 0 && round < rounds) continue;
    if (collisions->apart(next)) return std::nullopt;
    if (round < rounds && collisions->adopt_failing() > 0) {
      revise();
      continue;
    }
    return collisions->push_apart(h, may_pinch, next);
  }
}

void Simulation::Impl::give_up(double t, double h, const std::string& reason) const {
  throw Error(ExitCode::simulation_failed,
              "frame {}: the step at t = {:.6g} s was rejected down to h = {:.3g} s: {}; try a smaller time.{} or "
              "softer material",
              frame + 1, t, h, reason, control ? "tolerance" : "step");
}

// Makes `next`, reached over h, the state.
void Simulation::Impl::accept(double h, FrameReport& report) {
  stepper.accept(now, h);
  if (collisions) collisions->response().accept();
  for (std::size_t i = 0; i < acceleration.size(); ++i) acceleration[i] = (next.v[i] - now.v[i]) / h;
  std::swap(now, next);
  ++report.steps;
  report.error_estimate += local_error;
}

// In equal steps, no longer than time.step.
void Simulation::Impl::advance_equally(double t_t0, double t_t1, FrameReport& report) {
  const int steps = std::max(1, static_cast<int>(std::ceil((t_t1 - t_t0) / scene.time.step - 1e-9)));
  const double h = (t_t1 - t_t0) / steps;
  for (int s = 0; s < steps; ++s) advance_over(t_t0 + s * h, h, scene.solver.halvings, report);
}

// Goes from t to t + h, in two halves where one step is rejected, or longer than may follow the last one.
void Simulation::Impl::advance_over(double t, double h, int halvings, FrameReport& report) {
  const bool may_pinch = halvings == 0 || scene.solver.halvings - halvings >= kHalvingsBeforePinch;
  const bool too_long = h > (1 + 1e-9) * stepper.longest_step();
  if (!too_long) {
    const Rejection rejection = attempt(t, h, may_pinch, report);
    if (!rejection) return accept(h, report);
    ++report.rejected_steps;
    if (halvings == 0) give_up(t, h, *rejection);
    --halvings;
  }
  advance_over(t, 0.5 * h, halvings, report);
  advance_over(t + 0.5 * h, 0.5 * h, halvings, report);
}

// In steps whose error is time.tolerance. What is left of the frame is cut into equal steps no longer than wanted, so
// that none is much shorter than those before, and the same length is kept while nothing speaks against it.
void Simulation::Impl::advance_controlled(double t_t0, double t_t1, FrameReport& report) {
  double t = t_t0, h = 0;
  int left = 0, retries = 0;
  for (;;) {
    const double longest = std::min(control->wanted(), stepper.longest_step());
    const int needed = std::max(1, static_cast<int>(std::ceil((t_t1 - t) / longest - 1e-9)));
    if (needed != left) {
      left = needed;
      h = (t_t1 - t) / left;
    }
    const bool last_try = retries == scene.solver.halvings || h < integrator::StepControl::kShortestStep;
    const Rejection rejection = attempt(t, h, last_try || retries >= kHalvingsBeforePinch, report);
    if (rejection && last_try) give_up(t, h, *rejection);
    // An impact may ask for steps without end: after as many tries its error is taken as it is.
    if (rejection || !(last_try || control->accepts(h, local_error))) {
      ++report.rejected_steps, ++retries;
      rejection ? control->unsolved(h) : control->too_inexact(h, local_error);
      continue;
    }
    report.inexact_steps += !control->meets(local_error);
    control->accepted(h, local_error);
    accept(h, report);
    retries = 0;
    if (--left == 0) return;
    t += h;
  }
}

FrameReport Simulation::Impl::advance() {
  FrameReport report;
  {
    const Stopwatch watch(report.simulate_wall_s, report.simulate_cpu_s);
    // Frame k is at k / fps exactly, whatever the steps between.
    const double t_t0 = frame / scene.time.fps, t_t1 = (frame + 1) / scene.time.fps;
    system.forget();
    if (collisions) collisions->forget();
    const integrator::State start = now;
    const integrator::Stepper stepper_start = stepper;
    const auto control_start = control;
    try {
      control ? advance_controlled(t_t0, t_t1, report) : advance_equally(t_t0, t_t1, report);
      measure_energies(report);
      energy_bound->check(frame + 1, report);
    } catch (const Error&) {
      now = start;
      stepper = stepper_start;
      control = control_start;
      throw;
    }
    environment.move_to(t_t1);
    ++frame;
    write_back();
  }
  report.frame = frame;
  report.time = frame / scene.time.fps;
  measure(report);
  report_pinches(report);
  current = make_snapshot();
  return report;
}

// The environment holds what the frame shows.
void Simulation::Impl::write_back() {
  for (std::size_t c = 0; c < environment.cloths.size(); ++c) {
    environment::Motion& motion = environment.cloths[c].motion;
    const auto first = static_cast<std::size_t>(system.first_particle(c));
    for (std::size_t i = 0; i < motion.positions.size(); ++i) {
      motion.positions[i] = now.x[first + i];
      motion.velocities[i] = now.v[first + i];
      motion.accelerations[i] = acceleration[first + i];
    }
  }
}

void Simulation::Impl::measure_energies(FrameReport& report) const {
  report.kinetic_energy = system.kinetic_energy(now.v);
  report.potential_energy = system.potential_energy(now.x, scene.physics.gravity);
  report.elastic_energy = system.elastic_energy(now.x);
}

void Simulation::Impl::measure(FrameReport& report) const {
  report.max_strain = system.max_strain(now.x);
  report.constraints = static_cast<int>(held.size());
  report.min_distance = std::numeric_limits<double>::infinity();
  if (!collisions) return;
  report.proximities = collisions->proximities();
  report.constraints += collisions->response().active(now.x);
  report.min_distance = collisions->min_distance();
}

void Simulation::Impl::report_pinches(FrameReport& report) {
  if (!collisions) return;
  CollisionStage::Pinches pinches = collisions->take_pinches();
  report.pinched_pairs = pinches.pairs;
  for (const std::string& text : pinches.begun) report.pinches.push_back(fmt::format("frame {}: {}", frame, text));
}

frame::SnapshotPtr Simulation::Impl::make_snapshot() const {
  std::vector<std::vector<float>> heat;
  for (std::size_t c = 0; c < scene.cloths.size() && scene.render.heat != scene::HeatQuantity::none; ++c) {
    if (scene.render.heat == scene::HeatQuantity::strain) {
      heat.push_back(system.strain_per_particle(c, now.x));
      continue;
    }
    heat.emplace_back();
    for (const Vec3& v : environment.cloths[c].motion.velocities) heat.back().push_back(static_cast<float>(v.norm()));
  }
  return snapshots.make(frame, frame / scene.time.fps, environment, std::move(heat));
}

// Mean accelerations of the last step are left out: nothing looks at them before the next one.
template <class Archive>
void Simulation::Impl::exchange(Archive& archive) {
  archive.value(frame);
  if constexpr (Archive::kReads)
    require(frame >= -scene.preroll_frames() && frame < kMostFrames, "a frame of the scene");
  const std::size_t particles = system.masses().size();
  exchange_points(archive, now.x, particles);
  exchange_points(archive, now.v, particles);
  stepper.exchange(archive, particles);
  if (control) control->exchange(archive);
  system.exchange(archive);
  energy_bound->exchange(archive);
  simulation::exchange(archive, start_report);
  if (collisions) collisions->exchange(archive, environment, now);
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
  return impl_->now.x.size();
}

ParticleState Simulation::state() const {
  return {impl_->now.x, impl_->now.v, impl_->system.masses()};
}

bool Simulation::run_preroll(const std::function<bool()>& proceed) {
  FrameReport& report = impl_->start_report;
  while (impl_->frame < 0) {
    if (!proceed()) return false;
    const std::vector<std::string> pinches = report.pinches;
    report = impl_->advance();
    report.pinches.insert(report.pinches.begin(), pinches.begin(), pinches.end());
  }
  return true;
}

void Simulation::save(std::string& bytes) const {
  ByteWriter writer{std::move(bytes)};
  impl_->exchange(writer);
  bytes = std::move(writer.bytes);
}

void Simulation::restore(std::string_view bytes) {
  ByteReader reader{bytes};
  impl_->exchange(reader);
  require(reader.bytes.empty(), "an end");
  impl_->environment.move_to(impl_->frame / impl_->scene.time.fps);
  impl_->write_back();
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
