// Nearest point of a surface, inside tests, and crossings of triangles.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "core/types.hpp"
#include "physics/collision/hierarchy/broad_phase.hpp"
#include "physics/collision/hierarchy/surface.hpp"

namespace weft::collision {

/// A face counts as facing a direction if the cosine between its normal and that direction exceeds this.
inline constexpr double kMinFacingCosine = 0.5;

/// The point of a surface nearest to p.
struct SurfacePoint {
  Triangle face{};
  std::array<double, 3> weights{};  ///< of the corners of the face
  Vec3 normal = Vec3::UnitZ();      ///< unit, outward, along the line through p; angle-weighted if p is on the surface
  double height = 0;                ///< signed distance of p [m], negative inside; infinite if there are no triangles
};

/// Nearest point of these triangles, which are counter-clockwise seen from outside. Inside and
/// outside (for an open surface: back and front) are distinguished by the angle-weighted normal of
/// all faces that meet at the nearest point (Bærentzen & Aanæs, "Signed Distance Computation Using
/// the Angle Weighted Pseudonormal", 2005).
SurfacePoint nearest_point(const Vec3& p, std::span<const Triangle> triangles, std::span<const Vec3> x);

/// Returns whether a face takes part in a search.
using CountsFace = std::function<bool(const Triangle& face)>;
/// Nearest point of a surface of the broad phase at positions x [m], which must be inside the bounds of its last refit.
/// Gives the same bits as a search over all faces that take part, unless some thousand faces are equally near up to
/// rounding. `counts`: if given, faces for which it is false do not take part. `towards`: unit or zero. If the normals
/// of some faces are within 60 degrees of it, only these faces take part. If there are none, or if `towards` is zero,
/// all faces take part.
SurfacePoint nearest_point(const Vec3& p, const BroadPhase& broad_phase, std::size_t surface, std::span<const Vec3> x,
                           const Vec3& towards = Vec3::Zero(), const CountsFace& counts = nullptr);

/// Whether a point is inside a surface of the broad phase. The surface may cross itself. Casts a ray of 1000 m along
/// the axis nearest to `towards`. The point counts as inside if the ray leaves through more faces than it enters
/// through. So for an open surface, a point behind a face that the ray meets counts as inside. x [m] must be inside the
/// bounds of the last refit.
bool is_inside(const Vec3& p, const Vec3& towards, const BroadPhase& broad_phase, std::size_t surface,
               std::span<const Vec3> x);

/// Triangles of a surface of the broad phase, in their order, whose boxes are closer than `distance` [m] along each
/// axis to the box of `triangle`. x [m] must be inside the bounds of the last refit.
std::vector<Triangle> triangles_near(const Triangle& triangle, const BroadPhase& broad_phase, std::size_t surface,
                                     std::span<const Vec3> x, double distance);

/// Where two triangles cross: weights of the corners of `a`, averaged over the points where an edge of one triangle
/// goes through the other triangle. Nullopt if they do not cross.
std::optional<std::array<double, 3>> find_crossing(const Triangle& a, const Triangle& b, std::span<const Vec3> x);

/// Unit normal of the front; zero if the triangle has no area.
Vec3 face_normal(const Triangle& t, std::span<const Vec3> x);

}  // namespace weft::collision
