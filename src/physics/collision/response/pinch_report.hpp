// Reports pinched cloth: the cloth, the obstacle that it intersects, and the obstacle that presses
// it there.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "physics/collision/bodies.hpp"
#include "physics/collision/response/pinch.hpp"

namespace weft::collision {

/// A cloth that intersects an obstacle because there is no space for it. `pressing_obstacle`: the
/// nearest other obstacle, or `obstacle` itself if two parts of it pinch the cloth; nullopt if
/// there is neither.
struct Pinch {
  std::size_t cloth = 0, obstacle = 0;  ///< numbers of the bodies
  std::optional<std::size_t> pressing_obstacle;
  Vec3 place;  ///< position of a pinched particle [m]
};

/// One entry for each pair of a cloth and an obstacle, with `place` at a corner of its first pinched triangle at x [m].
std::vector<Pinch> list_pinches(const PinchedPairs& pinched, const Bodies& bodies, const BroadPhase& surfaces,
                                std::span<const Vec3> x);

/// A pair in `pinched` whose obstacle does not pinch that cloth in `before`, as the triangle of cloth and the face of
/// the obstacle that first met it; nullopt if there is no such pair.
std::optional<CornerPair> find_new_pinch(const PinchedPairs& pinched, const PinchedPairs& before);

}  // namespace weft::collision
