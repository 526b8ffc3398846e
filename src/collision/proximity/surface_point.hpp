// Where a surface is nearest to a point and on which side of it, and where triangles cross.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "collision/hierarchy/broad_phase.hpp"
#include "collision/hierarchy/surface.hpp"
#include "core/types.hpp"

namespace weft::collision {

/// The point of a surface nearest to p.
struct SurfacePoint {
  Triangle face{};
  std::array<double, 3> weights{};  ///< of the face's corners
  Vec3 normal = Vec3::UnitZ();      ///< unit, outward: away from the inside along the line to p
  double height = 0;                ///< distance of p [m], negative inside; infinite without triangles
};

/// Of these triangles, counter-clockwise from outside. Inside and outside, or back and front, are told by the
/// angle-weighted normal of all faces that meet in the nearest point (Bærentzen & Aanæs, "Signed Distance Computation
/// Using the Angle Weighted Pseudonormal", 2005).
SurfacePoint nearest_point(const Vec3& p, std::span<const Triangle> triangles, std::span<const Vec3> x);

/// Of a surface of the broad phase, at x [m] inside of the bounds of its last refit: the same bits as of all its
/// triangles (unless a chain of a thousand of them spans kAsNear, each kTie from the next). Only faces of which
/// `counts` is true, if given; and of these, where there are any, those whose normal points less than 60 degrees away
/// from `towards`; zero for all.
using CountsFace = std::function<bool(const Triangle& face)>;
SurfacePoint nearest_point(const Vec3& p, const BroadPhase& broad_phase, std::size_t surface, std::span<const Vec3> x,
                           const Vec3& towards = Vec3::Zero(), const CountsFace& counts = nullptr);

/// Whether a point is inside of a surface of the broad phase, which may cross itself: more faces let out the ray from
/// it along the axis nearest to `towards` than let it in. Of an open surface: behind it. At x [m] inside of the bounds
/// of the last refit.
bool is_inside(const Vec3& p, const Vec3& towards, const BroadPhase& broad_phase, std::size_t surface,
               std::span<const Vec3> x);

/// Triangles of a surface of the broad phase, in their order, whose boxes come closer to that of `triangle` than
/// `reach` [m], at x [m] inside of the bounds of the last refit.
std::vector<Triangle> triangles_near(const Triangle& triangle, const BroadPhase& broad_phase, std::size_t surface,
                                     std::span<const Vec3> x, double reach);

/// Where an edge of one triangle goes through the other: the weights of the corners of `a`, on average over the ends of
/// the segment that the two have in common; empty if they do not cross.
std::optional<std::array<double, 3>> find_crossing(const Triangle& a, const Triangle& b, std::span<const Vec3> x);

/// Unit normal of the front; zero where a triangle has no area.
Vec3 face_normal(const Triangle& t, std::span<const Vec3> x);

}  // namespace weft::collision
