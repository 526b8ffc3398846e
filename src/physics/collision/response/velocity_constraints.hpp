// Contact response of cloth against obstacles after Etzmuß et al. (2001): velocities prescribed in the filtered CG (Eq.
// 4), stiction, Coulomb friction, and release where the residual shows a pull.
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

/// A particle constrained in some directions. In these it ends the step at `x_end` [m] with velocity `v_end` [m/s].
struct PrescribedParticle {
  solver::ParticleConstraint constraint;
  Vec3 x_end, v_end;
};

/// Contacts of single particles with obstacles. Each is a wall: over a step of length h the particle may move by u with
/// n·u >= h v_n, where
///
///     v_n = (γ d_min − d) / h + n·v_r (Eq. 4)
///
/// with the arguments of add(): n = `normal`, d = `distance`, v_r = `motion` / h, the velocity of the obstacle there.
/// As γ is illegible in our copy of the paper, we choose γ = 1 if d >= d_min, so that arriving particles stop at d_min
/// and resting ones stay. If d < d_min, a fraction c = Numerics::Walls::correction of the missing distance is restored:
/// γ d_min = d + c (d_min − d).
///
/// A wall holds its particle while the wall has to push: the inequality is then an equality, which removes one
/// direction from the CG. The wall releases the particle if the residual shows that the wall would pull. Up to three
/// walls hold a particle at once. A held particle also sticks in the tangent plane, moving with the obstacle, while the
/// force required for that lies in the friction cone. Otherwise it slides, with friction μ times the normal force
/// against the slip, smooth below the stick velocity as in ContactSet. A particle that ends a step slower than the
/// stick velocity, with the same walls and nearly the same normal force as before, sticks from the next step on
/// (exception: see accept() in the .cpp). Friction is implicit: an explicit friction force would reverse the motion of
/// neighbours that begin to slide together.
///
/// The state is revised between the solves of a step (revise) and kept for the next step (accept).
class VelocityConstraints {
 public:
  /// Force that the constraint of a particle exerted in the last solve [N].
  using ForceOn = std::function<Vec3(Index)>;

  VelocityConstraints() = default;
  explicit VelocityConstraints(std::vector<double> masses);  ///< of the particles [kg]

  /// Call before adding the walls of a step over h [s].
  void begin_step(double h);

  /// Adds a wall for a particle at `distance` [m] from a point of an obstacle, along `normal`, which points to the
  /// particle. The point moves by `motion` [m] during the step. `d_min`: activation distance [m]. `static_friction`:
  /// while sticking; raised to `friction` if less.
  void add(Index particle, const Vec3& normal, double distance, double d_min, const Vec3& motion, double friction,
           double static_friction = 0);

  /// Finds the particles that walls held at the end of the last step and that have no wall yet in this one. Until now,
  /// a wall was found only for corners of triangles that would meet an obstacle on the way to x_t1, the expected end of
  /// the step. Without a wall, the first solve would release these particles. If there are any, returns true and sets
  /// `predicted` to x_t1 with these particles moved by `by` [m] towards their former walls, so that a second search
  /// finds these walls.
  bool predict_wall_contacts(std::span<const Vec3> x_t1, double by, std::vector<Vec3>& predicted) const;

  /// Chooses the walls that hold in the first solve: those that a particle would pass on the way from x_t0, the start
  /// of the step, to its expected end. That end is x_t1, moved slightly towards the walls that held the particle at the
  /// end of the last step.
  void prepare(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1);

  /// After a solve that led to x_end: lets walls that were passed hold, releases walls that pull, and lets sticking
  /// particles slide if static friction is exceeded. Returns how many particles need another solve; 0: the solve is
  /// final.
  int revise(std::span<const Vec3> x_t0, std::span<const Vec3> x_end, const ForceOn& force_on);

  /// Keeps for the next step which particles are held and which of them stick or slide.
  void accept();

  std::span<const PrescribedParticle> prescribed() const { return prescribed_; }
  /// Whether there are no walls.
  bool empty() const { return walls_.empty(); }

  /// force += friction of the sliding particles at x_end [N].
  void add_forces(std::span<const Vec3> x_end, std::span<Vec3> force) const;
  /// Adds, for the sliding particles: normal forces (`push`), friction, and the maximum friction (`limit`) [N].
  void add_normal_and_friction_forces(std::span<const Vec3> x_end, std::span<Vec3> push, std::span<Vec3> friction,
                                      std::span<double> limit) const;
  /// As add_forces; also adds −∂f/∂x to the matrix, positive semidefinite as in ContactSet::linearise. `end_rate`:
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
    double bound;     // minimum of n·u [m]
    Vec3 motion;      // of the obstacle [m]
    double friction;  // μ while sliding
    double static_friction;
    int next;  // next wall of the same particle, or −1
  };
  /// Walls that hold a particle, as indices into walls_; −1: none. The order is that in which project() tries them; for
  /// a particle with more than Numerics::Walls::max_walls walls, it depends on the displacement.
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
    Vec3 push = Vec3::Zero();  // normal part of the force of the walls [N]
    double normal_force = 0;   // sum of the components of `push` along the normals of the walls [N]
  };
  struct TouchingParticle {
    Index particle;
    int first_wall;
    Memory memory;
    ActiveWalls held;
    Vec3 x_t0 = Vec3::Zero();
    Vec3 u_held = Vec3::Zero();        // prescribed displacement, in the held directions [m]
    double friction_normal_force = 0;  // normal force that limits friction in this solve [N]
    Vec3 drag = Vec3::Zero();          // −friction / maximum friction for the motion from x_t0 to x_t1
    int constraint_changes = 0;        // how often its constraint changed in this step
    bool slow = false;                 // slides so slowly that it may stick
    bool overloaded = false;           // began to slide: sticking took clearly more than static friction
  };

  Vec3 project(const TouchingParticle& particle, const Vec3& u, bool of_force, ActiveWalls& held) const;
  void hold(TouchingParticle& particle, const Vec3& u, ActiveWalls held);
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
  std::vector<TouchingParticle> touched_;
  std::vector<int> touched_of_;  // per particle: index in touched_, or −1
  std::vector<Memory> memory_;   // per particle, from the last accepted step
  std::vector<Index> remembered_;
  std::vector<PrescribedParticle> prescribed_;
};

}  // namespace weft::collision
