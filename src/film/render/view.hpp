// Viewpoint of a picture, exposure, and the frame block of shaders/frame.glsl.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "film/frame/frame_snapshot.hpp"
#include "film/render/lighting.hpp"
#include "film/render/surroundings.hpp"
#include "film/render/transforms.hpp"

namespace weft::render {

/// The ground: a point on it, its unit normal (upward) and its appearance.
struct Floor {
  Vec3 point = Vec3::Zero(), normal = Vec3::UnitZ();
  frame::Appearance look;
  /// Maps world (x, y, z, 1) to coordinates of the appearance's picture, if there is one.
  Eigen::Matrix<double, 2, 4> picture_from_world = Eigen::Matrix<double, 2, 4>::Zero();
};

/// The first visible infinite floor, if there is one. `plain`: in the colour of clay.
std::optional<Floor> find_floor(const frame::FrameSnapshot& snapshot, const Vec3& up, bool plain = false);

/// A camera with its matrices.
struct View {
  ViewAxes axes;
  Vec3 eye = Vec3::Zero();
  double tan_half_width = 1, tan_half_height = 1;
  double near = 0.1, far = 100;  ///< [m]
  Mat4 view_from_world = Mat4::Identity(), clip_from_world = Mat4::Identity();
};

/// The view of a camera. `aspect`: width / height of the picture. The distance of the near plane is 0.8 times the
/// smaller of two distances along the view axis: that of the sphere around `subjects`, and a lower bound on that of
/// visible floor. But it is at least 1 cm or, if this is smaller, 1/1000 of the distance of the far side of the sphere.
View make_view(const frame::Camera& camera, const Vec3& up, double aspect, const Box3& subjects,
               const std::optional<Floor>& floor);

/// Direction of the ray through the place (x, y) of a picture of width x height pixels, counted from the lower left
/// corner. Its component along the view axis is 1 m.
inline Vec3 pixel_ray(const View& view, double x, double y, int width, int height) {
  return view.axes.forward + (2 * x / width - 1) * view.tan_half_width * view.axes.right +
         (2 * y / height - 1) * view.tan_half_height * view.axes.up;
}

/// Place in a picture of width x height pixels of the point with these clip coordinates: x and y from the lower left
/// corner [pixels], z: 1 / distance along the view axis [1/m].
inline Vec3 place_in_picture(const Eigen::Vector4d& clip, int width, int height) {
  return {(0.5 + 0.5 * clip.x() / clip.w()) * width, (0.5 + 0.5 * clip.y() / clip.w()) * height, 1 / clip.w()};
}

/// A rectangle of pixels; x and y are counted from the lower left corner of the picture.
struct PixelArea {
  int x = 0, y = 0, width = 0, height = 0;
};

/// Smallest area that contains the points in view, with a margin of one pixel; the whole picture if a point is nearer
/// than the near plane; empty without points.
PixelArea visible_area(const View& view, std::span<const Vec3> points, int width, int height);

/// Whether the floor fades into the backdrop (fade_out() in shaders/open_floor.glsl) within so few pixels that colours
/// cannot be interpolated over `cell` pixels. This is so if distant floor is in view and the eye is low compared with
/// the size of `surroundings`. `height`: height of the picture [pixels].
bool fades_steeply(const View& view, const std::optional<Floor>& floor, const Box3& surroundings, int height, int cell);

/// The frame block of shaders/frame.glsl, in the layout std140.
struct FrameUniform {
  // The matrices come first, because Eigen aligns them to 16 or 32 bytes, depending on the instruction set. std140
  // aligns to 16 bytes.
  Eigen::Matrix4f clip_from_world, view_from_world;
  Eigen::Vector4f eye_world, center_world, up_world, right_world;
  Eigen::Vector4f sky, horizon, ground, backdrop, backdrop_top, viewport, frustum, floor_plane_world, floor_look;
  std::array<Eigen::Vector4f, Surroundings::kBoxes> box_axes, box_lights;
  std::array<Eigen::Vector4f, 9> irradiance;
};
static_assert(offsetof(FrameUniform, eye_world) == 2 * 64 && offsetof(FrameUniform, box_axes) == 2 * 64 + 13 * 16);

/// Strength of the direct light, and colour of open floor (floor without shadows or occlusion).
struct Exposure {
  Vec3 direct = Vec3::Ones();  ///< factor on every light for each channel
  Vec3 floor = Vec3::Zero();   ///< linear colour of open floor; without a floor, 0.8 times Style::sky_color
};

/// Exposes for the floor, as product photographers do for a white ground: if open floor is darker than its own colour,
/// increases direct light. A white balance then changes each channel slightly, so that a white floor stays white under
/// a bluish sky or coloured light. Both changes are limited, so that dark or coloured scenes stay dark or coloured.
/// Without a floor, or if Style::exposes is false, Exposure::direct is 1 - Style::sky_intensity.
Exposure expose(const Style& style, const std::optional<Floor>& floor, std::span<const frame::Light> lights);

/// Style, environment and exposure of a picture.
struct Lighting {
  Style style;
  Surroundings around;
  Exposure exposure;
  double gain = 1;  ///< factor on all light
};
Lighting make_lighting(const frame::Stage& stage, const Vec3& up, const std::optional<Floor>& floor,
                       std::span<const frame::Light> lights);

/// Roughness of the floor, from its appearance and from the style; 1 without a floor. Below
/// kLampMirrorRoughness, the floor has highlights of lamps. Below kSubjectMirrorRoughness, it
/// reflects the subjects if QualitySettings::mirrors is set.
double floor_roughness(const Style& style, const std::optional<Floor>& floor);
inline constexpr double kLampMirrorRoughness = 0.6, kSubjectMirrorRoughness = 0.5;

/// The frame block of a picture of width x height pixels. `scene_bounds`: surroundings_bounds() of
/// the run.
FrameUniform pack_frame(const View& view, const Lighting& lighting, const Box3& scene_bounds,
                        const std::optional<Floor>& floor, int width, int height);

}  // namespace weft::render
