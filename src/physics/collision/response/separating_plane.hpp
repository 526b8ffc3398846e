// Separating planes that translate and turn. They prove that two triangles stay apart for a whole step.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "core/numerics.hpp"
#include "core/types.hpp"
#include "physics/collision/hierarchy/surface.hpp"
#include "physics/collision/proximity/closest_points.hpp"
#include "physics/collision/proximity/feature_pair.hpp"

namespace weft::collision {

/// Two triangles, or an edge and a triangle, without a common vertex. An edge repeats its second end.
struct CornerPair {
  Triangle a, b;
  friend auto operator<=>(const CornerPair&, const CornerPair&) = default;
};

/// Gap along the unit direction n, from b to a: minimum of n·x over the corners of a minus maximum over those of b [m].
double gap_along(const Vec3& n, const CornerPair& pair, std::span<const Vec3> x);

/// Whether a plane with the constant normal n, which translates with the pair, separates both sides
/// during the linear motion from x_t0 to x_t1. The gap along n must be at least kRoundoff [m] at
/// the start (so touching vertices are not separated), and at least Numerics::Separation::least_gap
/// at the end. Every n·x is linear in time. So the gap, a minimum of linear functions, is concave
/// and stays positive in between.
bool separates(const Vec3& n, const CornerPair& pair, std::span<const Vec3> x_t0, std::span<const Vec3> x_t1);

/// Kinds of planes that a search tries. `constant`: planes of constant direction. `turning`: also planes that turn
/// during the step. `all`: also several planes one after the other, each for a part of the step.
enum class PlaneKinds { constant, turning, all };

/// Searches for a separating plane of the kinds `which`, cheap ones first:
///   1. constant directions: face normals at the start and at the end (for layers), and the line between the centres at
///      the start (for neighbours in one plane);
///   2. the same directions, turning from start to end;
///   3. the line between the closest points, constant, then turning;
///   4. all again in each half of the trajectory. Halves are halved again, to at least 2^−n of the trajectory, where n
///      is Numerics::Repair::max_retries.
///
/// A turning plane has the normal n(t) = (1 − t) n₀ + t n₁, with t from 0 to 1. Let δ(t) be the difference of two
/// linearly moving corners. Then n·δ is quadratic in t. Its Bernstein coefficients are n₀·δ₀, (n₀·δ₁ + n₁·δ₀)/2 and
/// n₁·δ₁. If they are positive, so is n·δ. Example: two layers at a distance g turn together by an angle θ. The
/// coefficients are g, g cos θ and g, for layers of any width. A plane of constant direction, however, cuts a layer if
/// its width times sin(θ/2) exceeds g.
///
/// Returns the direction of the plane at the end of the step, in single precision as Planes stores it; nullopt if none.
std::optional<Vec3> find_separating_plane(const CornerPair& pair, std::span<const Vec3> x_t0,
                                          std::span<const Vec3> x_t1, PlaneKinds which = PlaneKinds::all);

/// The closest pair of features of the two sides of a CornerPair.
struct ClosestFeatures {
  std::array<Index, 4> vertices{};  ///< global numbers
  ClosestPoints points{};           ///< weights of the vertices; difference points from b to a
  ProximityKind kind = ProximityKind::vertex_face;
};
ClosestFeatures closest_features(const CornerPair& pair, std::span<const Vec3> x);

}  // namespace weft::collision
