// Pins as the step sees them: held exactly while nothing is in the way, pulled along while something is.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "simulation/pins.hpp"
#include "simulation/step_problem.hpp"

namespace weft::simulation {

/// A pin with a `strength` is a damped spring for good. Any other holds its particles where they are to be, until one
/// of them cannot get there: then that particle lags behind, drawn by a force that obstacles and cloth withstand, and
/// is held again once it has arrived.
class YieldingPins {
 public:
  /// `first_particle`: number of the first particle of each cloth; `masses`: of all particles [kg]. All must outlive
  /// it.
  YieldingPins(const scene::Scene& scene, const environment::Environment& environment,
               const std::vector<Index>& first_particle, std::span<const double> masses);

  /// For a step from t to t + h [s] that starts at x [m]: which particles are held at its end, and which are pulled.
  void begin_step(double t, double h, std::span<const Vec3> x);
  const std::vector<integrator::HeldParticle>& held() const { return held_; }
  const std::vector<Pull>& pulls() const { return pulls_; }

  /// Whether all pins hold at t1 what they hold at t0 [s], where it is then, and nothing lags.
  bool stay(double t0, double t1);

  bool release_between(double t0, double t1) const { return pins_.release_between(t0, t1); }

  /// Before the step begins anew: this particle, which is held, lags in it. `obstruction`: what is in its way, and
  /// where.
  void let_go(Index particle, const std::string& obstruction);
  /// Whether a particle lags in this step.
  bool any_lags() const { return any_lags_; }
  /// The step is done: what lags in it goes on lagging.
  void accept();

  /// What a frame has seen, from its steps so far; the next call tells of the next frame.
  struct Lags {
    int particles = 0;               ///< most at once that lagged
    std::vector<std::string> turns;  ///< pins that began to lag or are held again: "pin 0 of 'a' gives way to 'b' ..."
  };
  Lags take_lags();

  /// Between two frames: particles from `first` on lag as those of another scene with the same cloth do, from
  /// `first_there` on, and what was said of that is not said again.
  void take_over(const YieldingPins& there, Index first_there, Index first, Index count);

  /// Which particles lag, and what was said of that.
  template <class Archive>
  void serialize(Archive& archive);

 private:
  void pull(const integrator::HeldParticle& target, double h, std::span<const Vec3> x);

  Pins pins_;
  const environment::Environment& environment_;
  std::span<const double> masses_;
  std::vector<double> load_;  // that what lags of a pin is to bear together, by pin [N]
  std::vector<integrator::HeldParticle> targets_, at_start_, held_;
  std::vector<Pull> pulls_;
  std::vector<std::uint8_t> lagged_, lags_;          // per particle: in the step before, and in this one
  std::vector<std::uint8_t> forced_;                 // let go in this step
  std::vector<std::size_t> lagging_particles_;       // in this step, by pin
  std::map<std::size_t, std::string> obstructions_;  // of pins that were
  double begun_t_ = 0, begun_h_ = 0;                 // the step that forced_ is of [s]
  bool any_lags_ = false;
  std::set<std::size_t> lagging_, lagging_before_;  // pins, in this frame and in the one before
  Lags seen_;
};

}  // namespace weft::simulation
