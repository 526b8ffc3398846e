// Contacts of one step as stiff, short-range springs with Coulomb friction inside the implicit solve.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/types.hpp"
#include "solver/linear_system.hpp"

namespace weft::collision {

/// A pair of points, one on each of two surfaces, that must not come closer than `range` along `normal`. It stays as it
/// was built for all of its step.
struct Contact {
  std::array<Index, 4> particles{0, 0, 0, 0};
  std::array<double, 4> weights{0, 0, 0, 0};  ///< of the particles; zero for vertices of obstacles
  Vec3 obstacle_end = Vec3::Zero();           ///< what the obstacle's vertices add at the end of the step [m]
  Vec3 obstacle_start = Vec3::Zero();         ///< and at its start
  bool against_obstacle = false;              ///< one side is of an obstacle
  Vec3 relative_start = Vec3::Zero();         ///< point a minus point b at the start of the step [m]
  Vec3 normal = Vec3::UnitZ();                ///< unit, from b to a at the start of the step
  double range = 0;                           ///< r: the spring acts below this distance [m]
  double full_range = 0;                      ///< of the two surfaces [m]; as `range` but for pairs that were closer
  double stiffness = 0;                       ///< k [N/m]
  double friction = 0;                        ///< Coulomb coefficient of the pair while it slides
  double static_friction = 0;                 ///< until it slides; no less
};

/// What friction remembers within a step: the loads that it goes by, which lag behind the positions.
struct FrictionLag {
  std::vector<double> loads;  ///< of each contact [N]
  int updates = 0;            ///< since the step began
};

/// Force of a contact: k d (1 + kStiffening (d / r)⁴) for a depth d = r − g of the gap g = n·(a − b) < r, from d = r on
/// with the slope that it has there; n is kept from the start of the step: convex, with a Jacobian of rank one. A
/// linear spring of cotton gives 0.1 N before the gap is closed, and a sheet that lies on the tip of a cone weighs 1 N.
/// Friction opposes the slip u of the step in the tangent plane with μ k (r − g), reached smoothly from zero within a
/// slip of `stick_speed` · h (Li et al., "Incremental Potential Contact", 2020, section 5).
class ContactSet {
 public:
  /// Slip speed below which friction is viscous and a contact counts as sticking [m/s]. Smaller creeps less and makes
  /// the system stiffer: 2 μ λ / (h · stick_speed) per contact of load λ.
  static constexpr double kStickSpeed = 2e-4;
  /// Updates of a step, over all of its solves, in which friction follows the loads. From then on it keeps those it
  /// has: that the load changes with the positions is not in the matrix, and where folds press on each other in steps
  /// below a millisecond the two would go on chasing each other, however short the step.
  static constexpr int kLoadUpdates = 20;

  static constexpr double kStiffening = 10;
  /// Slip speed, in stick speeds, from which friction is that of sliding; between, it falls from the static one.
  static constexpr double kSlideSpeed = 5;

  void clear() { contacts_.clear(); }
  void add(const Contact& contact);
  /// Before the first solve of a step over h [s].
  void set_step(double h) { stick_slip_ = kStickSpeed * h; }
  std::span<const Contact> contacts() const { return contacts_; }

  /// Before each linearisation: friction goes by the loads at this x_end from here on. Within one Newton iteration they
  /// do not change, so that friction too has a potential. The first time, and for contacts that are new, they are the
  /// loads at the start of the step.
  void update(std::span<const Vec3> x_end, FrictionLag& lag) const;

  /// force += contact forces [N] with the particles at x_end.
  void add_forces(std::span<const Vec3> x_end, const FrictionLag& lag, std::span<Vec3> force) const;

  /// As add_forces, and adds −∂f/∂x to the system, where x_end changes by `end_rate` per change of the unknown; for
  /// friction force over slip in its place, which is no less stiff and keeps the matrix definite.
  void linearise(std::span<const Vec3> x_end, double end_rate, const FrictionLag& lag, std::span<Vec3> force,
                 solver::LinearSystem& system) const;

  /// Number of contacts that push with the particles at x_end.
  int active(std::span<const Vec3> x_end) const;

 private:
  struct Response {
    bool active = false;
    Vec3 force;          // on point a
    double slope = 0;    // of the load [N/m]
    double sliding = 0;  // friction force per slip [N/m]
  };
  Response respond(const Contact& contact, std::span<const Vec3> x_end, double friction_load) const;

  std::vector<Contact> contacts_;
  double stick_slip_ = 1e-6;  // ε of the friction [m]
};

}  // namespace weft::collision
