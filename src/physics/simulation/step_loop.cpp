#include "physics/simulation/step_loop.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/archive.hpp"
#include "core/error.hpp"
#include "core/numerics.hpp"
#include "core/parallel.hpp"
#include "physics/simulation/step_settings.hpp"

namespace weft::simulation {
namespace {

// A cloth is reported again only if its stretch is at least this multiple of the last reported one.
constexpr double kReportAgainRatio = 1.5;
// A smaller ClothSystem::Widening::fraction is not reported, because it is not visible.
constexpr double kMinReportedWidening = 0.1;

}  // namespace

StepLoop::StepLoop(const model::Model& model, double start)
    : model_(model),
      start_(model.start_time()),
      cloth_(model),
      problem_(cloth_),
      pins_(model, first_particles(cloth_), cloth_.masses()),
      progress_{start_of(model, cloth_, start), step_control_of(model), std::numeric_limits<double>::infinity()},
      stepper_(model.time.integrator, newton_of(model)),
      reported_overstretch_(cloth_.cloths(), 0),
      attachments_(model, first_particles(cloth_), cloth_.first_of_frames(model)),
      weather_(model),
      gravity_(weather_.gravity(start)) {
  SystemState& now = progress_.now;
  pins_.begin_step(start, 0, now.x);
  held_ = pins_.held();
  cloth_.set_held_particles(held_);
  for (const integrator::HeldParticle& particle : held_) now.v[particle.constraint.particle] = particle.v_end;
  if (CollisionStage::is_needed(model)) {
    collisions_.emplace(model, cloth_, now);
    problem_.use_contacts(collisions_->response(), collisions_->rigid_vertices());
  }
  if (!attachments_.empty()) problem_.use_attachments(attachments_);
  cloth_.update_enclosed_air(start - start_, now.particles());
  step_end_ = start;
  next_ = now;
}

void StepLoop::copy_state_from(const StepLoop& before, std::span<const std::size_t> cloths) {
  put_on_.assign(cloths.begin(), cloths.end());
  for (std::size_t c = 0; c < cloths.size(); ++c) {
    const Index there = before.cloth_.first_particle(c), here = cloth_.first_particle(cloths[c]);
    const Index count = before.cloth_.first_particle(c + 1) - there;
    std::copy_n(before.progress_.now.x.begin() + there, count, progress_.now.x.begin() + here);
    std::copy_n(before.progress_.now.v.begin() + there, count, progress_.now.v.begin() + here);
    pins_.copy_state_from(before.pins_, there, here, count);
    reported_overstretch_[cloths[c]] = before.reported_overstretch_[c];
  }
  for (std::size_t p = 0; p + before.cloth_.cloths() < before.cloth_.parts(); ++p) {
    const Index there = before.cloth_.first_particle(before.cloth_.cloths() + p),
                here = cloth_.first_particle(cloth_.cloths() + p);
    std::copy_n(before.progress_.now.x.begin() + there, mesh::RigidFrame::kParticles, progress_.now.x.begin() + here);
    std::copy_n(before.progress_.now.v.begin() + there, mesh::RigidFrame::kParticles, progress_.now.v.begin() + here);
  }
  if (collisions_) collisions_->place_rigid_vertices(progress_.now);
  if (collisions_ && before.collisions_) collisions_->copy_state_from(*before.collisions_, cloths);
  cloth_.inflation().copy_state_from(before.cloth_.inflation(), cloths);
  attachments_.copy_state_from(before.attachments_, cloths);
  cloth_.copy_sewing_from(before.cloth_, cloths);
  weather_.set_gust_displacement(step_end_, before.weather_.gust_displacement(step_end_));
  cloth_.update_rest_shapes(step_end_ - start_);
  next_ = progress_.now;
}

void StepLoop::untangle() {
  if (!collisions_) return;
  collisions_->untangle(held_, put_on_, progress_.now);
  cloth_.inflation().measure_closed_volumes(progress_.now.particles(), put_on_);
  next_ = progress_.now;
}

double StepLoop::lift_bodies() {
  if (!collisions_ || collisions_->rigid_vertices() == nullptr) return 0;
  const double lift = collisions_->lift_bodies(model_.up, start_, progress_.now);
  next_ = progress_.now;
  return lift;
}

std::vector<Vec3> StepLoop::contact_forces() const {
  std::vector<Vec3> forces(cloth_.masses().size(), Vec3::Zero()), friction = forces;
  std::vector<double> normal_force(forces.size(), 0), limit = normal_force;
  problem_.contact_forces({.x = {}, .v = {}, .x_end = progress_.now.x}, forces, friction, normal_force, limit);
  for (std::size_t i = 0; i < forces.size(); ++i) forces[i] += friction[i];
  return forces;
}

std::vector<Vec3> StepLoop::vertices_of(std::size_t body) const {
  std::vector<Vec3> vertices;
  if (!model_.bodies[body].dynamics) return vertices;
  const Index first = cloth_.first_of_frames(model_)[body];
  vertices.resize(model_.bodies[body].mesh.positions.size());
  model_.bodies[body].dynamics->frame.place(
      std::span(progress_.now.x).subspan(static_cast<std::size_t>(first), mesh::RigidFrame::kParticles), vertices);
  return vertices;
}

void StepLoop::advance(double t_t0, double t_t1, FrameReport& report) {
  if (cloth_.masses().empty()) return;  // no particles: nothing to simulate
  if (collisions_) collisions_->forget();
  progress_.control ? advance_controlled(t_t0, t_t1, report) : advance_equally(t_t0, report);
}

// Divides the frame into equal steps, or takes one step if everything rests. Computes the start of each step from the
// number of steps since time 0, so that it has the same bits at any frame rate.
void StepLoop::advance_equally(double t_t0, FrameReport& report) {
  const double fps = model_.time.fps;
  const int steps = std::max(1, static_cast<int>(std::ceil(1 / (fps * model_.time.step) - 1e-9)));
  const double h = 1 / (fps * steps);
  if (steps > 1 && may_merge_steps(t_t0, h, steps) && attempt_merged_step(t_t0, 1 / fps, report)) return;
  const double done = std::round(t_t0 * fps) * steps;
  for (int s = 0; s < steps; ++s) advance_over((done + s) / (fps * steps), h, 0, model_.solver.halvings, report);
}

// Whether one long step may replace the next `steps` steps of length h [s]. Conditions: the method is implicit Euler;
// contacts are springs; all cloth is slow and has settled in its last step; no earlier rejection limits the length;
// everything that keys move or set is the same at t and at the end of each step. These conditions are tested before the
// attempt, because the contacts of a long step that fails would affect later steps.
bool StepLoop::may_merge_steps(double t, double h, int steps) {
  const double whole = steps * h;
  // With velocity constraints, contacts release and stick again from step to step.
  const bool needs_steps = model_.contact.response == model::Response::velocity_constraints;
  if (model_.time.integrator != integrator::Method::implicit_euler || needs_steps || whole > progress_.longest ||
      !is_slow(progress_.now) || !has_settled())
    return false;
  for (int s = 1; s <= steps; ++s) {
    const double end = t + s * h;
    if (!weather_.is_constant_between(t, end) || !cloth_.is_constant_between(t, end) ||
        !attachments_.are_constant_between(t, end))
      return false;
    if (!pins_.are_constant_between(t, end) || !frames_are_constant(model_, t, end) ||
        (collisions_ && !collisions_->bodies_are_constant(t, end, progress_.now, next_)))
      return false;
  }
  return true;
}

// Whether the root mean square of all accelerations in the last step is below the visibility threshold.
bool StepLoop::has_settled() const {
  const integrator::Stepper::History& last = stepper_.history();
  if (last.h == 0) return false;
  double sum = 0;
  for (std::size_t i = 0; i < last.before.v.size(); ++i) sum += (progress_.now.v[i] - last.before.v[i]).squaredNorm();
  const double most = numerics.newton.min_visible_acceleration * last.h;
  return sum <= most * most * static_cast<double>(last.before.v.size());
}

bool StepLoop::is_slow(const SystemState& state) {
  return std::ranges::all_of(state.v, [](const Vec3& v) {
    return v.squaredNorm() <= numerics.steps.rest_velocity * numerics.steps.rest_velocity;
  });
}

// Takes one step in place of several. If the step is rejected or something begins to move in it, discards the step,
// counts it neither as a step nor as a rejected step, and returns false.
bool StepLoop::attempt_merged_step(double t, double h, FrameReport& report) {
  if (attempt(t, h, 0, false, report)) return false;
  if (!is_slow(next_) || local_error_ > 0.5 * h * h * numerics.newton.min_visible_acceleration) return false;
  accept(h, report);
  return true;
}

// Advances from t to t + h. If the step is rejected or too long after the last step, or if an obstacle turns too far in
// it, divides the step into two halves. `rejections`: number of rejected steps that contain this
// one. It also counts steps that are divided without an attempt because an earlier rejection still
// limits the length: cloth may become pinched only after some rejections, and otherwise pinched
// cloth would take hundreds of times as many steps.
void StepLoop::advance_over(double t, double h, int rejections, int halvings_left, FrameReport& report) {
  const bool after_rejection = h > (1 + 1e-9) * progress_.longest;
  const bool too_long = after_rejection || h > (1 + 1e-9) * stepper_.longest_step() || obstacle_turns_too_far(t, h);
  if (!too_long) {
    const Rejection rejection = attempt(t, h, rejections, halvings_left == 0, report);
    if (!rejection) return accept(h, report);
    ++report.rejected_steps;
    if (halvings_left == 0) fail(report.frame, t, h, *rejection);
    --halvings_left;
  }
  if (!too_long || after_rejection) ++rejections;
  advance_over(t, 0.5 * h, rejections, halvings_left, report);
  advance_over(t + 0.5 * h, 0.5 * h, rejections, halvings_left, report);
}

// Takes steps whose local error is at most time.tolerance; the last attempt at a step and steps of the minimum length
// are accepted with a larger error. Divides the remainder of the frame into equal steps that are at most as long as
// `control` proposes, so that no step is much shorter than the one before, and lengths change rarely.
void StepLoop::advance_controlled(double t_t0, double t_t1, FrameReport& report) {
  integrator::StepControl& control = *progress_.control;
  double t = t_t0, h = 0;
  int steps_left = 0, rejections = 0;
  for (;;) {
    const double longest = std::min(control.next_step_size(), stepper_.longest_step());
    const int steps_needed = std::max(1, static_cast<int>(std::ceil((t_t1 - t) / longest - 1e-9)));
    if (steps_needed != steps_left) {
      steps_left = steps_needed;
      h = (t_t1 - t) / steps_left;
    }
    for (; obstacle_turns_too_far(t, h); h *= 0.5) steps_left *= 2;
    const bool is_last = rejections == model_.solver.halvings || h < numerics.steps.min_step;
    const Rejection rejection = attempt(t, h, rejections, is_last, report);
    if (rejection && is_last) fail(report.frame, t, h, *rejection);
    // In an impact, even very short steps may exceed the tolerance, so the last attempt is accepted with any error.
    if (rejection || !(is_last || control.accepts(h, local_error_))) {
      ++report.rejected_steps, ++rejections;
      rejection ? control.record_unsolved_step(h) : control.record_rejected_step(h, local_error_);
      continue;
    }
    report.inexact_steps += !control.meets_tolerance(local_error_);
    control.record_accepted_step(h, local_error_);
    accept(h, report);
    rejections = 0;
    if (--steps_left == 0) return;
    t += h;
  }
}

void StepLoop::fail(int frame, double t, double h, const std::string& reason) const {
  throw Error(
      ExitCode::simulation_failed,
      "frame {}: the step at {:.6g} s failed, even when shortened to {:.3g} s: {}; try a smaller time.{} or softer "
      "material",
      frame, t, h, reason, progress_.control ? "tolerance" : "step");
}

// Makes `next_`, the end of a step over h [s], the current state.
void StepLoop::accept(double h, FrameReport& report) {
  measure_work(report);
  stepper_.accept(progress_.now, next_, h);
  before_release_.reset();
  pins_.accept();
  for (const std::string& text : attachments_.accept(next_.particles()))
    report.warnings.push_back(fmt::format("frame {}: {}", report.frame, text));
  cloth_.finish_step(step_end_ - start_);
  for (const ClothSystem::Widening& wide : cloth_.accept(next_.particles(), h)) {
    if (wide.fraction < kMinReportedWidening) continue;
    report.warnings.push_back(
        fmt::format("frame {}: '{}' is too narrow for what it surrounds: near ({:.4g}, {:.4g}, {:.4g}) m it is sewn up "
                    "to {:.0f} % wider than its pattern; a larger `scale` or `fit` prevents this",
                    report.frame, model_.cloths[wide.cloth].name, wide.place.x(), wide.place.y(), wide.place.z(),
                    100 * wide.fraction));
  }
  if (collisions_) collisions_->accept();
  std::swap(progress_.now, next_);
  progress_.longest *= numerics.steps.largest_factor;
  measure_stretch(report);
  ++report.steps;
  report.error_estimate += local_error_;
  report.solver_error += solver_error_;
}

// Adds the work in the step from `progress_.now` to `next_`: of pins and keys, with the change of the kinetic energy of
// the particles that they hold; and of the residual on other particles, 0 after an exact solve without velocity
// constraints. Uses the forces of the stage (integrator::StagePoint), so the error of the work has the order of the
// method.
void StepLoop::measure_work(FrameReport& report) const {
  const SystemState& now = progress_.now;
  const std::span<const double> masses = cloth_.masses();
  // Work of the residual of the equation of motion on particle i. On a held particle, the residual is the force of the
  // constraint; on a free particle, the solver's error.
  const auto missing_work = [&](std::size_t i) {
    return stepper_.constraint_force(static_cast<Index>(i), masses[i]).dot(next_.x[i] - now.x[i]);
  };
  double of_solver = parallel_sum(masses.size(), kGrainSize, [&](std::size_t first, std::size_t last) {
    double sum = 0;
    for (std::size_t i = first; i < last; ++i) sum += missing_work(i);
    return sum;
  });
  double of_pins = 0;
  for (const integrator::HeldParticle& particle : std::span(held_).first(pinned_)) {
    const auto i = static_cast<std::size_t>(particle.constraint.particle);
    of_solver -= missing_work(i);
    // A held particle has the velocity of its pin, not the one that the method computes. Therefore the change of its
    // kinetic energy is computed from its velocities, and constraint_force() gets a mass of 0.
    of_pins += stepper_.constraint_force(particle.constraint.particle, 0).dot(next_.x[i] - now.x[i]) +
               0.5 * masses[i] * (next_.v[i].squaredNorm() - now.v[i].squaredNorm());
  }
  report.pin_work += of_pins;
  report.solver_work += of_solver;
}

// Measures the stretch at the end of the accepted step; the start of the step is in `next_`. Warns of each cloth whose
// ratio of stretch to limit rises above kMaxStretchRatio in this step. If the same cloth was reported before, warns
// only at kReportAgainRatio times the last reported ratio: otherwise a tight waist on a moving character would be
// reported many times.
void StepLoop::measure_stretch(FrameReport& report) {
  report.max_strain = std::max(report.max_strain, cloth_.max_strain(progress_.now.particles()));
  const std::vector<ClothSystem::Overstretch> at_end = cloth_.overstretch(progress_.now.particles());
  std::vector<ClothSystem::Overstretch> at_start;  // computed only if needed
  for (std::size_t k = 0; k < at_end.size(); ++k) {
    const ClothSystem::Overstretch& most = at_end[k];
    report.stretch_ratio = std::max(report.stretch_ratio, most.ratio);
    double& reported = reported_overstretch_[most.cloth];
    if (most.ratio <= kMaxStretchRatio || most.ratio < kReportAgainRatio * reported) continue;
    if (at_start.empty()) at_start = cloth_.overstretch(next_.particles());
    if (at_start[k].ratio > kMaxStretchRatio) continue;
    reported = most.ratio;
    report.warnings.push_back(
        fmt::format("frame {}: '{}' is stretched by {:.0f} %, which its threads do not allow (max_stretch {:g}), near "
                    "({:.4g}, {:.4g}, {:.4g}) m",
                    report.frame, model_.cloths[most.cloth].name, 100 * most.extension, most.extension / most.ratio,
                    most.place.x(), most.place.y(), most.place.z()));
  }
}

template <class Archive>
void StepLoop::serialize(Archive& archive) {
  SystemState& now = progress_.now;
  const std::size_t particles = cloth_.masses().size();
  std::vector<Vec3> x(now.particles().begin(), now.particles().end());
  serialize_points(archive, x, particles);
  std::ranges::copy(x, now.x.begin());
  serialize_points(archive, now.v, particles);
  stepper_.serialize(archive, particles);
  if (progress_.control) progress_.control->serialize(archive);
  weather_.serialize(archive);
  archive.value(progress_.longest);
  if constexpr (Archive::kReads) require(progress_.longest > 0, "a step length");
  serialize_parts(archive);
}

// Saves or restores what changes only at events: seams and attachments that break, pins that yield, reported warnings.
template <class Archive>
void StepLoop::serialize_parts(Archive& archive) {
  cloth_.serialize(archive);
  pins_.serialize(archive);
  attachments_.serialize(archive);
  for (double& reported : reported_overstretch_) {
    archive.value(reported);
    if constexpr (Archive::kReads) require(reported >= 0, "a ratio of stretch");
  }
}

StepLoop::Checkpoint StepLoop::checkpoint() {
  ByteWriter parts;
  serialize_parts(parts);
  if (collisions_) collisions_->serialize_events(parts);
  return {progress_, stepper_.history(), stepper_.method(), std::move(parts.bytes)};
}

void StepLoop::return_to(Checkpoint checkpoint) {
  before_release_.reset();
  progress_ = std::move(checkpoint.progress);
  // What was aborted within a step has placed bodies in `next_` by motions that Simulation::drive() may replace.
  next_ = progress_.now;
  stepper_.return_to(std::move(checkpoint.history));
  stepper_.set_method(checkpoint.method);
  ByteReader parts{checkpoint.parts};
  serialize_parts(parts);
  if (collisions_) collisions_->serialize_events(parts);
}

template void StepLoop::serialize(ByteWriter&);
template void StepLoop::serialize(ByteReader&);

}  // namespace weft::simulation
