// What is said about pinched cloth: which cloth, which obstacle, and what else presses it there.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "collision/bodies.hpp"
#include "collision/response/pinch.hpp"

namespace weft::collision {

/// Cloth that is in an obstacle because it has no room.
struct Pinch {
  std::size_t cloth = 0, obstacle = 0;  ///< bodies
  std::optional<std::size_t> other;  ///< the other obstacle nearest to it, if there is one; the same: parts of it pinch
  Vec3 place;                        ///< of a particle [m]
};

/// One for each cloth and obstacle, with the place of the first triangle that is pinched, at x [m].
std::vector<Pinch> list_pinches(const PinchedPairs& pinched, const Bodies& bodies, const BroadPhase& surfaces,
                                std::span<const Vec3> x);

/// A pair of `pinched` whose obstacle did not pinch that cloth before; with any face of the obstacle.
std::optional<CornerPair> first_fresh(const PinchedPairs& pinched, const PinchedPairs& before,
                                      const BroadPhase& surfaces);

}  // namespace weft::collision
