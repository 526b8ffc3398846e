#include "tools/cli/start_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <span>

#include "film/render/framing.hpp"
#include "film/render/saliency.hpp"
#include "film/render/view.hpp"

namespace weft::cli {
namespace {

using simulation::IntersectionPlace;

// Maximum number of close-ups.
constexpr std::size_t kCloseUps = 5;
constexpr double kCloseUpAngle = 30;  // vertical field of view [degrees]
// Height of the region that a close-up shows: minimum [m], in scenes of less than 1 m this fraction of their diagonal;
// and ratio to the size of the place.
constexpr double kMinCloseUpHeight = 0.1, kCloseUpHeightRatio = 1.6;
// A later camera replaces an earlier one only if its visible_fraction() is more than this times as large.
constexpr double kMinVisibilityGain = 1.25;
constexpr double kMarkWidth = 1.5 / 360;  // width of the outline, as a fraction of the picture height
constexpr std::array<std::uint8_t, 3> kMark{225, 20, 40};

Vec3 up_of(const frame::FrameSnapshot& snapshot) {
  return snapshot.stage ? snapshot.stage->up : Vec3::UnitZ();
}

// Fraction of the picture that shows the triangles of a place. saliency_of() measures how much
// cloth is visible, so only these triangles are marked as cloth. These triangles are drawn first,
// so that they hide the original surface, which has the same depth.
double visible_fraction(const frame::FrameSnapshot& snapshot, const IntersectionPlace& place,
                        const frame::Camera& camera, double aspect) {
  auto marks = std::make_shared<frame::Surface>();
  std::vector<Vec3> corners;
  for (const auto& triangle : place.triangles) {
    const auto first = static_cast<Index>(corners.size());
    marks->triangles.push_back({first, first + 1, first + 2});
    corners.insert(corners.end(), triangle.begin(), triangle.end());
  }
  frame::FrameSnapshot marked = snapshot;
  marked.cameras = {camera};
  for (auto& surface : marked.surfaces) {
    auto copy = std::make_shared<frame::Surface>(*surface);
    copy->kind = frame::ObjectKind::obstacle;
    copy->infinite_floor = false;  // an infinite floor would hide what is below it
    surface = copy;
  }
  marked.surfaces.insert(marked.surfaces.begin(), std::move(marks));
  marked.states.insert(marked.states.begin(), frame::SurfaceState{std::move(corners), {}});
  return render::saliency_of(marked, nullptr, 0, "", aspect).coverage;
}

// Tries 32 cameras around a place, and returns the one that shows most of it. The factor kMinVisibilityGain prefers the
// first cameras, which view the place from the front and from above.
frame::Camera find_close_up_camera(const frame::FrameSnapshot& snapshot, const IntersectionPlace& place,
                                   double aspect) {
  const Vec3 up = up_of(snapshot), right = Vec3::UnitX(), front = right.cross(up);
  const double least = kMinCloseUpHeight * std::min(1.0, render::subject_bounds(snapshot).diagonal().norm());
  const double height = std::max(least, kCloseUpHeightRatio * place.size);
  const double distance = 0.5 * height / std::tan(kCloseUpAngle * std::numbers::pi / 360) + 0.5 * place.size;
  frame::Camera best;
  double best_fraction = -1;
  for (const double rise : {0.5, 1.0, 0.0, -0.5}) {
    for (int turn = 0; turn < 8; ++turn) {
      const double angle = turn * std::numbers::pi / 4;
      const Vec3 level = std::cos(angle) * front + std::sin(angle) * right;
      frame::Camera camera;
      camera.position = place.centre + distance * (std::cos(rise) * level + std::sin(rise) * up);
      camera.target = place.centre;
      camera.field_of_view = kCloseUpAngle;
      const double seen = visible_fraction(snapshot, place, camera, aspect);
      if (seen > kMinVisibilityGain * best_fraction) {
        best_fraction = seen;
        best = camera;
      }
    }
  }
  return best;
}

void draw_line(image::Image& image, const Vec2& from, const Vec2& to, int width) {
  // Skips very long lines, which end far outside the picture.
  const double length = (to - from).norm();
  if (!(length < 4.0 * (image.width + image.height))) return;
  const int steps = std::max(1, static_cast<int>(std::ceil(length)));
  for (int s = 0; s <= steps; ++s) {
    const Vec2 at = from + (to - from) * s / steps;
    for (int dy = 0; dy < width; ++dy) {
      for (int dx = 0; dx < width; ++dx) {
        const int x = static_cast<int>(at.x()) + dx, y = static_cast<int>(at.y()) + dy;
        if (x >= 0 && y >= 0 && x < image.width && y < image.height) std::ranges::copy(kMark, image.pixel(x, y));
      }
    }
  }
}

void outline(image::Image& image, const frame::FrameSnapshot& snapshot, const frame::Camera& camera,
             std::span<const IntersectionPlace> places) {
  const Vec3 up = up_of(snapshot);
  const double aspect = static_cast<double>(image.width) / image.height;
  const render::View view =
      render::make_view(camera, up, aspect, render::subject_bounds(snapshot), render::find_floor(snapshot, up));
  const int width = std::max(1, static_cast<int>(std::lround(kMarkWidth * image.height)));
  for (const IntersectionPlace& place : places) {
    for (const auto& triangle : place.triangles) {
      std::array<Eigen::Vector4d, 3> clip;
      for (std::size_t c = 0; c < 3; ++c) clip[c] = view.clip_from_world * triangle[c].homogeneous();
      const auto behind = [&](const Eigen::Vector4d& corner) { return corner.w() < view.near; };
      if (std::ranges::any_of(clip, behind)) continue;
      const auto pixel = [&](const Eigen::Vector4d& corner) {
        return Vec2((0.5 + 0.5 * corner.x() / corner.w()) * image.width,
                    (0.5 - 0.5 * corner.y() / corner.w()) * image.height);
      };
      for (std::size_t c = 0; c < 3; ++c) draw_line(image, pixel(clip[c]), pixel(clip[(c + 1) % 3]), width);
    }
  }
}

}  // namespace

std::vector<image::SheetPicture> draw_start(const production::StartView& start, const render::Settings& settings,
                                            FramePainter& painter) {
  const frame::FrameSnapshot& snapshot = *start.snapshot;
  const double aspect = settings.aspect();
  std::vector<image::SheetPicture> pictures;
  const auto add = [&](const frame::Camera& camera, std::string left, std::string right) {
    frame::FrameSnapshot copy = snapshot;
    copy.cameras = {camera};
    pictures.push_back({painter.draw(copy, nullptr).image, std::move(left), std::move(right)});
    outline(pictures.back().image, snapshot, camera, start.places);
  };
  add(render::camera_of(snapshot, settings.camera, aspect), "the start", "");
  for (std::size_t p = 0; p < std::min(start.places.size(), kCloseUps); ++p) {
    const IntersectionPlace& place = start.places[p];
    add(find_close_up_camera(snapshot, place, aspect),
        place.a == place.b ? place.a + " itself" : place.a + " and " + place.b,
        fmt::format("{} pair{}, {:.3g} m across", place.pairs, place.pairs == 1 ? "" : "s", place.size));
  }
  return pictures;
}

}  // namespace weft::cli
