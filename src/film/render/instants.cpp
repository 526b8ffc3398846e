#include "film/render/instants.hpp"

#include <cmath>
#include <numbers>

#include "film/render/transforms.hpp"

namespace weft::render {
namespace {

constexpr double kFilmHeight = 0.024;  // height of 35 mm film [m]: relates field of view and focal length

template <class Value>
Value mix(const Value& now, const Value& before, double back) {
  return (1 - back) * now + back * before;
}

}  // namespace

std::vector<Instant> make_instants(double shutter, bool lens, int count) {
  std::vector<Instant> list;
  if (shutter <= 0 && !lens) return list;
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  for (int k = 0; k < count; ++k) {
    Instant instant;
    instant.back = shutter / 360 * (k + 0.5) / count;
    // Spreads the points evenly over the disc (Vogel 1979). The factor 5 changes their order, so that position on the
    // lens and time do not correlate. Each point occurs once, because `count` is not a multiple of 5.
    const int place = 5 * k % count;
    if (lens)
      instant.lens = std::sqrt((place + 0.5) / count) * Vec2(std::cos(golden * place), std::sin(golden * place));
    list.push_back(instant);
  }
  return list;
}

frame::Camera interpolate_cameras(const frame::Camera& now, const frame::Camera& before, double back) {
  if (now.shot != before.shot) return now;
  frame::Camera camera = now;
  camera.position = mix(now.position, before.position, back);
  camera.target = mix(now.target, before.target, back);
  camera.field_of_view = mix(now.field_of_view, before.field_of_view, back);
  return camera;
}

frame::FrameSnapshot interpolate_frames(const frame::FrameSnapshot& now, const frame::FrameSnapshot& before,
                                        double back) {
  frame::FrameSnapshot mixed = now;
  mixed.time = mix(now.time, before.time, back);
  for (std::size_t i = 0; i < now.states.size() && i < before.states.size(); ++i) {
    const auto& were = before.states[i].positions;
    auto& positions = mixed.states[i].positions;
    if (now.surfaces[i]->name != before.surfaces[i]->name || were.size() != positions.size() || were == positions)
      continue;
    for (std::size_t v = 0; v < were.size(); ++v) positions[v] = mix(positions[v], were[v], back);
  }
  for (std::size_t i = 0; i < now.lights.size() && i < before.lights.size(); ++i) {
    frame::Light& light = mixed.lights[i];
    const frame::Light& was = before.lights[i];
    light.direction = mix(light.direction, was.direction, back);
    light.position = mix(light.position, was.position, back);
    light.target = mix(light.target, was.target, back);
    light.intensity = mix(light.intensity, was.intensity, back);
  }
  return mixed;
}

frame::Camera through_lens(const frame::Camera& camera, const Vec3& up, const Vec2& lens) {
  if (camera.aperture <= 0) return camera;
  const Vec3 along = camera.target - camera.position;
  const ViewAxes axes = view_axes(along, up);
  const double focus = camera.focus > 0 ? camera.focus : along.norm();
  const double focal_length = 0.5 * kFilmHeight / std::tan(radians(camera.field_of_view) / 2);
  const Vec2 place = focal_length / (2 * camera.aperture) * lens;
  frame::Camera moved = camera;
  moved.target = camera.position + focus * axes.forward;
  moved.position += place.x() * axes.right + place.y() * axes.up;
  return moved;
}

}  // namespace weft::render
