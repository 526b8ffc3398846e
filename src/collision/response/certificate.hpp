// Separating planes that move and turn: when two sets of vertices are apart for a whole step.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "collision/hierarchy/surface.hpp"
#include "collision/proximity/closest_points.hpp"
#include "collision/proximity/feature_pair.hpp"
#include "core/numerics.hpp"
#include "core/types.hpp"

namespace weft::collision {

/// Two triangles, or an edge and a triangle, without a common vertex, by their vertices. An edge names its second end
/// twice.
struct CornerPair {
  Triangle a, b;
  friend auto operator<=>(const CornerPair&, const CornerPair&) = default;
};

/// min_a n·x − max_b n·x: along the unit direction n, side a lies above side b by this [m].
double gap_along(const Vec3& n, const CornerPair& pair, std::span<const Vec3> x);

/// Whether n is a certificate for the linear motion from x_t0 to x_t1: the gap along it is at least kRoundoff at the
/// start, so that what touches is never taken for apart, and Numerics::Separation::least_gap at the end. Every n·x is
/// linear in time, so the gap is a minimum of linear functions, concave, and positive all the way between: a plane
/// normal to n that moves along separates the pair for the whole step. No root is sought.
bool separates(const Vec3& n, const CornerPair& pair, std::span<const Vec3> x_t0, std::span<const Vec3> x_t1);

/// Which certificates count: planes of constant direction alone, or those that turn too.
enum class Certificates { constant, all };

/// Looks for a certificate, by increasing cost: a plane that keeps its direction, then one that turns with the pair, at
/// last three times in halves of the way. Face normals separate layers, the direction between the centres neighbours in
/// the plane, and the closest direction whatever hardly moves.
///
/// A plane turns with n(t) = (1 − t) n₀ + t n₁. Along it a difference d(t) of corners that move linearly is quadratic
/// in time, with the Bernstein coefficients n₀·d₀, (n₀·d₁ + n₁·d₀)/2 and n₁·d₁, and positive where these are. Two
/// layers at a distance d, however wide, that turn together by an angle θ have d, d cos θ and d; a plane of constant
/// direction is in the way of one of them once their width times sin(θ/2) is more than d.
///
/// Returns the direction at the end, rounded to single precision, so that it can be kept in half the space.
std::optional<Vec3> find_certificate(const CornerPair& pair, std::span<const Vec3> x_t0, std::span<const Vec3> x_t1,
                                     Certificates which = Certificates::all);

/// The closest pair of features of two sides.
struct ClosestFeatures {
  std::array<Index, 4> vertices{};  ///< global numbers
  ClosestPoints points{};           ///< weights of the vertices; difference from b to a
  ProximityKind kind = ProximityKind::vertex_face;
};
ClosestFeatures closest_features(const CornerPair& pair, std::span<const Vec3> x);

}  // namespace weft::collision
