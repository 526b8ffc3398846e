// Advances a simulation from frame to frame: divides frames into steps, and attempts each step until it is accepted.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "physics/integrator/step_control.hpp"
#include "physics/integrator/stepper.hpp"
#include "physics/model/model.hpp"
#include "physics/model/weather.hpp"
#include "physics/simulation/cloth_system.hpp"
#include "physics/simulation/collision_stage.hpp"
#include "physics/simulation/simulation.hpp"
#include "physics/simulation/step_problem.hpp"
#include "physics/simulation/yielding_pins.hpp"

namespace weft::simulation {

/// Builds only the members that the model needs: no collision stage if nothing collides, and no force whose stiffness
/// is zero.
class StepLoop {
 public:
  /// `start`: time of the first step [s]. The model must outlive the loop.
  StepLoop(const model::Model& model, double start);

  StepLoop(const StepLoop&) = delete;  // members refer to each other
  StepLoop& operator=(const StepLoop&) = delete;

  /// Before the first advance(): takes over the state of the cloths of `before`, a loop that this one replaces.
  /// Cloth k of `before` has the number `cloths[k]` in this loop.
  void copy_state_from(const StepLoop& before, std::span<const std::size_t> cloths);
  /// Before the first advance(): untangles cloths that touch or intersect at the start, if the model allows it.
  /// Cloths that were taken over stay as they are.
  void untangle();
  /// Before the first advance(): lifts dynamic bodies off what they touch. Returns the largest lift [m].
  double lift_bodies();
  /// Before the first advance(): finds the places where surfaces touch or intersect at the start.
  std::vector<IntersectionPlace> find_intersections() {
    return collisions_ ? collisions_->find_intersections(progress_.now) : std::vector<IntersectionPlace>{};
  }

  /// Advances from the time t_t0 of a frame to the time t_t1 of the next one [s], which has the number report.frame.
  /// Adds counts to `report`. Throws Error(simulation_failed) if a step is rejected even at its shortest allowed
  /// length.
  void advance(double t_t0, double t_t1, FrameReport& report);

  /// State from which the next step begins.
  struct Progress {
    SystemState now;
    std::optional<integrator::StepControl> control;  // if the model has a tolerance in place of a step
    // Maximum length of a step [s]; infinite at first. If a step with contacts is not solved, or if
    // pushing apart adds too much energy to it, the value becomes half of the length of this step.
    // Each accepted step multiplies the value by Numerics::Steps::largest_factor.
    double longest;
  };
  const Progress& progress() const { return progress_; }
  /// State between two frames, to which a simulation returns after a failure.
  struct Checkpoint {
    Progress progress;
    integrator::Stepper::History history;
    integrator::Method method;  // of the last step
    std::string parts;          // serialize_parts(), then CollisionStage::serialize_events()
  };
  Checkpoint checkpoint();
  void return_to(Checkpoint checkpoint);

  const ClothSystem& cloth() const { return cloth_; }
  const model::Weather& weather() const { return weather_; }
  /// Between two frames, at the time t [s]: takes gravity, wind and their keys from the model again. Gusts do not jump.
  void reload_weather(double t) {
    const Vec3 displacement = weather_.gust_displacement(t);
    weather_ = model::Weather(model_);
    weather_.set_gust_displacement(t, displacement);
    pins_.update_gravity();
  }
  const Attachments& attachments() const { return attachments_; }
  const StepProblem& problem() const { return problem_; }
  /// Number of particles that pins, keys or velocity constraints hold.
  std::size_t held() const { return held_.size(); }
  /// Contact forces, including friction, on all particles at the end of the last step [N]; zero before the first step.
  std::vector<Vec3> contact_forces() const;
  /// Vertex positions of a dynamic body (moved by forces) [m]; empty for other bodies.
  std::vector<Vec3> vertices_of(std::size_t body) const;
  /// nullptr if nothing collides.
  const CollisionStage* collisions() const { return collisions_ ? &*collisions_ : nullptr; }
  /// Pinched cloth in the frame that has just ended.
  CollisionStage::Pinches take_pinches() {
    return collisions_ ? collisions_->take_pinches(next_) : CollisionStage::Pinches{};
  }
  /// Lagging pins (YieldingPins) in the frame that has just ended.
  YieldingPins::LagReport take_lag_report() { return pins_.take_lag_report(); }

  /// These functions save or restore the state that later frames depend on. Call serialize() first, which handles
  /// everything except contacts, then serialize_contacts() with the time t of the frame [s].
  template <class Archive>
  void serialize(Archive& archive);
  template <class Archive>
  void serialize_contacts(Archive& archive, double t) {
    if (collisions_) collisions_->serialize(archive, t, progress_.now);
  }

 private:
  template <class Archive>
  void serialize_parts(Archive& archive);
  using Start = integrator::Stepper::Start;
  /// Why a step was rejected; empty if it was accepted.
  using Rejection = std::optional<std::string>;
  /// One attempt at a step.
  struct Attempt {
    double t, h;         // start and length [s]
    int rejections;      // number of rejected, longer steps that contain this one
    bool is_last;        // the run fails if this attempt is rejected
    bool may_move_pins;  // as in CollisionStage::push_apart()
  };

  // Division of frames into steps: step_loop.cpp.
  void advance_equally(double t_t0, FrameReport& report);
  void advance_over(double t, double h, int rejections, int halvings_left, FrameReport& report);
  void advance_controlled(double t_t0, double t_t1, FrameReport& report);
  bool may_merge_steps(double t, double h, int steps);
  bool has_settled() const;
  static bool is_slow(const SystemState& state);
  bool attempt_merged_step(double t, double h, FrameReport& report);
  bool obstacle_turns_too_far(double t, double h) const {
    return collisions_ && collisions_->obstacle_turns_too_far(t, h, progress_.now);
  }
  void accept(double h, FrameReport& report);
  void measure_work(FrameReport& report) const;
  void measure_stretch(FrameReport& report);
  [[noreturn]] void fail(int frame, double t, double h, const std::string& reason) const;

  // One attempt at a step, which writes `next_`: step_attempt.cpp.
  Rejection attempt(double t, double h, int rejections, bool is_last, FrameReport& report);
  Start begin_attempt(const Attempt& attempt, FrameReport& report);
  void begin_solve(const Attempt& attempt);
  void update_weather(double t, double until_stage);
  Rejection solve_with_springs(const Attempt& attempt, Start start, FrameReport& report);
  Rejection solve_with_velocity_constraints(const Attempt& attempt, Start start, FrameReport& report);
  Rejection solve_contacts(const Attempt& attempt, Start start, bool is_first, bool check_early, bool& solved,
                           FrameReport& report);
  integrator::StepReport solve(const Attempt& attempt, Start start, bool check_early, FrameReport& report);
  integrator::Method method() const;
  Rejection push_apart(const Attempt& attempt);
  bool may_release_pins(const Attempt& attempt) const;
  bool may_pinch(const Attempt& attempt) const;
  double energy(const SystemState& state) const;
  double added_energy_ratio(double before, double h) const;
  static Rejection rejection_of(const integrator::StepReport& step);

  const model::Model& model_;
  double start_;                     // time at which the simulation starts [s]
  std::vector<std::size_t> put_on_;  // numbers of the cloths that copy_state_from() took over
  ClothSystem cloth_;
  StepProblem problem_;
  YieldingPins pins_;
  Progress progress_;
  integrator::Stepper stepper_;
  struct BeforeRelease {
    std::vector<Vec3> v;  // of all particles [m/s]
    integrator::Stepper::History history;
  };
  std::optional<BeforeRelease> before_release_;  // if the current step releases a pin or body: its start
  SystemState next_;                             // end of the current step; once the step is accepted, its start
  double local_error_ = 0, solver_error_ = 0;    // of the step to `next_`, estimated [m]
  std::vector<double> reported_overstretch_;     // last reported ratio of stretch to limit, per cloth; 0: none
  std::vector<integrator::HeldParticle> held_;
  std::size_t pinned_ = 0;  // pins and keys hold the first pinned_ of held_, velocity constraints the others
  std::optional<CollisionStage> collisions_;
  Attachments attachments_;
  model::Weather weather_;
  Vec3 gravity_;         // in the current step [m/s²]
  double step_end_ = 0;  // time at which the current step ends; before the first step, time of its start [s]
};

}  // namespace weft::simulation
