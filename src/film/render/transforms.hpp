// Matrices from world to view and clip space. View space: right, up, backward [m]. Clip space: x
// and y from -w to w, z from 0 (infinitely far) to w (near plane).
#pragma once

#include <numbers>

#include "core/types.hpp"

namespace weft::render {

using Mat4 = Eigen::Matrix4d;

inline double radians(double degrees) {
  return degrees * std::numbers::pi / 180;
}

/// Orthonormal axes of a viewer; `forward` points into the picture.
struct ViewAxes {
  Vec3 right, up, forward;
};

/// Axes of a viewer who looks along `forward`, with `up` upright in the picture. If the two are
/// parallel, `right` is x, as in views from the front of a scene; `up` must not be x. If `forward`
/// is zero, the viewer looks in an arbitrary direction perpendicular to `up`.
ViewAxes view_axes(const Vec3& forward, const Vec3& up);

/// view_from_world for a viewer at `eye`.
Mat4 look_along(const Vec3& eye, const ViewAxes& axes);

/// clip_from_view of a perspective picture. The tangents are those of half the field of view; `near` [m]. Depth is
/// `near` divided by the distance, from 1 to 0. In floating point, this depth has the same relative error at all
/// distances (Reed, "Depth Precision Visualized", 2015).
Mat4 perspective(double tan_half_width, double tan_half_height, double near);

}  // namespace weft::render
