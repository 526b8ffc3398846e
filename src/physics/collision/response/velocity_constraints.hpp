// Contact response of cloth against obstacles after Etzmuß et al. (2001): velocities prescribed in the filtered
// conjugate gradients (Eq. 4), stiction, Coulomb friction, and release if the residual shows that a constraint pulls.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/types.hpp"
#include "physics/collision/response/contact_set.hpp"
#include "physics/solver/linear_system.hpp"

namespace weft::collision {

/// A particle constrained in some directions. In these directions, it ends the step at `x_end` [m]
/// with velocity `v_end` [m/s].
struct PrescribedParticle {
  solver::ParticleConstraint constraint;
  Vec3 x_end, v_end;
};

/// Contacts of single particles with obstacles. Each is a wall: over a step of length h, the displacement u of the
/// particle must satisfy n·u >= h v_n, where
///
///     v_n = (γ d_min − d) / h + n·v_r (Eq. 4)
///
/// with n = `normal`, d = `distance` and d_min, arguments of add(), and v_r = `motion` / h, the velocity of the
/// obstacle at the contact. γ is illegible in our copy of the paper. We choose γ = 1 if d >= d_min, so that arriving
/// particles stop at d_min and resting ones stay. If d < d_min, a step restores the fraction c =
/// Numerics::Walls::correction of the missing distance: γ d_min = d + c (d_min − d).
///
/// A wall holds its particle while satisfying the inequality takes a push. The inequality is then an equality, which
/// removes one direction from the conjugate gradients. The wall releases the particle if the residual shows that the
/// wall would pull. At most three walls hold a particle at once.
///
/// A held particle sticks (moves with the obstacle in the tangent plane, too) while the necessary force lies in the
/// friction cone. Otherwise the particle slides: friction acts against the slip, with μ times the normal force, reduced
/// below the stick velocity as in ContactSet. A particle that ends a step slower than the stick velocity, with the same
/// walls and nearly the same normal force as before, sticks from the next step on (exception: see accept() in the
/// .cpp). Friction is implicit, because explicit friction would reverse the motion of neighbours that begin to slide
/// together.
///
/// revise() updates the state between the solves of a step; accept() keeps it for the next step.
class VelocityConstraints {
 public:
  /// Force that the constraint of this particle exerted in the last solve [N].
  using ForceOn = std::function<Vec3(Index)>;

  explicit VelocityConstraints(std::vector<double> masses);  ///< of the particles [kg]

  /// Call before adding the walls of a step over h [s].
  void begin_step(double h);

  /// Adds a wall for a particle at `distance` [m] from a point of an obstacle. `normal` points from
  /// there to the particle. The point moves by `motion` [m] in the step. `d_min`: activation
  /// distance [m]. `friction`: Coulomb coefficient while sliding. `static_friction`: coefficient
  /// while sticking; a value below `friction` is raised to `friction`. If the particle already has
  /// a wall with nearly the same normal, the one with the stricter bound replaces the other one,
  /// except for the normal. If the bounds differ by less than kRoundoff [m], the first wall stays.
  void add(Index particle, const Vec3& normal, double distance, double d_min, const Vec3& motion, double friction,
           double static_friction = 0);

  /// Finds the particles that walls held at the end of the last step and that have no wall yet in this step, that is,
  /// neither for a near pair at the start of the step, nor for a triangle that would meet an obstacle on the way to
  /// x_t1, the expected end of the step. Without a wall, the first solve would release these particles. If there are
  /// such particles, returns true and sets `predicted` to x_t1, with these particles moved by `by` [m] towards their
  /// former walls, so that a second search finds walls for them.
  bool predict_wall_contacts(std::span<const Vec3> x_t1, double by, std::vector<Vec3>& predicted) const;

  /// Chooses the walls that hold in the first solve: those that a particle would pass on the way from x_t0, the start
  /// of the step, to its expected end. This end is x_t1, moved slightly towards the walls that held the particle at the
  /// end of the last step.
  void prepare(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1);

  /// Updates the walls after a solve that led to x_end. Walls that a particle has passed hold it
  /// from now on, walls that would pull release it, and sticking particles start to slide if static
  /// friction is exceeded. A particle whose constraint has changed Numerics::Walls::max_constraint_changes times in
  /// this step needs no further solve. Returns how many particles need another solve; 0: the solve
  /// is final.
  int revise(std::span<const Vec3> x_t0, std::span<const Vec3> x_end, const ForceOn& force_on);

  /// Call when the step is accepted. Keeps for the next step which particles are held, and which of
  /// these stick or slide.
  void accept();

  std::span<const PrescribedParticle> prescribed() const { return prescribed_; }
  /// Whether there are no walls.
  bool empty() const { return walls_.empty(); }

  /// force += friction of the sliding particles at x_end [N].
  void add_forces(std::span<const Vec3> x_end, std::span<Vec3> force) const;
  /// Adds normal forces to `push`, friction to `friction`, the magnitudes of normal forces to `normal_force`, and the
  /// maximum static friction to `limit` [N]. For sliding particles, these are the normal force that limits friction,
  /// and friction at x_end; for sticking ones, both parts of the force that the walls exerted in the last solve before
  /// revise().
  void add_normal_and_friction_forces(std::span<const Vec3> x_end, std::span<Vec3> push, std::span<Vec3> friction,
                                      std::span<double> normal_force, std::span<double> limit) const;
  /// As add_forces; also adds −∂f/∂x to the matrix, positive semidefinite as in ContactSet::linearise(). `end_rate`:
  /// dx_end/dx for the stage positions x (see integrator::StagePoint): 1, or 2 for the midpoint rule.
  void linearise(std::span<const Vec3> x_end, double end_rate, std::span<Vec3> force,
                 solver::LinearSystem& system) const;

  /// Saves or restores what accept() keeps. Throws std::runtime_error if restored data does not fit these particles.
  template <class Archive>
  void serialize(Archive& archive);

 private:
  enum class State : std::uint8_t { away, sticking, sliding };

  struct Wall {
    Vec3 normal;
    double bound;            // minimum of n·u [m]
    Vec3 motion;             // of the obstacle [m]
    double friction;         // μ while sliding
    double static_friction;  // μ while sticking
    int next;                // next wall of the same particle, or −1
  };
  /// Walls that hold a particle, as indices into walls_; −1: none. They are in the order in which project() tries them.
  /// For a particle with more than Numerics::Walls::max_walls walls, this order depends on the displacement.
  struct ActiveWalls {
    std::array<int, 3> walls{-1, -1, -1};
    std::array<double, 3> multipliers{0, 0, 0};
    int count = 0;
    bool same_walls(const ActiveWalls& other) const { return std::ranges::is_permutation(walls, other.walls); }
    double multiplier_sum() const { return multipliers[0] + multipliers[1] + multipliers[2]; }
  };
  /// State of a particle with walls: in the current step, or at the end of the last accepted one.
  struct Memory {
    State state = State::away;
    Vec3 push = Vec3::Zero();  // force of the walls along their normals [N]
    double normal_force = 0;   // sum of the components of `push` along the normals of the walls [N]
  };
  struct TouchingParticle {
    Index particle;
    int first_wall;
    Memory memory;
    ActiveWalls held;
    Vec3 x_t0 = Vec3::Zero();
    Vec3 u_held = Vec3::Zero();             // displacement prescribed in the constrained directions [m]
    Vec3 force_across = Vec3::Zero();       // force of the walls across their normals in the last solve [N]
    double friction_normal_force = 0;       // normal force that limits friction in this solve [N]
    Vec3 relative_friction = Vec3::Zero();  // −friction / maximum friction at the expected end x_t1
    int constraint_changes = 0;             // number of changes of its constraint in this step
    bool may_stick = false;                 // slides so slowly that it may stick from the next step on
    bool is_overloaded = false;  // began to slide, because sticking needs noticeably more than static friction
  };

  Vec3 project(const TouchingParticle& particle, const Vec3& u, bool of_force, ActiveWalls& held) const;
  void activate_walls(TouchingParticle& particle, const Vec3& u, ActiveWalls held);
  bool revise(TouchingParticle& particle, const Vec3& x_end, const Vec3& force);
  int main_wall(const TouchingParticle& particle) const;
  Mat3 free_directions(const TouchingParticle& particle) const;
  struct Friction {
    Vec3 force;
    Mat3 stiffness;  // −∂f/∂x, positive semidefinite [N/m]
  };
  Friction friction(const TouchingParticle& particle, const Vec3& x_end) const;
  Vec3 slip(const TouchingParticle& particle, const Vec3& x_end) const;
  PrescribedParticle prescription(const TouchingParticle& particle) const;
  void prescribe();

  std::vector<double> masses_;
  double step_ = 0;  // h [s]
  std::vector<Wall> walls_;
  std::vector<TouchingParticle> touching_particles_;
  std::vector<int> touching_index_;     // per particle: index in touching_particles_, or −1
  std::vector<Memory> memory_;          // per particle, from the last accepted step
  std::vector<Index> previously_held_;  // particles that walls held at the end of the last step
  std::vector<PrescribedParticle> prescribed_;
};

}  // namespace weft::collision
