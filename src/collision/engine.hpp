// Collision of all cloths and obstacles over one time step: who is near, what pushes back, and that nothing passes.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "collision/hierarchy/broad_phase.hpp"
#include "collision/proximity/proximities.hpp"
#include "collision/response/contact_set.hpp"
#include "collision/response/pinch_report.hpp"
#include "collision/response/separation.hpp"
#include "collision/response/velocity_constraints.hpp"
#include "core/types.hpp"

namespace weft::collision {

/// One surface that collides. Vertices of all bodies share one numbering: particles first, then obstacles.
struct Body {
  std::vector<Triangle> triangles;  ///< corners by global vertex number
  Index first_vertex = 0;
  Index vertex_count = 0;
  bool deformable = false;
  double thickness = 0;  ///< of cloth [m]; 0 for obstacles
  double friction = 0;   ///< Coulomb coefficient; of a pair: the geometric mean
  bool moving = true;    ///< false: its vertices stay where they are at the start
};

/// Coulomb coefficients of two bodies while they slide and before.
struct Friction {
  double sliding = 0, at_rest = 0;
};
struct PairFriction {
  std::size_t a = 0, b = 0;  ///< bodies, in any order
  Friction friction;
};

struct EngineParameters {
  bool self = true;                    ///< cloth against itself and other cloth
  bool obstacles = true;               ///< cloth against obstacles
  double stiffness = 100;              ///< least stiffness of a contact [N/m]
  std::vector<PairFriction> friction;  ///< of pairs with coefficients of their own
  BroadPhaseOptions search;
  bool reuse = true;                  ///< of candidates and close features while nothing has moved far
  bool velocity_constraints = false;  ///< of single particles against obstacles, in place of contacts
};

class Engine {
 public:
  /// `x`: all vertices at the start [m]; `masses`: of the particles [kg].
  Engine(std::vector<Body> bodies, const EngineParameters& parameters, std::span<const Vec3> x,
         std::vector<double> masses);

  /// Finds the contacts of a step over h [s] from x_t0, with x_t1 the expected end: obstacles exactly, particles by
  /// guess.
  void begin_step(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1, double h);

  /// Lets go, between two steps, of what only makes the search faster and cannot be exchanged.
  void forget();

  /// What the next step from x [m] depends on, besides that. Throws std::runtime_error where these bodies cannot have
  /// it.
  template <class Archive>
  void exchange(Archive& archive, std::span<const Vec3> x);

  /// The contacts found, to act inside the solve.
  ContactSet& contacts() { return contacts_; }
  const ContactSet& contacts() const { return contacts_; }

  /// Those of single particles with obstacles, where the parameters ask for it.
  VelocityConstraints& constraints() { return constraints_; }
  const VelocityConstraints& constraints() const { return constraints_; }

  /// Whether every pair of triangles stays apart on the way to x_t1.
  bool apart(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1);

  /// Makes contacts of the pairs for which the last call of apart() said no; returns how many are new.
  int adopt_failing(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1);

  /// Corrects the ends x_t1 of movable particles so that no triangles meet during the step. Where obstacles leave no
  /// room, cloth is given up to them: `may_pinch` allows that; without it only to obstacles that pinch this cloth
  /// already.
  SeparationReport push_apart(std::span<const Vec3> x_t0, std::span<Vec3> x_t1, std::span<const std::uint8_t> movable,
                              bool may_pinch = false);

  /// Triangles of cloth that are given up to an obstacle, counted per obstacle.
  int pinched_pairs() const { return static_cast<int>(pinched_.size()); }
  /// Which cloths and obstacles that are, with places at x [m], where the last step began.
  std::vector<Pinch> pinches(std::span<const Vec3> x) const { return list_pinches(pinched_, broad_phase_, x); }

  /// Pairs of features within the reach, 1.5 contact ranges, at the start of the last step.
  int proximities() const { return static_cast<int>(proximities_.size()); }
  /// Their smallest distance [m]; infinite if there are none.
  double min_distance() const;

  /// A pair of triangles that touches or crosses at x [m], if there is one.
  std::optional<CornerPair> find_meeting(std::span<const Vec3> x);

  std::size_t body_of(Index vertex) const { return body_of_[static_cast<std::size_t>(vertex)]; }
  /// Number within its body of a triangle with these corners, an edge's second end being named twice.
  Index triangle_of(const Triangle& corners) const;

 private:
  void prepare_friction();
  const Friction& friction_of(std::size_t a, std::size_t b) const { return friction_[a * bodies_.size() + b]; }
  void collect(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1);
  /// Two features that are to push each other.
  struct Touch {
    std::array<Index, 4> vertices;
    std::array<double, 4> weights;
    Vec3 normal;
    double share;        // of the stiffness
    double range_limit;  // of the range [m]
  };
  void add_contact(const Touch& touch, std::span<const Vec3> x_t0, std::span<const Vec3> x_t1);
  void add_pinch_contacts(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1);
  bool is_pinched(const std::array<Index, 4>& vertices) const;
  bool constrain(const Touch& touch, std::span<const Vec3> x_t0, std::span<const Vec3> x_t1);
  bool constrain_corners(const CornerPair& pair, const Touch& touch, std::span<const Vec3> x_t0,
                         std::span<const Vec3> x_t1);
  bool near_start(std::span<const Vec3> x) const;
  bool inside_bounds(std::span<const Vec3> x) const;
  template <class Archive>
  void exchange_candidates(Archive& archive);

  std::vector<Body> bodies_;
  EngineParameters parameters_;
  std::vector<double> masses_;
  std::vector<Friction> friction_;    // of each pair of bodies
  std::vector<Triangle> triangles_;   // of all bodies, in their order
  std::vector<std::size_t> body_of_;  // per vertex
  std::vector<Surface> surfaces_;     // per body
  std::vector<Surface> deformable_;
  BroadPhase broad_phase_;
  ProximityFinder finder_;
  Separation separation_;
  std::span<const CornerPair> failing_;  // of the last call of apart()
  PinchedPairs pinched_;
  double reach_ = 0;  // distance up to which contacts are prepared [m]
  double step_ = 0;   // h [s]

  CandidatePairs candidates_;
  CandidatePairs near_;  // those that may be within the reach
  // What the candidates are good for: vertices between these positions, or no further from there than the margin [m].
  std::vector<Vec3> from_, to_;
  double margin_ = -1;  // negative: there are none
  std::vector<Proximity> proximities_;
  // Sorted vertices of the features that push with all their stiffness; sorted itself.
  std::vector<std::array<Index, 4>> in_contact_;
  ContactSet contacts_;
  VelocityConstraints constraints_;
};

}  // namespace weft::collision
