// Input of untangling: all surfaces in one numbering, which vertices may move, and the connectivity of cloth.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/types.hpp"
#include "physics/collision/bodies.hpp"
#include "physics/mesh/topology.hpp"

namespace weft::untangle {

/// Kinds of surfaces, by the sides on which other cloth may be.
enum class SurfaceKind : std::uint8_t {
  cloth,  ///< cloth to be untangled; other cloth may be on either side
  solid,  ///< closed or nearly closed body; cloth may not be inside
  floor,  ///< cloth may not be below it
  open,   ///< other obstacle, or cloth that does not move; cloth may be on either side
  layer,  ///< cloth that does not move; cloth that is worn over it may only be on its outer side
};

/// Constant input: connectivity of surfaces, and allowed lengths of threads. A thread is a link along an edge.
struct UntangleInput {
  /// `x`: start positions of all vertices [m]. Those of SurfaceKind::cloth must come first: they are the particles.
  /// `rest`: stress-free positions of the particles [m]. `may_move`: per vertex. `of_bodies` and `may_move` must
  /// outlive this object.
  UntangleInput(const collision::Bodies& of_bodies, std::vector<SurfaceKind> of_kinds, std::span<const Vec3> x,
                std::span<const Vec3> rest, std::span<const std::uint8_t> may_move);

  /// Allowed range of the distance between two particles [m].
  struct Link {
    Index i, j;
    double min_length, max_length;
    bool is_bend;  ///< joins the opposite corners of two adjacent triangles; relax() corrects a part of its error
  };

  const collision::Bodies& bodies;
  std::vector<SurfaceKind> kinds;              ///< per body
  std::span<const std::uint8_t> movable;       ///< per vertex: 1 if it may move
  mesh::EdgeSet edges;                         ///< of all triangles, with global numbers
  std::vector<Link> links;                     ///< of cloth
  std::vector<std::vector<Index>> neighbours;  ///< per particle
  std::vector<std::uint8_t> on_border;         ///< per vertex: 1 if it is on a border
  std::vector<double> min_height;              ///< per body: height over others to which its cloth is moved [m]
  std::vector<std::uint8_t> can_move;          ///< per body: whether any of its vertices is movable

  bool is_cloth(Index vertex) const { return vertex < particles(); }
  Index particles() const { return static_cast<Index>(neighbours.size()); }
};

/// New position of a particle.
struct Move {
  Index particle;
  Vec3 target;  ///< [m]
};

/// Cost of moves: mean squared strain, after the moves, of the threads of the moved particles; 0 if
/// they have no threads. Strain is the relative excess over the maximum length, or the relative
/// deficit below the minimum length. Excess or deficit before the moves does not count.
double stretch_cost(const UntangleInput& input, std::span<const Move> moves, std::span<const Vec3> x);

}  // namespace weft::untangle
