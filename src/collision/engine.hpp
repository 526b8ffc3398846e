// Collision of all cloths and obstacles over one time step: who is near, what pushes back, and that nothing passes.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "collision/hierarchy/traversal.hpp"
#include "collision/proximity/proximities.hpp"
#include "collision/response/contact_set.hpp"
#include "collision/response/separation.hpp"
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
};

struct EngineParameters {
  bool self = true;        ///< cloth against itself and other cloth
  bool obstacles = true;   ///< cloth against obstacles
  double stiffness = 100;  ///< least stiffness of a contact [N/m]
};

class Engine {
 public:
  /// `x`: all vertices at the start [m]; `masses`: of the particles [kg].
  Engine(std::vector<Body> bodies, const EngineParameters& parameters, std::span<const Vec3> x,
         std::vector<double> masses);

  /// Finds the contacts of a step over h [s] from x_t0, with x_t1 the expected end: obstacles exactly, particles by
  /// guess.
  void begin_step(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1, double h);

  /// The contacts found, to act inside the solve.
  ContactSet& contacts() { return contacts_; }
  const ContactSet& contacts() const { return contacts_; }

  /// Makes contacts of the pairs that would meet on the way to x_t1; returns how many are new.
  int adopt_failing(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1);

  /// Corrects the ends x_t1 of movable particles so that no triangles meet during the step.
  SeparationReport finish_step(std::span<const Vec3> x_t0, std::span<Vec3> x_t1, std::span<const std::uint8_t> movable);

  /// Pairs of features within the reach, 1.5 contact ranges, at the start of the last step.
  int proximities() const { return static_cast<int>(proximities_.size()); }
  /// Their smallest distance [m]; infinite if there are none.
  double min_distance() const;

  /// A pair of triangles that touches or crosses at x [m], if there is one.
  std::optional<TrianglePair> find_meeting(std::span<const Vec3> x);

  Index first_triangle(std::size_t body) const { return trees_[body].surface().first_triangle; }
  /// The two bodies of a pair of triangles.
  std::array<std::size_t, 2> bodies_of(const TrianglePair& pair) const;
  const Triangle& triangle(Index number) const { return triangles_[static_cast<std::size_t>(number)]; }

 private:
  void collect(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1);
  void add_contact(const std::array<Index, 4>& vertices, const std::array<double, 4>& weights, const Vec3& normal,
                   std::span<const Vec3> x_t0, std::span<const Vec3> x_t1);
  bool strayed(std::span<const Vec3> x_t1) const;

  std::vector<Body> bodies_;
  EngineParameters parameters_;
  std::vector<double> masses_;
  std::vector<Triangle> triangles_;   // of all bodies, in their order
  std::vector<std::size_t> body_of_;  // per vertex
  std::vector<SurfaceTree> trees_;    // per body
  std::vector<Surface> deformable_;
  ProximityFinder finder_;
  Separation separation_;
  double reach_ = 0;   // distance up to which contacts are prepared [m]
  double margin_ = 0;  // of the bounds [m]
  double step_ = 0;    // h [s]

  CandidatePairs candidates_;
  std::vector<Vec3> collected_for_;  // x_t1 of the candidates
  std::vector<Proximity> proximities_;
  std::set<std::array<Index, 4>> adopted_;  // features that are contacts because their triangles would have met
  ContactSet contacts_;
};

}  // namespace weft::collision
