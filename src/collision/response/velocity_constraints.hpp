// The seed's own response of cloth against obstacles: velocities prescribed in the filtered CG (Eq. 4), with stiction,
// Coulomb friction, and release by the residual.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "collision/response/contact_set.hpp"
#include "core/types.hpp"
#include "solver/linear_system.hpp"

namespace weft::collision {

/// A particle held in some directions: at the end of the step it is at `x_end` [m], moving with `v_end` [m/s], as far
/// as the constraint reaches.
struct PrescribedParticle {
  solver::ParticleConstraint constraint;
  Vec3 x_end, v_end;
};

/// Contacts of single particles with obstacles. Each is a wall: over the step of length h the particle may move by u
/// with n·u >= h v_n, where
///
///     v_n = (γ d_min − d) / h + n·v_r,   seed Eq. (4),
///
/// n the closest direction from the obstacle, d the distance along it, v_r the obstacle's velocity there. γ is
/// illegible in our text; reading chosen: 1 where d >= d_min, so that what arrives stops at d_min and what rests there
/// stays; and for d < d_min as much as closes the share kCorrection of the gap that is missing: γ d_min = d +
/// kCorrection (d_min − d).
///
/// A wall holds its particle (equality, one direction less in the CG) while it has to push, and is released where the
/// residual says that it would pull. Walls of one particle act together: up to three hold it at once. What is held is
/// held in the tangent plane too, moving with the obstacle, while the force that this takes lies in the friction cone.
/// Else it slides, with friction μ · load against the slip, smooth below the stick velocity as that of ContactSet;
/// sliding that slow at the end of a step sticks from then on. (As an explicit force, friction threw neighbours that
/// began to slide together back past where they came from, and cloth at rest went to and fro between sticking and
/// sliding.)
///
/// All this is decided anew between solves of a step (revise) and remembered for the next step (accept).
class VelocityConstraints {
 public:
  /// Force that the constraint of a particle exerted in the last solve [N].
  using ForceOn = std::function<Vec3(Index)>;

  VelocityConstraints() = default;
  explicit VelocityConstraints(std::vector<double> masses);  ///< of the particles [kg]

  /// Before the walls of a step over h [s] are added.
  void begin_step(double h);

  /// A particle at `distance` [m] from an obstacle's point along `normal`, which points to the particle; that point
  /// moves by `motion` [m] during the step. `static_friction`: of what sticks, no less than that of sliding.
  void add(Index particle, const Vec3& normal, double distance, double d_min, const Vec3& motion, double friction,
           double static_friction = 0);

  /// Whether there are particles that walls held at the end of the last step and that have none now: corners of
  /// triangles, whose walls are found where the triangle would meet an obstacle. `leaning` is x_t1 then, with these
  /// particles moved `by` so much [m] to where the wall was: without it they would be let go by the first solve, in
  /// step after step.
  bool lean(std::span<const Vec3> x_t1, double by, std::vector<Vec3>& leaning) const;

  /// Which walls hold in the first solve: those that held at the end of the last step, and those that the particle
  /// would pass if it moved from x_t0 to x_t1.
  void prepare(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1);

  /// After a solve that led to x_end: adds walls that were passed, releases those that pull, lets particles slide or
  /// stick. Returns how many particles are constrained otherwise now; 0: the solve stands.
  int revise(std::span<const Vec3> x_t0, std::span<const Vec3> x_end, const ForceOn& force_on);

  /// Remembers for the next step what holds, sticks and slides at the end of this one.
  void accept();

  std::span<const PrescribedParticle> prescribed() const { return prescribed_; }
  /// Whether no wall is known.
  bool empty() const { return walls_.empty(); }

  /// force += friction of the sliding particles at x_end [N].
  void add_forces(std::span<const Vec3> x_end, std::span<Vec3> force) const;
  /// That friction, the loads that it goes by, and the most that it can be by them [N].
  void add_parts_of_forces(std::span<const Vec3> x_end, std::span<Vec3> push, std::span<Vec3> friction,
                           std::span<double> limit) const;
  /// As add_forces, and adds −∂f/∂x to the matrix, where x_end changes by `end_rate` per change of the unknown; in a
  /// form that is definite, that of ContactSet::linearise.
  void linearise(std::span<const Vec3> x_end, double end_rate, std::span<Vec3> force,
                 solver::LinearSystem& system) const;

  /// What accept() has remembered. Throws std::runtime_error where these particles cannot have it.
  template <class Archive>
  void serialize(Archive& archive);

 private:
  enum class State : std::uint8_t { away, sticking, sliding };

  struct Wall {
    Vec3 normal;
    double bound;     // least n·u [m]
    Vec3 motion;      // of the obstacle [m]
    double friction;  // μ while sliding
    double static_friction;
    int next;  // of the same particle, or −1
  };
  /// Walls that hold a particle, by number, in rising order.
  struct Held {
    std::array<int, 3> walls{-1, -1, -1};
    std::array<double, 3> loads{0, 0, 0};
    int count = 0;
    bool same_walls(const Held& other) const { return count == other.count && walls == other.walls; }
    double load() const { return loads[0] + loads[1] + loads[2]; }
  };
  /// What is known of a particle: of those in contact during the step, and kept from the last step.
  struct Memory {
    State state = State::away;
    Vec3 push = Vec3::Zero();  // force of the walls, normal part [N]
    double load = 0;           // its size, by walls [N]
  };
  struct Touched {
    Index particle;
    int first_wall;
    Memory memory;
    Held held;
    Vec3 x_t0 = Vec3::Zero();
    Vec3 u_held = Vec3::Zero();  // prescribed displacement [m], as far as held
    double friction_load = 0;    // that friction of this solve goes by [N]
    Vec3 drag = Vec3::Zero();    // friction against its limit at unchanged velocity, where the step begins its search
    int flips = 0;               // changes of what holds it, in this step
    bool slow = false;           // slides so slowly that it might stick
    bool overloaded = false;     // stuck in this step by far more than friction allows
  };

  Vec3 project(const Touched& particle, const Vec3& u, bool of_force, Held& held) const;
  void hold(Touched& particle, const Vec3& u, Held held);
  bool revise(Touched& particle, const Vec3& x_end, const Vec3& force);
  int main_wall(const Touched& particle) const;
  Mat3 free_directions(const Touched& particle) const;
  struct Friction {
    Vec3 force;
    Mat3 stiffness;  // −∂f/∂x, definite [N/m]
  };
  Friction friction(const Touched& particle, const Vec3& x_end) const;
  Vec3 slip(const Touched& particle, const Vec3& x_end) const;
  PrescribedParticle prescription(const Touched& particle) const;
  void prescribe();

  std::vector<double> masses_;
  double step_ = 0;  // h [s]
  std::vector<Wall> walls_;
  std::vector<Touched> touched_;
  std::vector<int> touched_of_;  // per particle: its place in touched_, or −1
  std::vector<Memory> memory_;   // per particle, from the last accepted step
  std::vector<Index> remembered_;
  std::vector<PrescribedParticle> prescribed_;
};

}  // namespace weft::collision
