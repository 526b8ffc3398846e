// Pins in one step: they hold particles exactly, or pull particles that an obstacle or cloth keeps from their targets.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "physics/simulation/pins.hpp"
#include "physics/simulation/step_problem.hpp"

namespace weft::simulation {

/// A pin with a `strength` is always a damped spring. Any other pin holds its particles exactly at their targets. If an
/// obstacle or cloth keeps a particle from its target, the particle lags: a bounded force pulls it until it reaches its
/// target and is held again.
class YieldingPins {
 public:
  /// `first_particle`: of each cloth; `masses`: of all particles [kg]. The model and `masses` must outlive this object.
  YieldingPins(const model::Model& model, const std::vector<Index>& first_particle, std::span<const double> masses);

  /// Call between two frames if the gravity of the model has changed: the maximum pulls depend on it.
  void update_gravity();

  /// Begins a step from t to t + h [s] with particles at x [m]: determines which particles are held at t + h, and which
  /// are pulled.
  void begin_step(double t, double h, std::span<const Vec3> x);
  const std::vector<integrator::HeldParticle>& held() const { return held_; }
  const std::vector<PinSpring>& pulls() const { return pulls_; }

  /// Whether the pins hold the same particles at the same places at t0 and t1 [s], and no particle lags.
  bool are_constant_between(double t0, double t1);

  /// Whether the model releases a pin at a time in [t0, t1) [s]. Unrelated to release_particle().
  bool release_between(double t0, double t1) const { return pins_.release_between(t0, t1); }

  /// Makes a held particle lag in the current step; begin_step() must be called again. `obstruction`: text that says
  /// which object is in the particle's way, and where.
  void release_particle(Index particle, const std::string& obstruction);
  /// Accepts the step: particles that lag in it also lag in the next steps, until they reach their targets.
  void accept();

  /// Lagging pins of the steps of a frame. take_lag_report() also begins the next frame.
  struct LagReport {
    int particles = 0;                  ///< largest number of particles that lagged in one step
    std::vector<std::string> messages;  ///< one text per pin that began to lag, also in place of a released pin, or
                                        ///< that is at its target again
  };
  LagReport take_lag_report();

  /// Between two frames: copies which particles of one cloth lag. The cloth has `count` particles, which begin at
  /// `first_there` in `there` and at `first` in this object. Pins that `there` has reported are not reported again.
  void copy_state_from(const YieldingPins& there, Index first_there, Index first, Index count);

  /// Saves or restores which particles lag, and which pins have been reported.
  template <class Archive>
  void serialize(Archive& archive);

 private:
  void pull(const integrator::HeldParticle& target, const integrator::HeldParticle& middle, double h,
            std::span<const Vec3> x);
  // The functions of Pins, at the end of the step.
  std::size_t pin_of(Index particle) const { return pins_.pin_of(particle, step_start_ + step_length_); }
  double strength_fraction(Index particle) const {
    return pins_.strength_fraction(particle, step_start_ + step_length_);
  }

  Pins pins_;
  const model::Model& model_;
  std::vector<Index> first_particle_;  // of each cloth
  std::span<const double> masses_;
  std::vector<double> pull_force_;  // per pin: the force W of Numerics::Pins, a multiple of the weight of the cloth [N]
  bool needs_middle_ = false;       // whether a pin has a strength and the midpoint rule is the integrator
  // Targets at the end of the step, in its middle (empty unless needs_middle_), and at its start. held_: those of
  // targets_ whose particles are held exactly.
  std::vector<integrator::HeldParticle> targets_, middles_, at_start_, held_;
  std::vector<PinSpring> pulls_;
  std::vector<std::uint8_t> lagged_,
      lags_;                                    // per particle: lagged in the previous step, lags in this one
  std::vector<std::uint8_t> released_;          // per particle: whether release_particle() was called for this step
  std::vector<std::size_t> lagging_particles_;  // number of particles that lag in this step, per pin
  std::map<std::size_t, std::string> obstructions_;  // per pin: text of its first obstruction in this step
  double step_start_ = 0, step_length_ = 0;          // start and length of the last step that began [s]
  std::set<std::size_t> lagging_, lagging_before_;   // pins, in this frame and in the previous one
  LagReport lag_report_;
};

}  // namespace weft::simulation
