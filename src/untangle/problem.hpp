// What is untangled: surfaces in one numbering, what of them may move, and how cloth is put together.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "collision/bodies.hpp"
#include "core/types.hpp"
#include "mesh/topology.hpp"

namespace weft::untangle {

/// What an obstacle is to cloth that begins on both sides of it.
enum class Kind : std::uint8_t {
  cloth,
  solid,  ///< has an inside, where no cloth may be
  floor,  ///< below it no cloth may be
  open,   ///< has two sides
  layer,  ///< has one side, the other one is that of the body below it
};

/// How surfaces hang together, and how long threads may be. Does not change.
struct Fabric {
  /// `x`: all vertices as the scene gives them, `rest`: particles as they are without stress [m]. `movable`: per
  /// vertex. All of these must outlive it.
  Fabric(const collision::Bodies& of_bodies, std::vector<Kind> of_kinds, std::span<const Vec3> x,
         std::span<const Vec3> rest, std::span<const std::uint8_t> may_move);

  /// Of two particles, the distances between which nothing is done [m].
  struct Link {
    Index i, j;
    double least, most;
    bool bend;  ///< opposite corners of two triangles: holds less
  };

  const collision::Bodies& bodies;
  std::vector<Kind> kinds;  ///< of each body
  std::span<const std::uint8_t> movable;
  mesh::EdgeSet edges;                         ///< of all triangles, by global numbers
  std::vector<Link> links;                     ///< of cloth
  std::vector<std::vector<Index>> neighbours;  ///< per particle
  std::vector<std::uint8_t> on_border;         ///< per vertex
  std::vector<double> thickness;               ///< of each body [m]

  bool is_cloth(Index vertex) const { return vertex < particles(); }
  Index particles() const { return static_cast<Index>(neighbours.size()); }
};

/// Where particles are to go: a way for each that is to move.
struct Move {
  Index particle;
  Vec3 target;  ///< [m]
};

/// How much cloth would be stretched and pressed if these were moved: the mean over the threads of what moves of the
/// square of what they are longer or shorter than they may be, as a share of that.
double stretch_cost(const Fabric& fabric, std::span<const Move> moves, std::span<const Vec3> x);

}  // namespace weft::untangle
