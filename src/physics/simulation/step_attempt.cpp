// One attempt at a step: StepLoop::attempt and the functions that it calls.
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "core/numerics.hpp"
#include "core/parallel.hpp"
#include "core/timer.hpp"
#include "physics/simulation/step_loop.hpp"
#include "physics/simulation/step_settings.hpp"

namespace weft::simulation {

// Attempts the step. If obstacles or other cloth keep pinned particles from their targets, repeats it with these
// particles released. After `numerics.repair.max_retries` tries, allows push_apart() to move pinned particles.
StepLoop::Rejection StepLoop::attempt(double t, double h, int rejections, bool is_last, FrameReport& report) {
  for (int tries = 1;; ++tries) {
    const Attempt attempt{t, h, rejections, is_last, tries > numerics.repair.max_retries};
    pins_.begin_step(t, h, progress_.now.x);
    const Start start = begin_attempt(attempt, report);
    if (!collisions_) return rejection_of(solve(attempt, start, false, report));

    const bool with_springs = collisions_->response().form() == collision::ResponseForm::springs;
    Rejection rejection = with_springs ? solve_with_springs(attempt, start, report)
                                       : solve_with_velocity_constraints(attempt, start, report);
    if (!rejection || collisions_->obstructed_pins().empty() || !may_release_pins(attempt)) return rejection;
    for (const collision::ObstructedPin& pin : collisions_->obstructed_pins())
      pins_.release_particle(pin.particle, collisions_->describe(pin, progress_.now));
  }
}

// Sets up pins, bodies, forces and contacts. Returns where the solve starts.
StepLoop::Start StepLoop::begin_attempt(const Attempt& attempt, FrameReport& report) {
  const double t = attempt.t, h = attempt.h;
  held_ = pins_.held();
  hold_frames(model_, cloth_, t + h, held_);
  // If a rejected attempt contained the time at which the model releases a pin or body, this attempt
  // first undoes the release, because its step may end before that time.
  if (before_release_) {
    progress_.now.v = std::move(before_release_->v);
    stepper_.return_to(std::move(before_release_->history));
    before_release_.reset();
  }
  // The acceleration of released particles jumps, so the stepper's history does not predict their motion.
  if (any_frame_is_released(model_, t, h) || pins_.release_between(t, t + h)) {
    before_release_ = {progress_.now.v, stepper_.history()};
    release_frames(model_, cloth_, t, h, progress_.now.v);
    stepper_.restart();
  }
  pinned_ = held_.size();
  step_end_ = t + h;
  attachments_.begin_step(t, t + h, progress_.now.particles(), cloth_.masses());
  Start start = Start::unchanged_velocity;
  if (collisions_) {
    const Stopwatch watch(report.collide);
    if (collisions_->begin_step(t, h, held_, progress_.now, next_, attempt.rejections > 0)) start = Start::next;
  }
  begin_solve(attempt);
  return start;
}

// Begins the first solve of a step, or that in which contacts replace its method. Forces that change with time are
// those of the time of the stage (integrator::Stepper), which follows from method() and thus from the contacts. Held
// particles, contacts and attachments have their positions at the end of the step.
void StepLoop::begin_solve(const Attempt& attempt) {
  stepper_.set_method(method());
  stepper_.discard_unfinished_step();
  const double until_stage = stepper_.method() == integrator::Method::implicit_midpoint ? 0.5 * attempt.h : attempt.h;
  problem_.begin_step(attempt.t + until_stage - start_, progress_.now.particles(), std::span(held_).first(pinned_),
                      pins_.pulls());
  update_weather(attempt.t, until_stage);
}

// Sets gravity and the air velocity at the time t + until_stage of the step's stage. Evaluates the air velocity at the
// positions that the particles reach until then with unchanged velocities.
void StepLoop::update_weather(double t, double until_stage) {
  gravity_ = weather_.gravity(t + until_stage);
  cloth_.use_gravity(gravity_);
  if (!weather_.differs_from_wind()) return;
  const SystemState& now = progress_.now;
  std::vector<solver::PaddedVec3<double>> air(now.v.size());
  parallel_for(air.size(), kFineGrainSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      air[i] = solver::padded<double>(weather_.air(now.x[i] + until_stage * now.v[i], t + until_stage));
  });
  problem_.set_air_velocity(std::move(air));
}

// Solves the step, and checks whether every candidate pair has a separating plane. If a pair has none, pushes particles
// apart. If the solve was complete and the push adds little energy and strain, accepts the result. Otherwise continues
// the solve from the pushed positions, with contacts found anew. After `numerics.newton.slow_after` continuations, or
// if a continuation ends where it began, completes the solve and only pushes.
StepLoop::Rejection StepLoop::solve_with_springs(const Attempt& attempt, Start start, FrameReport& report) {
  const SystemState& now = progress_.now;
  int continuations = 0;
  bool fails_anew = true;
  for (bool is_first = true;; is_first = false, start = Start::next) {
    const bool may_continue = continuations < numerics.newton.slow_after;
    // The solve pauses early for another check, if a continuation is left and pairs failed for the first time in this
    // step. Otherwise it runs to its end: the contacts of all pairs that failed are in it already. (Measured with
    // pauses also then: a step of a sewn dress takes 89 Newton iterations, not 31, as one pair fails twenty times.)
    const bool check_early = fails_anew && may_continue;
    bool solved = false;
    if (Rejection rejection = solve_contacts(attempt, start, is_first, check_early, solved, report)) return rejection;
    const Stopwatch watch(report.collide);
    const bool is_separated = collisions_->is_separated(now, next_);
    fails_anew = !is_separated && collisions_->fails_anew();
    if (is_separated && solved) return std::nullopt;
    if (!is_separated && !may_continue && solved) return push_apart(attempt);
    if (is_separated || !may_continue) continue;

    // Even a continued solve has left pairs without a separating plane: pins may press cloth into cloth.
    if (continuations > 0 && may_release_pins(attempt) && collisions_->find_pins_between_cloths())
      return "pins press cloth into cloth";
    const double energy_before = solved ? energy(next_) : 0;
    const double strain_before = solved ? cloth_.max_strain(next_.particles()) : 0;
    if (collisions_->push_apart(attempt.h, false, false, now, next_)) {
      // Some pairs cannot be pushed apart: completes the solve; then push_apart(attempt) accepts or rejects.
      continuations = numerics.newton.slow_after;
      continue;
    }
    if (solved && added_energy_ratio(energy_before, attempt.h) <= numerics.energy.doubtful_gain &&
        cloth_.max_strain(next_.particles()) <= strain_before + numerics.repair.added_strain)
      return std::nullopt;
    continuations = collisions_->restarts_at(next_) ? numerics.newton.slow_after : continuations + 1;
    collisions_->continue_from(next_);
    problem_.limit_friction_updates();
  }
}

// Solves the step with velocity constraints (Etzmuß et al. 2001). After each solve, the response sets and releases
// constraints; pairs without a separating plane get contacts. After `numerics.walls.max_solves` solves, only pushes
// particles apart.
StepLoop::Rejection StepLoop::solve_with_velocity_constraints(const Attempt& attempt, Start start,
                                                              FrameReport& report) {
  const SystemState& now = progress_.now;
  collision::ContactResponse& response = collisions_->response();
  const auto force_on = [&](Index particle) { return stepper_.constraint_force(particle, cloth_.masses()[particle]); };
  int revisions = 0;
  for (bool is_first = true;; is_first = false, start = Start::next) {
    bool solved = false;
    if (Rejection rejection = solve_contacts(attempt, start, is_first, is_first, solved, report)) return rejection;
    const Stopwatch watch(report.collide);
    const bool may_revise = revisions + 1 < numerics.walls.max_solves;
    if (solved && response.revise(now.x, next_.x, force_on) > 0 && may_revise) {
      ++revisions;
    } else if (collisions_->is_separated(now, next_)) {
      if (solved) return std::nullopt;
    } else if (may_revise && collisions_->add_failing_contacts(now, next_) > 0) {
      ++revisions;
      if (solved) response.revise(now.x, next_.x, force_on);
    } else if (solved) {
      return push_apart(attempt);
    }
  }
}

// Solves the step with the current contacts and constraints; writes the result into `next_`. Sets
// `solved` to true if the solve has reached its tolerance, to false if it pauses for an early check.
StepLoop::Rejection StepLoop::solve_contacts(const Attempt& attempt, Start start, bool is_first, bool check_early,
                                             bool& solved, FrameReport& report) {
  held_.resize(pinned_);
  collisions_->append_prescribed_particles(held_);
  collisions_->forget_obstructed_pins();
  integrator::StepReport step = solve(attempt, start, check_early, report);
  // Normal forces and friction depend on each other, and can increase each other without bound. If
  // the first solve of a step is unfinished and has added much energy, a second solve uses fixed
  // normal forces: friction then has a potential, and dissipates. (Measured without the second
  // solve: a sheet of 0.5 J with friction 10 gains 1,300 J.)
  if (is_first && step.verdict == integrator::Verdict::unfinished &&
      added_energy_ratio(energy(progress_.now), attempt.h) > numerics.repair.diverged_energy_ratio) {
    problem_.fix_normal_forces();
    step = solve(attempt, Start::unchanged_velocity, check_early, report);
  }
  if (Rejection rejection = rejection_of(step)) {
    progress_.longest = 0.5 * attempt.h;
    return rejection;
  }
  solved = step.verdict == integrator::Verdict::solved;
  return std::nullopt;
}

// `check_early`: the solve pauses after `numerics.newton.check_after` iterations, so that contacts on the new
// trajectory are found early.
integrator::StepReport StepLoop::solve(const Attempt& attempt, Start start, bool check_early, FrameReport& report) {
  if (stepper_.method() != method()) begin_solve(attempt);
  const integrator::StepReport step =
      stepper_.step(problem_, progress_.now, attempt.h, gravity_, held_, next_, start,
                    check_early ? numerics.newton.check_after : std::numeric_limits<int>::max());
  if (collisions_) collisions_->place_rigid_vertices(next_);
  report.newton_iterations += step.newton_iterations;
  report.linear_iterations += step.linear_iterations;
  report.forces += step.times.forces;
  report.preconditioner += step.times.preconditioner;
  report.linear += step.times.linear;
  local_error_ = step.local_error;
  solver_error_ = step.solver_error;
  return step;
}

// Returns the method of the current step. The midpoint rule has no damping, so contacts that switch on and off would
// excite cloth. Therefore BDF2 replaces it in steps with contacts.
integrator::Method StepLoop::method() const {
  const integrator::Method chosen = model_.time.integrator;
  const bool needs_damping =
      chosen == integrator::Method::implicit_midpoint && collisions_ && !collisions_->response().empty();
  return needs_damping ? integrator::Method::bdf2 : chosen;
}

// Pushes particles of `next_` apart without solving again. Rejects the step if some pair cannot be pushed apart. Also
// rejects it if the push adds much energy, unless this is the last attempt, or `max_retries` attempts at longer steps
// were rejected.
StepLoop::Rejection StepLoop::push_apart(const Attempt& attempt) {
  const double energy_before = energy(next_);
  if (Rejection stuck =
          collisions_->push_apart(attempt.h, may_pinch(attempt), attempt.may_move_pins, progress_.now, next_))
    return stuck;
  if (attempt.is_last || attempt.rejections >= numerics.repair.max_retries) return std::nullopt;
  const double ratio = added_energy_ratio(energy_before, attempt.h);
  if (ratio <= numerics.energy.doubtful_gain) return std::nullopt;
  progress_.longest = 0.5 * attempt.h;
  return fmt::format(
      "keeping surfaces from passing through each other would add {:.2g} times the energy that cloth has "
      "in motion and stretch",
      ratio);
}

// Whether pinned particles without space may be released: if push_apart() may not move pinned particles, and if this is
// the last attempt or obstacles near cloth move little. If they move far, a shorter step may find space.
bool StepLoop::may_release_pins(const Attempt& attempt) const {
  return !attempt.may_move_pins && (attempt.is_last || collisions_->obstacles_move_little(progress_.now, next_));
}

// Whether cloth without space may pass into an obstacle (PinchedPairs): in the last attempt, or after
// `max_retries` rejections if obstacles move so little that a shorter step would not find more space.
bool StepLoop::may_pinch(const Attempt& attempt) const {
  return attempt.is_last || (attempt.rejections >= numerics.repair.max_retries &&
                             collisions_->obstacles_move_little(progress_.now, next_));
}

// Mechanical energy of a state, with the gravity of the current step [J].
double StepLoop::energy(const SystemState& state) const {
  return cloth_.elastic_energy(state.particles()) + cloth_.air_energy(state.particles()) +
         attachments_.energy(state.particles()) + cloth_.kinetic_energy(state.v) +
         cloth_.potential_energy(state.particles(), gravity_);
}

// Difference between the energy of `next_` and `before` [J], relative to the kinetic and elastic energy at the start of
// the step. The kinetic energy counts as at least that of a free fall from rest over h [s], with at least 1 m/s² as in
// step_control_of(), so that the ratio is bounded for cloth at rest, also without gravity.
double StepLoop::added_energy_ratio(double before, double h) const {
  double mass = 0;
  for (const double m : cloth_.masses()) mass += m;
  const double fall = h * std::max(gravity_.norm(), 1.0);
  const double motion = std::max(cloth_.kinetic_energy(progress_.now.v), 0.5 * mass * fall * fall);
  return (energy(next_) - before) / (motion + cloth_.elastic_energy(progress_.now.particles()));
}

StepLoop::Rejection StepLoop::rejection_of(const integrator::StepReport& step) {
  if (step.verdict == integrator::Verdict::solved || step.verdict == integrator::Verdict::unfinished)
    return std::nullopt;
  return fmt::format("{} (after {} iterations, velocities are off by {:.2g} m/s; at most {:.2g} m/s is allowed)",
                     integrator::describe(step.verdict), step.newton_iterations, step.remaining_error, step.allowed);
}

}  // namespace weft::simulation
