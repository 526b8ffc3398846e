#include "film/render/transforms.hpp"

namespace weft::render {

ViewAxes view_axes(const Vec3& forward, const Vec3& up) {
  ViewAxes axes;
  axes.forward = forward.squaredNorm() > 0 ? forward.normalized() : Vec3(-up.unitOrthogonal());
  Vec3 right = axes.forward.cross(up);
  // Tolerance for parallel directions, because camera files have single precision.
  constexpr double kMaxSineOfVertical = 1e-6;
  if (right.norm() < kMaxSineOfVertical * up.norm()) right = Vec3::UnitX();
  axes.right = right.normalized();
  axes.up = axes.right.cross(axes.forward);
  return axes;
}

Mat4 look_along(const Vec3& eye, const ViewAxes& axes) {
  Mat4 view = Mat4::Identity();
  view.block<1, 3>(0, 0) = axes.right.transpose();
  view.block<1, 3>(1, 0) = axes.up.transpose();
  view.block<1, 3>(2, 0) = -axes.forward.transpose();
  view.block<3, 1>(0, 3) = -view.block<3, 3>(0, 0) * eye;
  return view;
}

Mat4 perspective(double tan_half_width, double tan_half_height, double near) {
  Mat4 clip = Mat4::Zero();
  clip(0, 0) = 1 / tan_half_width;
  clip(1, 1) = 1 / tan_half_height;
  clip(2, 3) = near;
  clip(3, 2) = -1;
  return clip;
}

}  // namespace weft::render
