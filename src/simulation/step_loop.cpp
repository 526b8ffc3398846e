#include "simulation/step_loop.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/archive.hpp"
#include "core/error.hpp"
#include "core/numerics.hpp"
#include "core/parallel.hpp"
#include "core/timer.hpp"
#include "simulation/step_settings.hpp"

namespace weft::simulation {
namespace {

// Times what was told of before, from which on it is told of again.
constexpr double kToldAgain = 1.5;

}  // namespace

StepLoop::StepLoop(const scene::Scene& scene, const environment::Environment& environment, double start)
    : scene_(scene),
      environment_(environment),
      start_(-scene.preroll_frames() / scene.time.fps),
      cloth_(scene, environment),
      problem_(cloth_),
      pins_(scene, environment, first_particles(cloth_), cloth_.masses()),
      progress_{start_of(scene, environment, cloth_, start), step_control_of(scene),
                std::numeric_limits<double>::infinity()},
      stepper_(method_of(scene.time.integrator), newton_of(scene)),
      told_shares_(cloth_.cloths(), 0),
      attachments_(scene, environment, first_particles(cloth_), cloth_.first_of_frames(environment)),
      weather_(scene),
      gravity_(weather_.gravity(start)) {
  Moment& now = progress_.now;
  pins_.begin_step(start, 0, now.x);
  held_ = pins_.held();
  cloth_.hold(held_);
  for (const integrator::HeldParticle& particle : held_) now.v[particle.constraint.particle] = particle.v_end;
  if (CollisionStage::needed(scene)) {
    collisions_.emplace(scene, environment, cloth_, now);
    problem_.use_contacts(collisions_->response(), collisions_->rigid_vertices());
  }
  if (!attachments_.empty()) problem_.use_attachments(attachments_);
  cloth_.inflate(start - start_, now.particles());
  next_ = now;
}

void StepLoop::take_over(const StepLoop& before, std::span<const std::size_t> cloths) {
  dressed_.assign(cloths.begin(), cloths.end());
  for (std::size_t c = 0; c < cloths.size(); ++c) {
    const Index there = before.cloth_.first_particle(c), here = cloth_.first_particle(cloths[c]);
    const Index count = before.cloth_.first_particle(c + 1) - there;
    std::copy_n(before.progress_.now.x.begin() + there, count, progress_.now.x.begin() + here);
    std::copy_n(before.progress_.now.v.begin() + there, count, progress_.now.v.begin() + here);
    pins_.take_over(before.pins_, there, here, count);
    told_shares_[cloths[c]] = before.told_shares_[c];
  }
  for (std::size_t p = 0; p + before.cloth_.cloths() < before.cloth_.parts(); ++p) {
    const Index there = before.cloth_.first_particle(before.cloth_.cloths() + p),
                here = cloth_.first_particle(cloth_.cloths() + p);
    std::copy_n(before.progress_.now.x.begin() + there, mesh::RigidFrame::kParticles, progress_.now.x.begin() + here);
    std::copy_n(before.progress_.now.v.begin() + there, mesh::RigidFrame::kParticles, progress_.now.v.begin() + here);
  }
  if (collisions_) collisions_->follow_frames(progress_.now);
  if (collisions_ && before.collisions_) collisions_->take_over(*before.collisions_, cloths);
  cloth_.inflation().take_over(before.cloth_.inflation(), cloths);
  attachments_.take_over(before.attachments_, cloths);
  next_ = progress_.now;
}

void StepLoop::untangle() {
  if (!collisions_) return;
  collisions_->untangle(scene_, held_, dressed_, progress_.now);
  next_ = progress_.now;
}

double StepLoop::lift_bodies() {
  if (!collisions_ || collisions_->rigid_vertices() == nullptr) return 0;
  const Vec3 up = scene_.up == scene::UpAxis::z ? Vec3::UnitZ() : Vec3::UnitY();
  const double lift = collisions_->lift_bodies(up, start_, progress_.now);
  next_ = progress_.now;
  return lift;
}

std::vector<Vec3> StepLoop::contact_forces() const {
  std::vector<Vec3> forces(cloth_.masses().size(), Vec3::Zero()), friction = forces;
  std::vector<double> limit(forces.size(), 0);
  problem_.contact_forces({.x = {}, .v = {}, .x_end = progress_.now.x}, forces, friction, limit);
  for (std::size_t i = 0; i < forces.size(); ++i) forces[i] += friction[i];
  return forces;
}

std::vector<Vec3> StepLoop::vertices_of(std::size_t body) const {
  std::vector<Vec3> vertices;
  if (!environment_.bodies[body].dynamics) return vertices;
  const Index first = cloth_.first_of_frames(environment_)[body];
  vertices.resize(environment_.bodies[body].mesh.positions.size());
  environment_.bodies[body].dynamics->frame.place(
      std::span(progress_.now.x).subspan(static_cast<std::size_t>(first), mesh::RigidFrame::kParticles), vertices);
  return vertices;
}

void StepLoop::advance(double t_t0, double t_t1, FrameReport& report) {
  if (cloth_.masses().empty()) return;  // bodies alone are shown
  if (collisions_) collisions_->forget();
  progress_.control ? advance_controlled(t_t0, t_t1, report) : advance_equally(t_t0, report);
}

// A frame in equal steps, but for what rests. Times are counted in steps: the same in frames of other lengths.
void StepLoop::advance_equally(double t_t0, FrameReport& report) {
  const double fps = scene_.time.fps;
  const int steps = std::max(1, static_cast<int>(std::ceil(1 / (fps * scene_.time.step) - 1e-9)));
  const double h = 1 / (fps * steps);
  if (steps > 1 && may_rest(t_t0, h, steps) && rest(t_t0, 1 / fps, report)) return;
  const double done = std::round(t_t0 * fps) * steps;
  for (int s = 0; s < steps; ++s) advance_over((done + s) / (fps * steps), h, 0, scene_.solver.halvings, report);
}

// Whether all cloth is slow and stays so, by its last step, and at the ends of so many steps of length h all that the
// scene moves is where it is at t. What begins to move is not tried in one step: what that leaves behind, contacts
// which it alone would need, would be felt in those that follow.
bool StepLoop::may_rest(double t, double h, int steps) {
  const double whole = steps * h;
  // Velocity constraints let go and stick again step by step.
  const bool by_steps = scene_.contact.response == scene::Response::velocity_constraints;
  if (scene_.time.integrator != scene::Integrator::implicit_euler || by_steps || whole > progress_.longest ||
      !is_slow(progress_.now) || !has_settled())
    return false;
  for (int s = 1; s <= steps; ++s) {
    const double end = t + s * h;
    if (!weather_.stays(t, end) || !cloth_.inflation().stays(t, end) || !attachments_.stay(t, end)) return false;
    if (!cloth_.lengths_stay(t, end)) return false;
    if (!pins_.stay(t, end) || !frames_stay(environment_, t, end) ||
        (collisions_ && !collisions_->bodies_stay(t, end, progress_.now, next_)))
      return false;
  }
  return true;
}

// Whether velocities hardly changed in the last step.
bool StepLoop::has_settled() const {
  const integrator::Stepper::History& last = stepper_.history();
  if (last.h == 0) return false;
  double sum = 0;
  for (std::size_t i = 0; i < last.before.v.size(); ++i) sum += (progress_.now.v[i] - last.before.v[i]).squaredNorm();
  const double most = numerics.newton.unseen_acceleration * last.h;
  return sum <= most * most * static_cast<double>(last.before.v.size());
}

bool StepLoop::is_slow(const Moment& moment) {
  return std::ranges::all_of(moment.v, [](const Vec3& v) {
    return v.squaredNorm() <= numerics.steps.rest_velocity * numerics.steps.rest_velocity;
  });
}

// One step in place of several; false where something wakes up, and then no more is left of it than of a rejected step.
bool StepLoop::rest(double t, double h, FrameReport& report) {
  if (attempt(t, h, 0, false, report)) return false;
  if (!is_slow(next_) || local_error_ > 0.5 * h * h * numerics.newton.unseen_acceleration) return false;
  accept(h, report);
  return true;
}

// Goes from t to t + h, in two halves where one step is rejected, or longer than may follow the last one or than
// obstacles allow. `retries` are halvings for a rejection, now or before: counted anew below steps that are still short
// for one, cloth pinched between jaws was asked again and again for shorter steps, down to 10 µs (75,202 for 160).
void StepLoop::advance_over(double t, double h, int retries, int halvings, FrameReport& report) {
  const bool after_rejection = h > (1 + 1e-9) * progress_.longest;
  const bool too_long = after_rejection || h > (1 + 1e-9) * stepper_.longest_step() || turns_too_far(t, h);
  if (!too_long) {
    const Rejection rejection = attempt(t, h, retries, halvings == 0, report);
    if (!rejection) return accept(h, report);
    ++report.rejected_steps;
    if (halvings == 0) fail(report.frame, t, h, *rejection);
    --halvings;
  }
  if (!too_long || after_rejection) ++retries;
  advance_over(t, 0.5 * h, retries, halvings, report);
  advance_over(t + 0.5 * h, 0.5 * h, retries, halvings, report);
}

// In steps whose error is time.tolerance. What is left of the frame is cut into equal steps no longer than wanted, so
// that none is much shorter than those before, and the same length is kept while nothing speaks against it.
void StepLoop::advance_controlled(double t_t0, double t_t1, FrameReport& report) {
  integrator::StepControl& control = *progress_.control;
  double t = t_t0, h = 0;
  int left = 0, retries = 0;
  for (;;) {
    const double longest = std::min(control.wanted(), stepper_.longest_step());
    const int needed = std::max(1, static_cast<int>(std::ceil((t_t1 - t) / longest - 1e-9)));
    if (needed != left) {
      left = needed;
      h = (t_t1 - t) / left;
    }
    for (; turns_too_far(t, h); h *= 0.5) left *= 2;
    const bool last_try = retries == scene_.solver.halvings || h < numerics.steps.least;
    const Rejection rejection = attempt(t, h, retries, last_try, report);
    if (rejection && last_try) fail(report.frame, t, h, *rejection);
    // An impact may ask for steps without end: after as many tries its error is taken as it is.
    if (rejection || !(last_try || control.accepts(h, local_error_))) {
      ++report.rejected_steps, ++retries;
      rejection ? control.unsolved(h) : control.too_inexact(h, local_error_);
      continue;
    }
    report.inexact_steps += !control.meets(local_error_);
    control.accepted(h, local_error_);
    accept(h, report);
    retries = 0;
    if (--left == 0) return;
    t += h;
  }
}

void StepLoop::fail(int frame, double t, double h, const std::string& reason) const {
  throw Error(ExitCode::simulation_failed,
              "frame {}: the step at t = {:.6g} s was rejected down to h = {:.3g} s: {}; try a smaller time.{} or "
              "softer material",
              frame, t, h, reason, progress_.control ? "tolerance" : "step");
}

// One step from now at time t [s] over h [s] into `next_`. Pins that something keeps from getting where they are to be
// are let go, and the step is done again.
StepLoop::Rejection StepLoop::attempt(double t, double h, int retries, bool last_try, FrameReport& report) {
  for (int tries = 1;; ++tries) {
    pins_.begin_step(t, h, progress_.now.x);
    Rejection rejection = attempt_with(t, h, retries, last_try, tries == numerics.repair.tries, report);
    if (!rejection && collisions_ && !last_try && retries < numerics.repair.halvings) rejection = torn(h, true);
    if (!collisions_ || collisions_->gave_way().empty() || tries == numerics.repair.tries) return rejection;
    if (!is_short_enough(retries, last_try) && !pins_.any_lags()) return rejection;
    for (const collision::GivenWay& given : collisions_->gave_way())
      pins_.let_go(given.particle, collisions_->describe(given, progress_.now));
  }
}

// Asks for a shorter step than the one to `next_` where that tears threads; one that is not solved, where it diverges.
StepLoop::Rejection StepLoop::torn(double h, bool solved) {
  const auto start = progress_.now.particles(), end = next_.particles();
  if (!solved) {
    const double strain = cloth_.max_strain(end);
    if (strain <= numerics.repair.diverged_strain ||
        strain <= cloth_.max_strain(start) + numerics.repair.diverged_strain)
      return std::nullopt;
    progress_.longest = 0.5 * h;
    return fmt::format("the solve diverges, to a strain of {:.2g}", strain);
  }
  const double share = cloth_.overstretch(end).share;
  if (share <= 1 + numerics.repair.overstretch ||
      share <= cloth_.overstretch(start).share + numerics.repair.overstretch)
    return std::nullopt;
  progress_.longest = 0.5 * h;
  return fmt::format("threads are stretched to {:.2g} times their max_stretch at once", share);
}

// Gravity of the step from t over h, and the air where unchanged velocities lead particles until its stage.
void StepLoop::update_weather(double t, double h) {
  const double later = method() == integrator::Method::implicit_midpoint ? 0.5 * h : h;
  gravity_ = weather_.gravity(t + later);
  cloth_.use_gravity(gravity_);
  if (!weather_.is_local()) return;
  const Moment& now = progress_.now;
  std::vector<solver::Quad<double>> air(now.v.size());
  parallel_for(air.size(), kFineGrainSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      air[i] = solver::quad_of<double>(weather_.air(now.x[i] + later * now.v[i], t + later));
  });
  problem_.blow(std::move(air));
}

// Whether a shorter step would find no room that this one does not.
bool StepLoop::is_short_enough(int retries, bool last_try) const {
  return last_try || (retries >= numerics.repair.halvings && collisions_->obstacles_creep(progress_.now, next_));
}

// The same with pins as they are.
StepLoop::Rejection StepLoop::attempt_with(double t, double h, int retries, bool last_try, bool may_give_way,
                                           FrameReport& report) {
  using Start = integrator::Stepper::Start;
  const Moment& now = progress_.now;
  held_ = pins_.held();
  hold_frames(environment_, cloth_, t + h, held_);
  // What is let go changes its acceleration at once: the history says nothing of what follows.
  const bool lets_go = release_frames(environment_, cloth_, t, h, progress_.now.v) || pins_.release_between(t, t + h);
  if (lets_go) stepper_.restart();
  pinned_ = held_.size();
  problem_.begin_step(t + h - start_, now.particles(), held_, pins_.pulls());
  attachments_.begin_step(t, t + h, now.particles());
  Start start = Start::unchanged_velocity;
  if (collisions_) {
    const Stopwatch watch(report.collide);
    if (collisions_->begin_step(t, h, held_, progress_.now, next_)) start = Start::next;
  }
  update_weather(t, h);
  if (!collisions_) return reason_of(solve(h, start, false, report));
  collision::ContactResponse& response = collisions_->response();
  const auto force_on = [&](Index particle) { return stepper_.constraint_force(particle, cloth_.masses()[particle]); };
  int adoptions = 0, bends = 0;
  bool look = true;
  for (bool is_first = true;; is_first = false, start = Start::next) {
    held_.resize(pinned_);
    collisions_->append_prescribed(held_);
    const bool may_bend = bends < numerics.repair.restarts && collisions_->may_bend();
    integrator::StepReport step = solve(h, start, look && (is_first || may_bend), report);
    // Loads that follow friction, and friction that follows them, can drive each other up: a sheet with friction 10
    // that fell on a cone had 1,300 J after a look, of 0.5 J, and went on from there. With loads that are kept friction
    // has a potential, and takes energy whatever they are.
    if (is_first && step.verdict == integrator::Verdict::unfinished &&
        added_share(energy(now), h) > numerics.repair.astray_energy) {
      problem_.keep_loads();
      step = solve(h, Start::unchanged_velocity, look, report);
    }
    if (Rejection rejection = reason_of(step)) {
      progress_.longest = 0.5 * h;
      return rejection;
    }
    const Stopwatch watch(report.collide);
    const bool solved = step.verdict == integrator::Verdict::solved;
    // A solve that diverges scatters particles. All pairs of triangles may then meet, and to find and push them apart
    // takes a hundred times what the step takes in halves.
    if (!solved && !last_try && retries < numerics.repair.halvings)
      if (Rejection rejection = torn(h, false)) return rejection;
    look = true;
    const bool may_adopt = bends == 0 && adoptions + 1 < response.most_solves();
    if (solved && response.revise(now.x, next_.x, force_on) > 0 && may_adopt) {
      ++adoptions;
    } else if (collisions_->apart(now, next_)) {
      if (solved) return std::nullopt;
      look = false;
    } else if (may_adopt && collisions_->adopt_failing(now, next_) > 0) {
      ++adoptions;
      if (solved) response.revise(now.x, next_.x, force_on);
    } else if (may_bend) {
      // Where cloth that a pin presses on could be moved, the solve has not moved it.
      const bool may_let_go = bends > 0 && !may_give_way && (is_short_enough(retries, last_try) || pins_.any_lags());
      if (may_let_go && collisions_->find_pressing_pins()) return "pins press cloth into cloth";
      const double before = solved ? energy(next_) : 0, strain = solved ? cloth_.max_strain(next_.particles()) : 0;
      if (collisions_->push_apart(h, false, false, now, next_)) {
        bends = numerics.repair.restarts;  // and what is stuck shows once this is solved
        continue;
      }
      if (solved && added_share(before, h) <= numerics.repair.unfelt_energy &&
          cloth_.max_strain(next_.particles()) <= strain + numerics.repair.unfelt_strain)
        return std::nullopt;
      ++bends;
      collisions_->go_on_from(next_);
      problem_.forget_contacts();
    } else if (solved) {
      return correct(h, retries, last_try, may_give_way);
    }
  }
}

// Moves particles of `next_` apart, or asks for a shorter step where that adds much energy.
StepLoop::Rejection StepLoop::correct(double h, int retries, bool last_try, bool may_give_way) {
  const double before = energy(next_);
  const bool may_pinch = is_short_enough(retries, last_try);
  if (Rejection stuck = collisions_->push_apart(h, may_pinch, may_give_way, progress_.now, next_)) return stuck;
  if (last_try || retries >= numerics.repair.halvings) return std::nullopt;
  const double share = added_share(before, h);
  if (share <= numerics.repair.corrected_energy) return std::nullopt;
  progress_.longest = 0.5 * h;
  return fmt::format("keeping cloth from passing through adds {:.2g} times the energy of its motion and threads",
                     share);
}

// [J]
double StepLoop::energy(const Moment& moment) const {
  return cloth_.elastic_energy(moment.particles()) + cloth_.air_energy(moment.particles()) +
         attachments_.energy(moment.particles()) + cloth_.kinetic_energy(moment.v) +
         cloth_.potential_energy(moment.particles(), gravity_);
}

// Of the energy in play, what `next_` has more than `before` [J]. At rest the motion of a step of free fall counts.
double StepLoop::added_share(double before, double h) const {
  double mass = 0;
  for (const double m : cloth_.masses()) mass += m;
  const double fall = h * gravity_.norm();
  const double motion = std::max(cloth_.kinetic_energy(progress_.now.v), 0.5 * mass * fall * fall);
  return (energy(next_) - before) / (motion + cloth_.elastic_energy(progress_.now.particles()));
}

// The midpoint rule damps nothing, and contacts that come and go would shake cloth apart: where any is near a step is
// one of BDF2.
integrator::Method StepLoop::method() const {
  const integrator::Method chosen = method_of(scene_.time.integrator);
  const bool damps = chosen == integrator::Method::implicit_midpoint && collisions_ && !collisions_->response().empty();
  return damps ? integrator::Method::bdf2 : chosen;
}

// Into `next_`. `look`: where this takes long it ends unfinished.
integrator::StepReport StepLoop::solve(double h, integrator::Stepper::Start start, bool look, FrameReport& report) {
  stepper_.use(method());
  const integrator::StepReport step =
      stepper_.step(problem_, progress_.now, h, gravity_, held_, next_, start,
                    look ? numerics.newton.check_after : std::numeric_limits<int>::max());
  if (collisions_) collisions_->follow_frames(next_);
  report.newton_iterations += step.newton_iterations;
  report.linear_iterations += step.linear_iterations;
  report.forces += step.times.forces;
  report.preconditioner += step.times.preconditioner;
  report.linear += step.times.linear;
  local_error_ = step.local_error;
  solver_error_ = step.solver_error;
  return step;
}

StepLoop::Rejection StepLoop::reason_of(const integrator::StepReport& step) {
  if (step.verdict == integrator::Verdict::solved || step.verdict == integrator::Verdict::unfinished)
    return std::nullopt;
  return fmt::format("{} (a velocity of {:.2g} m/s left where {:.2g} may be, after {} iterations)",
                     integrator::describe(step.verdict), step.left, step.allowed, step.newton_iterations);
}

// Makes `next_`, reached over h, the state.
void StepLoop::accept(double h, FrameReport& report) {
  count_work(measure_work(stepper_, std::span(held_).first(pinned_), cloth_.masses(), progress_.now, next_), report);
  stepper_.accept(progress_.now, next_, h);
  pins_.accept();
  attachments_.accept(next_.particles());
  if (collisions_) collisions_->accept();
  std::swap(progress_.now, next_);
  progress_.longest *= numerics.steps.recovery;
  measure_stretch(report);
  ++report.steps;
  report.error_estimate += local_error_;
  report.solver_error += solver_error_;
}

// Of the step that led from `next_` to now. What goes beyond the limit is told where it begins, and again where it goes
// half as far beyond once more: a tight waist would be told of with every breath.
void StepLoop::measure_stretch(FrameReport& report) {
  report.max_strain = std::max(report.max_strain, cloth_.max_strain(progress_.now.particles()));
  const ClothSystem::Overstretch most = cloth_.overstretch(progress_.now.particles());
  const bool begins = report.stretch_share <= kOverstretch && most.share > kOverstretch;
  report.stretch_share = std::max(report.stretch_share, most.share);
  if (!begins || cloth_.overstretch(next_.particles()).share > kOverstretch) return;
  double& told = told_shares_[most.cloth];
  if (most.share < kToldAgain * told) return;
  told = most.share;
  report.warnings.push_back(
      fmt::format("frame {}: '{}' is stretched by {:.0f} %, which its threads do not allow (max_stretch {:g}), near "
                  "({:.4g}, {:.4g}, {:.4g}) m",
                  report.frame, scene_.cloths[most.cloth].name, 100 * most.extension, most.extension / most.share,
                  most.place.x(), most.place.y(), most.place.z()));
}

template <class Archive>
void StepLoop::serialize(Archive& archive) {
  Moment& now = progress_.now;
  const std::size_t particles = cloth_.masses().size();
  std::vector<Vec3> x(now.particles().begin(), now.particles().end());
  serialize_points(archive, x, particles);
  std::ranges::copy(x, now.x.begin());
  serialize_points(archive, now.v, particles);
  stepper_.serialize(archive, particles);
  if (progress_.control) progress_.control->serialize(archive);
  archive.value(progress_.longest);
  if constexpr (Archive::kReads) require(progress_.longest > 0, "a step length");
  cloth_.serialize(archive);
  pins_.serialize(archive);
  attachments_.serialize(archive);
  for (double& share : told_shares_) {
    archive.value(share);
    if constexpr (Archive::kReads) require(share >= 0, "a share of a limit to stretch");
  }
}

template void StepLoop::serialize(ByteWriter&);
template void StepLoop::serialize(ByteReader&);

}  // namespace weft::simulation
