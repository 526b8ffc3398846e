// From one frame to the next in steps: how long they are, what is done again, and what one step consists of.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "environment/environment.hpp"
#include "environment/weather.hpp"
#include "integrator/step_control.hpp"
#include "integrator/stepper.hpp"
#include "scene/scene.hpp"
#include "simulation/cloth_system.hpp"
#include "simulation/collision_stage.hpp"
#include "simulation/simulation.hpp"
#include "simulation/step_problem.hpp"
#include "simulation/step_work.hpp"
#include "simulation/yielding_pins.hpp"

namespace weft::simulation {

/// Parts that a scene does not need are not there: no collision stage where nothing collides, no forces of zero
/// stiffness.
class StepLoop {
 public:
  /// From time `start` on [s], at first that of the simulation. Scene and environment must outlive it.
  StepLoop(const scene::Scene& scene, const environment::Environment& environment, double start);

  StepLoop(const StepLoop&) = delete;  // its parts know each other
  StepLoop& operator=(const StepLoop&) = delete;

  /// Before the first advance(): cloths of this number are where and as fast as those of a loop that ends here, in its
  /// order.
  void take_over(const StepLoop& before, std::span<const std::size_t> cloths);
  /// Takes apart what touches or crosses at the start and may be moved for it, cloths that were taken over aside;
  /// before the first advance().
  void untangle();
  /// Lifts bodies that forces move off what they touch; before the first advance(). Returns the largest lift [m].
  double lift_bodies();
  /// Where surfaces touch or cross at the start; before the first advance().
  std::vector<MeetingPlace> find_meetings() {
    return collisions_ ? collisions_->find_meetings(progress_.now) : std::vector<MeetingPlace>{};
  }

  /// Goes on from the time t_t0 of a frame to that of the next one [s], which is report.frame, and counts in the
  /// report. Throws Error(simulation_failed) where no step is short enough.
  void advance(double t_t0, double t_t1, FrameReport& report);

  /// What the next step begins with, besides what follows from it.
  struct Progress {
    Moment now;
    std::optional<integrator::StepControl> control;  // where the scene has a tolerance instead of a step
    double longest;                                  // step after one that was not solved [s]; else infinite
  };
  const Progress& progress() const { return progress_; }
  /// To return to after a failure, between two frames.
  struct Checkpoint {
    Progress progress;
    integrator::Stepper::History history;
  };
  Checkpoint checkpoint() const { return {progress_, stepper_.history()}; }
  void return_to(Checkpoint checkpoint) {
    progress_ = std::move(checkpoint.progress);
    stepper_.return_to(std::move(checkpoint.history));
  }

  const ClothSystem& cloth() const { return cloth_; }
  const environment::Weather& weather() const { return weather_; }
  const Attachments& attachments() const { return attachments_; }
  const StepProblem& problem() const { return problem_; }
  /// Particles that are held, by pins or by the response to contacts.
  std::size_t held() const { return held_.size(); }
  /// Of contacts on all particles at the end of the last step, friction too [N]; zeros before the first one.
  std::vector<Vec3> contact_forces() const;
  /// Where the vertices are of a body of the environment that forces move; nothing of others.
  std::vector<Vec3> vertices_of(std::size_t body) const;
  /// nullptr where nothing collides.
  const CollisionStage* collisions() const { return collisions_ ? &*collisions_ : nullptr; }
  /// What the frame that ends now has pinched.
  CollisionStage::Pinches take_pinches() {
    return collisions_ ? collisions_->take_pinches(next_) : CollisionStage::Pinches{};
  }

  /// And which pins have lagged in it.
  YieldingPins::Lags take_lags() { return pins_.take_lags(); }

  /// Two parts of what later frames depend on; of contacts at the time of a frame [s].
  template <class Archive>
  void serialize(Archive& archive);
  template <class Archive>
  void serialize_contacts(Archive& archive, double t) {
    if (collisions_) collisions_->serialize(archive, t, progress_.now);
  }

 private:
  // Why a step was rejected; empty where it was not.
  using Rejection = std::optional<std::string>;

  void advance_equally(double t_t0, FrameReport& report);
  bool may_rest(double t, double h, int steps);
  bool has_settled() const;
  static bool is_slow(const Moment& moment);
  bool rest(double t, double h, FrameReport& report);
  void advance_over(double t, double h, int retries, int halvings, FrameReport& report);
  void advance_controlled(double t_t0, double t_t1, FrameReport& report);
  bool turns_too_far(double t, double h) const {
    return collisions_ && collisions_->turns_too_far(t, h, progress_.now);
  }
  Rejection attempt(double t, double h, int retries, bool last_try, FrameReport& report);
  Rejection attempt_with(double t, double h, int retries, bool last_try, bool may_give_way, FrameReport& report);
  bool is_short_enough(int retries, bool last_try) const;
  void update_weather(double t, double h);
  Rejection correct(double h, int retries, bool last_try, bool may_give_way);
  Rejection torn(double h, bool solved);
  double energy(const Moment& moment) const;
  double added_share(double before, double h) const;
  integrator::Method method() const;
  integrator::StepReport solve(double h, integrator::Stepper::Start start, bool look, FrameReport& report);
  static Rejection reason_of(const integrator::StepReport& step);
  void accept(double h, FrameReport& report);
  static void count_work(const StepWork& work, FrameReport& report) {
    report.pin_work += work.pins;
    report.solver_work += work.solver;
  }
  void measure_stretch(FrameReport& report);
  [[noreturn]] void fail(int frame, double t, double h, const std::string& reason) const;

  const scene::Scene& scene_;
  const environment::Environment& environment_;
  double start_;                      // of the simulation [s]
  std::vector<std::size_t> dressed_;  // cloths that were taken over
  ClothSystem cloth_;
  StepProblem problem_;
  YieldingPins pins_;
  Progress progress_;
  integrator::Stepper stepper_;
  Moment next_;                                // the end of the step at hand; once that is accepted, its start
  double local_error_ = 0, solver_error_ = 0;  // of the step to `next_`, estimated [m]
  std::vector<double> told_shares_;            // of its limit, that each cloth was last told of; 0: it was not
  std::vector<integrator::HeldParticle> held_;
  std::size_t pinned_ = 0;  // of these, by pins and keys; others by the response to contacts
  std::optional<CollisionStage> collisions_;
  Attachments attachments_;
  environment::Weather weather_;
  Vec3 gravity_;  // of the step at hand [m/s²]
};

}  // namespace weft::simulation
