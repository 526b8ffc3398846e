// Reports pinched cloth: which cloth, which obstacle, and what presses the cloth into it.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "physics/collision/bodies.hpp"
#include "physics/collision/response/pinch.hpp"

namespace weft::collision {

/// A cloth that intersects an obstacle because there is no space for it.
struct Pinch {
  std::size_t cloth = 0, obstacle = 0;  ///< bodies
  std::optional<std::size_t> other;     ///< nearest other obstacle, if any; `obstacle` if its own parts pinch
  Vec3 place;                           ///< position of a particle [m]
};

/// One entry for each cloth and obstacle, with the place of its first pinched triangle at x [m].
std::vector<Pinch> list_pinches(const PinchedPairs& pinched, const Bodies& bodies, const BroadPhase& surfaces,
                                std::span<const Vec3> x);

/// A pair of `pinched` whose obstacle did not pinch that cloth in `before`, with an arbitrary face of the obstacle;
/// nullopt if there is none.
std::optional<CornerPair> find_new_pinch(const PinchedPairs& pinched, const PinchedPairs& before,
                                         const BroadPhase& surfaces);

}  // namespace weft::collision
