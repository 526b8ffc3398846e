// Where a picture is taken from, and the block of shaders/frame.glsl.
#pragma once

#include "frame/frame_snapshot.hpp"
#include "render/lighting.hpp"
#include "render/transforms.hpp"

namespace weft::render {

/// A plane that carries everything: a point on it and its unit normal, upward.
struct FloorPlane {
  Vec3 point = Vec3::Zero(), normal = Vec3::UnitZ();
};

/// Plane of the first visible infinite floor; false where there is none.
bool find_floor(const frame::FrameSnapshot& snapshot, const Vec3& up, FloorPlane& floor);

/// A camera made ready to draw.
struct View {
  ViewAxes axes;
  Vec3 eye = Vec3::Zero();
  double tan_half_width = 1, tan_half_height = 1;
  double near = 0.1, far = 100;  ///< [m]
  Mat4 view_from_world = Mat4::Identity(), clip_from_world = Mat4::Identity();
};

/// `floor` may be null. The near plane is as far as the subjects and the floor in the picture allow.
View make_view(const frame::Camera& camera, const Vec3& up, double aspect, const Box3& subjects,
               const FloorPlane* floor);

/// Frame block, std140.
struct alignas(16) FrameUniform {
  Eigen::Matrix4f clip_from_world, view_from_world;
  Eigen::Vector4f eye_world, center_world, up_world, right_world;
  Eigen::Vector4f sky_light, ground_light, backdrop, viewport, frustum;
  Eigen::Matrix4f above_from_world, below_from_world;
};

FrameUniform pack_frame(const View& view, const frame::Stage& stage, const Vec3& up, const Box3& subjects, int width,
                        int height);

}  // namespace weft::render
