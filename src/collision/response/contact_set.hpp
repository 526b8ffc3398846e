// Contacts of one step as stiff, short-range springs with Coulomb friction inside the implicit solve.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/numerics.hpp"
#include "core/past.hpp"
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
  double depth = 0;            ///< where its law is first taken as a tangent, below zero out of range [m]
  double range = 0;            ///< r: the spring acts below this distance [m]
  double full_range = 0;       ///< of the two surfaces [m]; as `range` but for pairs that were closer
  double stiffness = 0;        ///< k [N/m]
  double friction = 0;         ///< Coulomb coefficient of the pair while it slides
  double static_friction = 0;  ///< until it slides; no less
};

/// What is remembered of the friction of a contact.
struct FrictionLag {
  Vec3 drag = Vec3::Zero();  ///< w, friction over load against the slip: an unknown of its own
  Vec3 slip = Vec3::Zero();  ///< at the last update, in stick slips
  bool sticks = false;       ///< linearised where friction is w, and not where the slip is
  int let_go = 0;            ///< times that it began to slide, since the step began
};

/// What is remembered of the contacts of a step, one of each, from one iteration of Newton's method to the next.
struct ContactLag {
  std::vector<double> depths;          ///< where the law of the contact is taken as its tangent [m]
  std::vector<double> loads;           ///< that friction goes by [N]; they lag behind the positions
  std::vector<FrictionLag> frictions;  ///< begin as what slides at unchanged velocity, where the step begins its search
  int updates = 0;                     ///< since the step began
};

/// I − sym(w ûᵀ) in the directions `across` the normal, w being kept to a length of 1 so that this is definite: of
/// friction −λ w' of a slip u = ψ(‖u‖) w', against λ/ψ, with w = ψ' w'. See ContactSet::linearise.
Mat3 friction_tangent(const Mat3& across, const Vec3& slip, Vec3 w);

/// Force of a contact: k d (1 + s (d / r)⁴), s = Numerics::Contact::stiffening, for a depth d = r − g of the gap g =
/// n·(a − b) < r, from d = r on with the slope that it has there; n is kept from the start of the step: convex, with a
/// Jacobian of rank one. A linear spring of cotton gives 0.1 N before the gap is closed, and a sheet that lies on the
/// tip of a cone weighs 1 N. Friction opposes the slip u of the step in the tangent plane with μ k (r − g), reached
/// smoothly from zero within a slip of `stick_speed` · h (Li et al., "Incremental Potential Contact", 2020, section 5).
class ContactSet {
 public:
  void clear() { contacts_.clear(); }
  void add(const Contact& contact);
  /// Before the first solve of a step over h [s], with this stick velocity [m/s].
  void set_step(double h, double stick_speed = numerics.contact.stick_velocity) { stick_slip_ = stick_speed * h; }
  std::span<const Contact> contacts() const { return contacts_; }

  /// Before each linearisation, with the particles where the last one has led to. A contact is unknown by its force λ
  /// as well as by its depth, f⁻¹(λ) = d (a primal–dual method; λ begins with `depth`): its
  /// law stands in the linear system as the tangent at f⁻¹(λ), and λ follows that tangent, but never below zero. As
  /// the tangent at the depth of the iterate, a law ~ d⁵ that is entered too deep gives up a fifth of the depth in an
  /// iteration: sphere_drape took 576 iterations in place of 462, and 256² particles did not get through an impact.
  /// Friction goes by λ from here on. Within one iteration it does not change, so that friction too has a potential.
  ///
  /// Friction on an obstacle that sticks follows its tangent likewise, and slides from where that leads beyond static
  /// friction; what slides sticks once its slip is within the stick slip, or has turned back. Cloth on cloth, where
  /// both sides give way, does not gain by that.
  void update(std::span<const Vec3> x_end, ContactLag& lag) const;

  /// force += contact forces [N] with the particles at x_end. Friction goes by the loads there, as long as they are
  /// followed: what lags must show in the residual (a sheet that landed on an incline lost the friction of the
  /// landing).
  void add_forces(std::span<const Vec3> x_end, const ContactLag& lag, std::span<Vec3> force) const;
  /// Likewise with the tangents in place of the laws.
  void add_linear_forces(std::span<const Vec3> x_end, const ContactLag& lag, std::span<Vec3> force) const;

  /// What add_forces adds, friction apart from what pushes, and the most that friction can be by the loads that it goes
  /// by [N].
  void add_parts_of_forces(std::span<const Vec3> x_end, const ContactLag& lag, std::span<Vec3> push,
                           std::span<Vec3> friction, std::span<double> limit) const;

  /// What impacts change of velocities in a step that ends at x_end, as a linear system whose unknown are these jumps:
  /// adds terms, and to its right hand side [N/h]. False where there is none. An impact is a contact that closes by its
  /// range in the step, or, in proportion, by less. It closes as slowly as the slowest of three estimates says: by the
  /// velocity at the start of the step, by that velocity and the last acceleration (which leads along curved
  /// obstacles), and by the last displacement (which is zero at rest). Its normal force acts; friction holds its points
  /// to the jump that they had. As a force friction is known too badly: a slip of 1e-7 m is enough for all of it.
  bool add_impacts(std::span<const Vec3> x_end, const ContactLag& lag, const StepStart& start,
                   std::span<Vec3> right_side, solver::LinearSystem& system) const;

  /// As add_linear_forces, and adds −∂f/∂x to the system, where x_end changes by `end_rate` per change of the unknown;
  /// for friction a form in its place that is definite. Friction −λ w of a slip u = ψ(‖u‖) w is linearised with w as
  /// an unknown of its own (Chan, Golub & Mulet, "A Nonlinear Primal-Dual Method for Total Variation-Based Image
  /// Restoration", 1999). Where it sticks, it is the tangent at the slip that has this w. Where it slides w is that of
  /// unchanged velocity, or the one with which it began to slide: the tangent where cloth slides on, force over slip or
  /// more where it begins to slide or turns. As force over slip alone cloth that slides down an incline took 2.3
  /// iterations a step in place of 1.05.
  void linearise(std::span<const Vec3> x_end, double end_rate, const ContactLag& lag, std::span<Vec3> force,
                 solver::LinearSystem& system) const;

  /// Number of contacts that push with the particles at x_end.
  int active(std::span<const Vec3> x_end) const;

 private:
  struct Response {
    bool active = false;
    Vec3 force;             // on point a
    double slope = 0;       // of the load [N/m]
    double stickiness = 0;  // load that friction goes by, per stick slip [N/m]; 0: no friction
    Vec3 slip;              // where friction is linearised, in stick slips
  };
  enum class Law { itself, tangent };
  Response respond(std::size_t index, Law law, std::span<const Vec3> x_end, const ContactLag& lag) const;
  void add_forces(Law law, std::span<const Vec3> x_end, const ContactLag& lag, std::span<Vec3> force) const;

  std::vector<Contact> contacts_;
  double stick_slip_ = 1e-6;  // ε of the friction [m]
};

}  // namespace weft::collision
