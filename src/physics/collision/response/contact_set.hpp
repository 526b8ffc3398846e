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

/// Two points, a and b, one on each surface. A spring pushes them apart if they are closer than `range` along `normal`.
/// A contact stays constant until the engine searches contacts again.
struct Contact {
  std::array<Index, 4> particles{0, 0, 0, 0};
  std::array<double, 4> weights{0, 0, 0, 0};  ///< > 0 for point a, < 0 for point b; 0 for vertices of obstacles
  Vec3 obstacle_end = Vec3::Zero();  ///< contribution of the obstacle's vertices to a − b at the end of the step [m]
  Vec3 obstacle_start = Vec3::Zero();  ///< the same at the start of the step [m]
  bool against_obstacle = false;       ///< one side belongs to an obstacle
  Vec3 relative_start = Vec3::Zero();  ///< point a minus point b at the start of the step [m]
  Vec3 normal = Vec3::UnitZ();         ///< unit, from b to a at the positions of the search
  double depth = 0;                    ///< initial depth, for the first linearisation [m]; negative: no force
  double range = 0;                    ///< activation distance: the spring acts below it [m]
  double full_range = 0;       ///< r: activation distance without limits [m], ≥ `range`; infinite: linear spring
  double stiffness = 0;        ///< k [N/m]
  double friction = 0;         ///< Coulomb coefficient while the points slide
  double static_friction = 0;  ///< while they stick; not less than `friction`
};

/// State of the friction of a contact between iterations.
struct FrictionState {
  Vec3 relative_friction = Vec3::Zero();  ///< w = −friction / normal force, an unknown in addition to the positions
  Vec3 slip = Vec3::Zero();               ///< at the last update, divided by the stick slip ε (see ContactSet)
  bool sticks = false;   ///< true: linearise friction at the slip that w corresponds to; false: at that of the iterate
  int slide_starts = 0;  ///< number of changes from sticking to sliding in this step
};

/// State of the contacts of a step between Newton iterations, with one entry per contact.
struct ContactStates {
  std::vector<double> depths;  ///< f⁻¹(λ): depths at which the normal forces f (see ContactSet) are linearised [m]
  std::vector<double> normal_forces;     ///< λ: normal forces that limit friction [N]; constant between updates
  std::vector<FrictionState> frictions;  ///< start value: from the first iterate; zero for contacts found later
  int updates = 0;                       ///< number of calls of ContactSet::update() in this step
};

/// Forces of a contact: exact, or with the tangents of normal force and friction that ContactSet::linearise() uses.
enum class ForceLaw { exact, tangent };

/// Matrix for the tangent of friction. Friction at the slip u is −λ q, with the normal force λ and q = u / ψ(‖u‖).
/// Returns `across` − sym(w ûᵀ), with û = `slip` / ‖`slip`‖ and the projector `across` onto the tangent plane. For w =
/// ψ' q, the symmetric part of −∂(friction)/∂u is λ/ψ times this matrix. If w is longer than 1, it is shortened to 1,
/// so that the matrix is positive semidefinite. See ContactSet::linearise().
Mat3 friction_tangent(const Mat3& across, const Vec3& slip, Vec3 w);

/// The normal force of a contact is f(d) = k d (1 + Numerics::Contact::stiffening (d / r)⁴) at depth d = `range` − n·(a
/// − b) > 0. Beyond d = r = `full_range` it continues linearly. n = `normal` is constant, so f is convex and its
/// Jacobian has rank one. The factor in parentheses makes contacts strong enough for sharp tips: without it, the force
/// on cotton reaches only 0.1 N before the gap is closed, but a sheet that hangs on the tip of a cone presses with its
/// weight of 1 N.
///
/// Friction opposes the slip u, the displacement of a relative to b in the tangent plane since the start of the step.
/// It grows smoothly with u up to its maximum, static friction coefficient times normal force, which it reaches at the
/// slip ε = `stick_speed` · h, called the stick slip [m] (Li et al., "Incremental Potential Contact", 2020, section 5).
/// At larger slips, the coefficient falls linearly to that of sliding, which it reaches at
/// Numerics::Contact::slide_velocity stick slips.
class ContactSet {
 public:
  void clear() { contacts_.clear(); }
  void add(const Contact& contact);
  /// Call before the first solve of a step over h [s]. Sets the stick slip. `stick_speed`: slip velocity below which
  /// friction is less than its maximum [m/s].
  void set_step(double h, double stick_speed = numerics.contact.stick_velocity) { stick_slip_ = stick_speed * h; }
  std::span<const Contact> contacts() const { return contacts_; }

  /// Call before each linearisation, with the particles at the last iterate. The normal force λ is an unknown in
  /// addition to the depth d; the solution satisfies f⁻¹(λ) = d (a primal-dual method). λ starts as f(`depth`). The
  /// linear system contains the tangent of f at the depth f⁻¹(λ). update() moves λ along this tangent, but never below
  /// zero. This takes a fifth fewer iterations in the scene sphere_drape than the tangent at the depth of the iterate.
  /// The λ that limits friction is constant within an iteration, so that friction, too, has a potential. After
  /// Numerics::Newton::slow_after updates, it is constant until the end of the step.
  ///
  /// In the first `slow_after` updates, update() also moves w (FrictionState::relative_friction) of a sticking contact
  /// with an obstacle along the tangent of w. The contact starts to slide if w then exceeds static friction. It sticks
  /// again if the slip is less than the stick slip. It also sticks again if the slip has reversed, unless it has
  /// already started to slide Numerics::Contact::max_resticks times in this step. After `slow_after` updates, no
  /// contact sticks. Contacts without an obstacle have a constant w and never count as sticking, because moving w saves
  /// no iterations for them.
  void update(std::span<const Vec3> x_end, ContactStates& states) const;

  /// Adds contact forces to `force` [N], with the particles at x_end. Before the Numerics::Newton::slow_after-th
  /// update(), exact friction uses the normal forces at x_end, so that the residual contains the error of the constant
  /// normal forces of the linear system. From then on, friction uses these constant normal forces, so that a sheet that
  /// lands on an incline keeps the friction of the impact.
  void add_forces(ForceLaw law, std::span<const Vec3> x_end, const ContactStates& states, std::span<Vec3> force) const;

  /// As the exact add_forces, but adds normal forces to `push` and friction to `friction`. Adds the magnitudes of
  /// normal forces to `normal_force` and the maximum friction to `limit` [N].
  void add_normal_and_friction_forces(std::span<const Vec3> x_end, const ContactStates& states, std::span<Vec3> push,
                                      std::span<Vec3> friction, std::span<double> normal_force,
                                      std::span<double> limit) const;

  /// Adds the contacts to the linear system whose unknowns are the velocity jumps due to impacts in a step that ends at
  /// x_end: to the matrix in `system` and to `right_side` [N/s]. If there is no impact, adds nothing and returns false.
  /// A contact that closes at Numerics::Contact::impact_velocity or faster is a full impact; the terms of a slower one
  /// are scaled by its closing velocity / impact_velocity. The closing velocity includes the motion of the obstacle in
  /// the step. For the particles, it is the smallest of three estimates: from the velocity at the start of the step;
  /// from this velocity and the last acceleration (for motion along curved obstacles); from the last displacement (zero
  /// at rest). In the first step, only the first estimate exists.
  ///
  /// The normal force of an impact enters `right_side`. Friction does not enter as a force, because a slip of 1e-7 m
  /// would change it completely; instead, a stiff term keeps the tangential velocity jump that the step has found.
  /// Contacts without an impact transmit the velocity jumps by their stiffness. With it, a ball that falls on cloth on
  /// a floor throws the cloth up by 1.5 mm; without it, by 9 to 105 mm.
  bool add_impacts(std::span<const Vec3> x_end, const ContactStates& states, const StepStart& start,
                   std::span<Vec3> right_side, solver::LinearSystem& system) const;

  /// As add_forces with the tangent law; also adds −∂f/∂x to the system. `end_rate`: change of x_end per change of the
  /// unknown. The matrix of friction is approximated so that it is positive semidefinite. Friction −λ w at a slip u =
  /// ψ(‖u‖) w is linearised with w as an unknown in addition to u (Chan, Golub & Mulet, "A Nonlinear Primal-Dual Method
  /// for Total Variation-Based Image Restoration", 1999). If the contact sticks, the matrix is the tangent at the slip
  /// that w corresponds to. If it slides, w is that of the first iterate, or the one with which sliding began. While
  /// the contact keeps sliding in one direction, the matrix is then the exact tangent; otherwise it is closer to the
  /// secant (friction over slip), or stiffer. Cloth that slides on an incline takes 1.05 iterations per step (2.3 with
  /// secants only).
  void linearise(std::span<const Vec3> x_end, double end_rate, const ContactStates& states, std::span<Vec3> force,
                 solver::LinearSystem& system) const;

  /// Number of contacts with a positive depth, with the particles at x_end.
  int count_active(std::span<const Vec3> x_end) const;

 private:
  struct Response {
    bool active = false;
    Vec3 force;                    // on point a [N]
    double slope = 0;              // of the normal force [N/m]
    double friction_per_slip = 0;  // normal force that limits friction, divided by the stick slip [N/m]; 0: none
    Vec3 slip;                     // at which friction is linearised, divided by the stick slip
  };
  Response respond(std::size_t index, ForceLaw law, std::span<const Vec3> x_end, const ContactStates& states) const;

  std::vector<Contact> contacts_;
  double stick_slip_ = 1e-6;  // ε: slip at which friction is fully developed [m]
};

}  // namespace weft::collision
