// Where a picture is taken from, and the block of shaders/frame.glsl.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "frame/frame_snapshot.hpp"
#include "render/lighting.hpp"
#include "render/surroundings.hpp"
#include "render/transforms.hpp"

namespace weft::render {

/// The ground: a point on it, its unit normal, upward, and its looks.
struct Floor {
  Vec3 point = Vec3::Zero(), normal = Vec3::UnitZ();
  frame::Appearance look;
  /// From (x, y, z, 1) in the world to the picture of its look; where it has none, nothing.
  Eigen::Matrix<double, 2, 4> picture_from_world = Eigen::Matrix<double, 2, 4>::Zero();
};

/// The first visible infinite floor, where there is one.
std::optional<Floor> find_floor(const frame::FrameSnapshot& snapshot, const Vec3& up);

/// A camera made ready to draw.
struct View {
  ViewAxes axes;
  Vec3 eye = Vec3::Zero();
  double tan_half_width = 1, tan_half_height = 1;
  double near = 0.1, far = 100;  ///< [m]
  Mat4 view_from_world = Mat4::Identity(), clip_from_world = Mat4::Identity();
};

/// The near plane is as far as the subjects and the floor in the picture allow.
View make_view(const frame::Camera& camera, const Vec3& up, double aspect, const Box3& subjects,
               const std::optional<Floor>& floor);

/// A rectangle of pixels, counted from the lower left.
struct PixelArea {
  int x = 0, y = 0, width = 0, height = 0;
};

/// Smallest area that holds what the view shows of the points, and a pixel more on each side; all of the picture where
/// one of them is not in front of the viewer.
PixelArea visible_area(const View& view, std::span<const Vec3> points, int width, int height);

/// Frame block, std140.
struct FrameUniform {
  // Matrices first: Eigen aligns them to 16 or 32 bytes, as the CPU level has it, std140 to 16.
  Eigen::Matrix4f clip_from_world, view_from_world, above_from_world;
  Eigen::Vector4f eye_world, center_world, up_world, right_world;
  Eigen::Vector4f sky, horizon, ground, backdrop, backdrop_top, viewport, frustum, floor_plane_world, floor_look;
  std::array<Eigen::Vector4f, Surroundings::kBoxes> box_axes, box_lights;
  std::array<Eigen::Vector4f, 9> irradiance;
};
static_assert(offsetof(FrameUniform, eye_world) == 3 * 64 && offsetof(FrameUniform, box_axes) == 3 * 64 + 13 * 16);

/// How far the sky occlusion looks for things overhead [m].
double sky_reach(const Box3& subjects);

/// How strong the light is, and what the studio looks like in it.
struct Exposure {
  Vec3 direct = Vec3::Ones();  ///< scales every light, for each channel
  Vec3 floor = Vec3::Zero();   ///< linear colour that open floor shows; without one, of light from around
};

/// Exposes for the floor, as for a product on white: direct light is turned up, never down, until open floor shows its
/// own colour, and warmed against a bluish sky. Darkness and hues beyond a slight tint are left to the scene, as is all
/// without a floor or where the style does not expose. Lights are those of the picture.
Exposure expose(const Style& style, const std::optional<Floor>& floor, std::span<const frame::Light> lights);

/// What lights a picture and how it is shown.
struct Lighting {
  Style style;
  Surroundings around;
  Exposure exposure;
  double gain = 1;  ///< factor on all light
};
Lighting light_up(const frame::Stage& stage, const Vec3& up, const std::optional<Floor>& floor,
                  std::span<const frame::Light> lights);

/// Roughness of the floor, by its own look and that of the picture; 1 where there is none. Floors that shine more than
/// those of scenes that do not say so mirror lamps, and those that shine still more the subjects.
double floor_roughness(const Style& style, const std::optional<Floor>& floor);
inline constexpr double kMirrorsLamps = 0.6, kMirrorsSubjects = 0.5;

/// `surroundings`: of the run (surroundings_bounds()).
FrameUniform pack_frame(const View& view, const Lighting& lighting, const Box3& subjects, const Box3& surroundings,
                        const std::optional<Floor>& floor, int width, int height);

}  // namespace weft::render
