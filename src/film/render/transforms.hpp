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

/// Axes that look along `forward`, with `up` (not x) upright in the picture. If the two are parallel, right is x, as in
/// views from the front of a scene. If `forward` is zero, the direction is arbitrary.
ViewAxes view_axes(const Vec3& forward, const Vec3& up);

/// view_from_world for a viewer at `eye`.
Mat4 look_along(const Vec3& eye, const ViewAxes& axes);

/// clip_from_view of a perspective picture; the tangents are those of half the field of view; `near` in metres. Depth
/// is near / distance, from 1 to 0: in floating point, its relative error is the same at all distances (Reed, "Depth
/// Precision Visualized", 2015).
Mat4 perspective(double tan_half_width, double tan_half_height, double near);

}  // namespace weft::render
