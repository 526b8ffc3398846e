// Contacts of one step as stiff short-range springs with Coulomb friction, inside the implicit solve.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/numerics.hpp"
#include "core/past.hpp"
#include "core/types.hpp"
#include "physics/solver/linear_system.hpp"

namespace weft::collision {

/// Two points, one on each surface, that a spring pushes apart if they are closer than `range` along `normal`. A
/// contact stays constant between two searches.
struct Contact {
  std::array<Index, 4> particles{0, 0, 0, 0};
  std::array<double, 4> weights{0, 0, 0, 0};  ///< of the particles; zero for vertices of obstacles
  Vec3 obstacle_end = Vec3::Zero();           ///< contribution of the obstacle's vertices to a − b at the end [m]
  Vec3 obstacle_start = Vec3::Zero();         ///< the same at the start [m]
  bool against_obstacle = false;              ///< one side belongs to an obstacle
  Vec3 relative_start = Vec3::Zero();         ///< point a minus point b at the start of the step [m]
  Vec3 normal = Vec3::UnitZ();                ///< unit, from b to a where the pair was found
  double depth = 0;            ///< initial depth, at which the law is first linearised; negative: out of range [m]
  double range = 0;            ///< activation distance: the spring acts below it [m]
  double full_range = 0;       ///< r ≥ `range`, activation distance of the surfaces [m]; infinite: a linear spring
  double stiffness = 0;        ///< k [N/m]
  double friction = 0;         ///< Coulomb coefficient while the pair slides
  double static_friction = 0;  ///< before it slides; not less than `friction`
};

/// State of the friction of a contact between iterations.
struct FrictionLag {
  Vec3 relative_friction = Vec3::Zero();  ///< w: −friction / normal force; an unknown of its own
  Vec3 slip = Vec3::Zero();               ///< at the last update, divided by the stick slip (ContactSet::set_step)
  bool sticks = false;                    ///< true: friction is linearised at w; false: at the slip
  int slide_starts = 0;                   ///< how often it began to slide in this step
};

/// State of the contacts of a step between Newton iterations, with one entry per contact.
struct ContactLag {
  std::vector<double> depths;          ///< depth at which each law is linearised [m]
  std::vector<double> normal_forces;   ///< normal forces that limit friction [N]; they lag behind the positions
  std::vector<FrictionLag> frictions;  ///< initially those of the first iterate; zero for contacts found later
  int updates = 0;                     ///< since the start of the step
};

/// Returns across − sym(w ûᵀ), with û = slip / ‖slip‖ and the projector `across` onto the tangent plane. w is limited
/// to length 1, so that the matrix is positive semidefinite. Use: let the friction be −λ q at the slip u = ψ(‖u‖) q. If
/// w = ψ' q, the symmetric part of −∂(friction)/∂u is λ/ψ times this matrix. See ContactSet::linearise.
Mat3 friction_tangent(const Mat3& across, const Vec3& slip, Vec3 w);

/// The normal force of a contact is f(d) = k d (1 + Numerics::Contact::stiffening (d / r)⁴) at depth d = `range` − n·(a
/// − b) > 0. Beyond d = r = `full_range` it continues linearly. n = `normal` is constant, so f is convex and its
/// Jacobian has rank one. A linear spring is too weak under sharp tips: on cotton it reaches 0.1 N before the gap is
/// closed. A sheet on the tip of a cone weighs 1 N. Friction opposes the slip u of the step in the tangent plane. Its
/// maximum is the friction coefficient times the normal force, to which it grows smoothly until the slip is the stick
/// slip ε = `stick_speed` · h (Li et al., "Incremental Potential Contact", 2020, section 5).
class ContactSet {
 public:
  void clear() { contacts_.clear(); }
  void add(const Contact& contact);
  /// Sets the stick slip. Call before the first solve of a step over h [s]. Below `stick_speed` [m/s] friction is
  /// reduced.
  void set_step(double h, double stick_speed = numerics.contact.stick_velocity) { stick_slip_ = stick_speed * h; }
  std::span<const Contact> contacts() const { return contacts_; }

  /// Call before each linearisation, with the particles at the last iterate. The normal force λ is an unknown of its
  /// own besides the depth d, with f⁻¹(λ) = d at the solution (a primal–dual method; λ starts as f(`depth`)). The
  /// linear system contains the tangent of the law at f⁻¹(λ), and λ follows that tangent, but never below zero.
  /// (Measured with the tangent at the depth of the iterate instead: 1.25 times the iterations in sphere_drape.) Within
  /// an iteration, and after Numerics::Newton::slow_after updates, friction uses a constant λ, so that it has a
  /// potential, too.
  ///
  /// Up to that number of updates, sticking friction on an obstacle also follows its tangent. The contact starts to
  /// slide if the tangent exceeds static friction. It sticks again if the slip is within the stick slip, or if the slip
  /// has reversed (at most Numerics::Contact::max_resticks times). Between cloths, where this brings no gain, friction
  /// does not follow its tangent.
  void update(std::span<const Vec3> x_end, ContactLag& lag) const;

  /// force += contact forces [N] with the particles at x_end. Friction uses the normal forces at x_end during the first
  /// Numerics::Newton::slow_after updates, so that the residual contains the error of the lagged normal forces
  /// (measured: otherwise a sheet that lands on an incline loses the friction of the impact).
  void add_forces(std::span<const Vec3> x_end, const ContactLag& lag, std::span<Vec3> force) const;
  /// As add_forces, with the tangents instead of the laws.
  void add_linear_forces(std::span<const Vec3> x_end, const ContactLag& lag, std::span<Vec3> force) const;

  /// As add_forces, but separates normal forces (`push`) and friction, and adds the maximum friction to `limit` [N].
  void add_normal_and_friction_forces(std::span<const Vec3> x_end, const ContactLag& lag, std::span<Vec3> push,
                                      std::span<Vec3> friction, std::span<double> limit) const;

  /// Adds the velocity jumps due to impacts, in a step that ends at x_end, as a linear system whose unknowns are the
  /// jumps: adds terms to `system` and `right_side` [N/s]. Returns false if there is no impact. A contact that closes
  /// at Numerics::Contact::impact_velocity or faster is a full impact; one that closes more slowly counts
  /// proportionally. The closing velocity is the smallest of three estimates: from the velocity at the start of the
  /// step; from this velocity and the last acceleration (for motion along curved obstacles); from the last displacement
  /// (zero at rest). The normal force of an impact enters `right_side`. Friction enters `system` as a term that keeps
  /// the tangential jump of the points as it was in the step, because a slip of 1e-7 m would change the friction force
  /// completely. Contacts without an impact transmit the jumps by their stiffness (measured without: a ball that falls
  /// on cloth on a floor throws the cloth up by 9 to 105 mm instead of 1.5 mm).
  bool add_impacts(std::span<const Vec3> x_end, const ContactLag& lag, const StepStart& start,
                   std::span<Vec3> right_side, solver::LinearSystem& system) const;

  /// As add_linear_forces; also adds −∂f/∂x to the system. `end_rate`: change of x_end per change of the unknown. The
  /// matrix of friction is approximated so that it is positive semidefinite. Friction −λ w of a slip u = ψ(‖u‖) w is
  /// linearised with w as an unknown of its own (Chan, Golub & Mulet, "A Nonlinear Primal-Dual Method for Total
  /// Variation-Based Image Restoration", 1999). If the contact sticks, the result is the tangent at the slip that
  /// belongs to w. If the contact slides, w is that of unchanged velocity, or the one with which sliding began. The
  /// result is then the exact tangent while cloth keeps sliding. Where cloth starts to slide or changes direction, the
  /// result is the secant, force over slip, or stiffer (measured on an incline: 1.05 iterations per step; with secants
  /// 2.3).
  void linearise(std::span<const Vec3> x_end, double end_rate, const ContactLag& lag, std::span<Vec3> force,
                 solver::LinearSystem& system) const;

  /// Number of contacts that push with the particles at x_end.
  int active(std::span<const Vec3> x_end) const;

 private:
  struct Response {
    bool active = false;
    Vec3 force;                    // on point a
    double slope = 0;              // of the normal force [N/m]
    double friction_per_slip = 0;  // normal force used for friction, divided by the stick slip [N/m]; 0: no friction
    Vec3 slip;                     // where friction is linearised, divided by the stick slip
  };
  enum class Law { exact, tangent };
  Response respond(std::size_t index, Law law, std::span<const Vec3> x_end, const ContactLag& lag) const;
  void add_forces(Law law, std::span<const Vec3> x_end, const ContactLag& lag, std::span<Vec3> force) const;

  std::vector<Contact> contacts_;
  double stick_slip_ = 1e-6;  // ε: slip at which friction is fully developed [m]
};

}  // namespace weft::collision
