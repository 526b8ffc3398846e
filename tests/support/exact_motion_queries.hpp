// Random and constructed queries for continuous collision detection: two moving triangles without a common vertex.
#pragma once

#include <array>
#include <random>

#include "support/exact_motion.hpp"

namespace weft::support {

/// Kind of a query. Unless stated otherwise, sizes are 1e-6 to 1e3 m, and places up to 1e3 m from the origin. Queries
/// with exact coordinates are scaled by 2⁻²⁰ to 2⁵ m, and shifted along each axis by up to 1000 times this scale.
enum class QueryFamily {
  random,    ///< motions from a thousandth of the size to three times the size
  touching,  ///< touch exactly at t = 0: vertex or edges on face, edge or vertex; then move away, along or through
  nearly_touching,   ///< touch at t = 0 up to rounding, so that they may be apart or cross
  parallel_edges,    ///< an edge of each: parallel at t = 0, then stay so or turn
  one_plane,         ///< both in one plane, exact or rounded, throughout or at the start; or in parallel planes
  degenerate,        ///< at least one simplex is a point or three collinear points
  needles,           ///< at least one triangle has a height of about 1e-9 to 1e-3 of its length
  near_misses,       ///< 1e-9 to 1e-3 m apart, sizes 1e-2 to 10 m, relative motions 0.1 to 10 times the gap
  fast,              ///< one moves through or past the other, by 10 to 1000 times the size
  grazing_rotation,  ///< one corner sweeps past a feature while its triangle turns by up to half a turn
};
inline constexpr std::array kQueryFamilies = {
    QueryFamily::random,    QueryFamily::touching,        QueryFamily::nearly_touching, QueryFamily::parallel_edges,
    QueryFamily::one_plane, QueryFamily::degenerate,      QueryFamily::needles,         QueryFamily::near_misses,
    QueryFamily::fast,      QueryFamily::grazing_rotation};
const char* name(QueryFamily family);

struct MotionQuery {
  MovingSimplex a, b;
};
MotionQuery make_query(QueryFamily family, std::mt19937& engine);

/// Minimum distance between a feature of a and one of b at time t, in double precision; not zero if a pierces b.
double distance_at(const MovingSimplex& a, const MovingSimplex& b, double t);

}  // namespace weft::support
