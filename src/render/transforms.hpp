// Matrices of the pipeline. Spaces: world [m], view (right, up, backward [m]), clip (OpenGL, -w to w).
#pragma once

#include <numbers>

#include "core/types.hpp"

namespace weft::render {

using Mat4 = Eigen::Matrix4d;

inline double radians(double degrees) {
  return degrees * std::numbers::pi / 180;
}

/// Orthonormal axes of a viewer; forward points into the picture.
struct ViewAxes {
  Vec3 right, up, forward;
};

/// Axes looking along `forward` with `up` upright; where the two are parallel or `forward` is zero, some upright
/// choice.
ViewAxes view_axes(const Vec3& forward, const Vec3& up);

/// view_from_world of a viewer at `eye`.
Mat4 look_along(const Vec3& eye, const ViewAxes& axes);

/// clip_from_view of a perspective picture; the tangents are of half the opening, distances in metres.
Mat4 perspective(double tan_half_width, double tan_half_height, double near, double far);

/// clip_from_view of a parallel view onto the box `bounds_view`, whose z runs backward as view space does.
Mat4 orthographic(const Box3& bounds_view);

/// Texture coordinates and depth, each 0 to 1, from clip space.
Mat4 texture_from_clip();

}  // namespace weft::render
