// Air that cloths enclose: its pressure, its force, its energy.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "physics/forces/enclosed_volume.hpp"
#include "physics/model/model.hpp"
#include "physics/motion/spline.hpp"
#include "physics/simulation/frame_report.hpp"
#include "physics/solver/linear_system.hpp"

namespace weft::simulation {

/// Air in an enclosed volume V has the gauge pressure p, its pressure above that outside. It exerts the force p ∂V/∂x.
/// If the model gives p, the energy is −p V. If the model gives an amount of air, as its volume A at the outside
/// pressure p₀, the air is isothermal: (p₀ + p) V = p₀ A. Its energy is then p₀ (V − A − A ln(V / A)).
///
/// The linear system gets −dp/dV ∂V/∂x ∂V/∂xᵀ. It does not get −p ∂²V/∂x², which is indefinite, and
/// small compared with the stiffness of cloth under tension.
class Inflation {
 public:
  /// Pressure outside [Pa]: standard atmosphere.
  static constexpr double kAmbientPressure = 101325;

  Inflation() = default;
  /// Selects the cloths for which Pressure::has_effect() is true. `first_particle`: of each cloth of the
  /// model.
  Inflation(const model::Model& model, std::span<const Index> first_particle);

  bool empty() const { return cloths_.empty(); }

  /// Begins a step with its stage (integrator::Stepper) at the scene time t [s], and particles at x [m]. As long as
  /// is_closed(number of the cloth in the model) is false, the cloth has no gauge pressure. In the
  /// first step in which the cloth is closed, the volume that it encloses at x becomes the
  /// reference for amounts of air. Throws Error(scene_invalid) if the cloth then encloses no volume
  /// although the model gives an amount of air.
  void begin_step(double t, std::span<const Vec3> x, const std::function<bool(std::size_t)>& is_closed);
  /// Sets the given pressures and amounts of air to those of the scene time t [s].
  void set_time(double t);
  /// Call after cloth has been moved at the start: the volume that each closed cloth encloses at x [m] becomes the
  /// reference for amounts of air, except for the cloths with the numbers `kept`. Throws as begin_step() does.
  void measure_closed_volumes(std::span<const Vec3> x, std::span<const std::size_t> kept);
  /// Whether the model gives the same pressures or amounts of air at t0 and t1 [s].
  bool is_constant_between(double t0, double t1) const;

  /// Adds the force of the air on each particle to `force` [N]. `x`: all particles [m].
  void add_forces(std::span<const Vec3> x, std::span<Vec3> force) const;
  /// Like add_forces(), and replaces the rank-one terms of `system`, whose rows are those of all particles.
  void linearise(std::span<const Vec3> x, std::span<Vec3> force, solver::LinearSystem& system) const;

  /// Energy of the air in all cloths [J].
  double energy(std::span<const Vec3> x) const;
  std::vector<EnclosedAir> measure(std::span<const Vec3> x) const;

  /// Copies the enclosed air from another simulation. Cloth k of `there` has the number `numbers[k]` in this model.
  void copy_state_from(const Inflation& there, std::span<const std::size_t> numbers);

  template <class Archive>
  void serialize(Archive& archive);

 private:
  static constexpr double kOpen = -1;
  struct Cloth {
    std::string name;
    std::string where;   // place in the scene, for error messages
    std::size_t number;  // of the cloth in the model
    Index first, end;    // particles
    forces::EnclosedVolume volume;
    model::PressureControl control;
    motion::Spline<1> track;
    double value = 0;                      // of `track`, at the time of set_time(); for the unit, see PressureControl
    double closed_volume = kOpen;          // volume when it was closed [m³]; kOpen: not closed yet
    mutable std::vector<Vec3> gradient{};  // scratch

    void close(std::span<const Vec3> x);
    double air() const;
    double pressure(double at_volume) const;
    double stiffness(double at_volume) const;
    double energy(double at_volume) const;
    double evaluate(std::span<const Vec3> x) const { return volume.evaluate(x.subspan(first, end - first), gradient); }
  };
  std::vector<Cloth> cloths_;
};

}  // namespace weft::simulation
