#include "film/render/smear.hpp"

#include <algorithm>
#include <cmath>

#include "film/render/depth_raster.hpp"
#include "film/render/drawing_time.hpp"
#include "film/render/framing.hpp"

namespace weft::render {
namespace {

constexpr int kTile = 8;  // side of the tiles of dilate_motions() [pixels]
// Maximum length of a motion [pixels]; longer motions are shortened. A smear extends by half of the motion to each
// side, thus by at most one tile.
constexpr float kMaxMotion = 2 * kTile;
// Minimum length of a motion that is smeared [pixels]; a shorter smear would be no wider than an antialiased edge.
constexpr float kMinMotion = 1.2f;

/// Position in the picture [pixels], from the lower left corner; z: 1 / distance [1/m]. All are 0 if `position` is
/// nearer than the near plane.
Eigen::Vector3f to_pixels(const View& view, const Vec3& position, int width, int height) {
  const Eigen::Vector4d clip = view.clip_from_world * position.homogeneous();
  if (clip.w() < view.near) return Eigen::Vector3f::Zero();
  return place_in_picture(clip, width, height).cast<float>();
}

/// Motion of the point of the floor that the picture of `view` shows at (x, y), between two other views; all is 0 if no
/// floor is visible there.
PixelMotion floor_motion(const Floor& floor, const View& view, double x, double y, const View& from_view,
                         const View& to_view, int width, int height) {
  const Vec3 ray = pixel_ray(view, x, y, width, height);
  const double height_of_eye = floor.normal.dot(view.eye - floor.point), fall = -floor.normal.dot(ray);
  if (height_of_eye <= 0 || fall <= 0) return {};
  const Vec3 point = view.eye + height_of_eye / fall * ray;
  const Eigen::Vector3f start = to_pixels(from_view, point, width, height),
                        end = to_pixels(to_view, point, width, height);
  if (start.z() <= 0 || end.z() <= 0) return {};
  return {(end - start).head<2>(), static_cast<float>(fall / height_of_eye)};
}

/// Largest motion [pixels] of 9 x 9 points of the floor, among them those at the corners of the picture.
float longest_floor_motion(const Floor& floor, const View& view, const View& from_view, const View& to_view, int width,
                           int height) {
  constexpr int kSteps = 8;
  float longest = 0;
  for (int i = 0; i <= kSteps; ++i)
    for (int j = 0; j <= kSteps; ++j)
      longest = std::max(longest, floor_motion(floor, view, 1.0 * width * i / kSteps, 1.0 * height * j / kSteps,
                                               from_view, to_view, width, height)
                                      .motion.norm());
  return longest;
}

}  // namespace

double longest_motion(const frame::FrameSnapshot& from, const View& from_view, const frame::FrameSnapshot& to,
                      const View& to_view, const std::optional<Floor>& floor, int width, int height) {
  float longest = floor ? longest_floor_motion(*floor, to_view, from_view, to_view, width, height) : 0;
  for (std::size_t i = 0; i < to.surfaces.size(); ++i) {
    if (!is_subject(*to.surfaces[i])) continue;
    const auto& ends = to.states[i].positions;
    const std::vector<Vec3>* starts = find_positions(from, *to.surfaces[i], ends.size());
    if (starts == nullptr) continue;
    for (std::size_t v = 0; v < ends.size(); ++v) {
      const Eigen::Vector3f start = to_pixels(from_view, (*starts)[v], width, height),
                            end = to_pixels(to_view, ends[v], width, height);
      const bool seen = start.z() > 0 && end.z() > 0 && end.x() >= 0 && end.y() >= 0 &&
                        end.x() <= static_cast<float>(width) && end.y() <= static_cast<float>(height);
      if (seen) longest = std::max(longest, (end - start).head<2>().norm());
    }
  }
  return longest;
}

void Smear::find_motions(std::span<const SurfaceBuffers> surfaces, const View& view, const frame::FrameSnapshot& from,
                         const View& from_view, const frame::FrameSnapshot& to, const View& to_view) {
  motions_.assign(static_cast<std::size_t>(width_) * height_, {});
  std::vector<Eigen::Vector3f> places;
  std::vector<Eigen::Vector2f> motions;
  for (const SurfaceBuffers& drawn : surfaces) {
    const std::size_t count = drawn.state().positions.size();
    const std::vector<Vec3>*starts = find_positions(from, drawn.surface(), count),
          *ends = find_positions(to, drawn.surface(), count);
    const auto& mesh = drawn.mesh();
    places.clear();
    motions.clear();
    for (std::size_t i = 0; i < mesh.source.size(); ++i) {
      const Index vertex = mesh.source[i];
      places.push_back(to_pixels(view, drawn.positions()[i], width_, height_));
      motions.emplace_back(Eigen::Vector2f::Zero());
      if (starts == nullptr || ends == nullptr) continue;
      const Eigen::Vector3f start = to_pixels(from_view, (*starts)[vertex], width_, height_),
                            end = to_pixels(to_view, (*ends)[vertex], width_, height_);
      if (start.z() > 0 && end.z() > 0) motions.back() = (end - start).head<2>();
      const float length = motions.back().norm();
      if (length > kMaxMotion) motions.back() *= kMaxMotion / length;
    }
    for (const auto& [a, b, c] : mesh.triangles) {
      if (places[a].z() <= 0 || places[b].z() <= 0 || places[c].z() <= 0) continue;
      const Eigen::Vector2f &first = motions[a], along = motions[b] - first, across = motions[c] - first;
      fill_triangle(places[a], places[b], places[c], width_, height_,
                    [&](int at, bool covered, float nearness, float to_b, float to_c) {
                      if (covered && nearness > motions_[at].nearness)
                        motions_[at] = {first + to_b * along + to_c * across, nearness};
                    });
    }
  }
}

/// Adds the motion of the floor where it is visible. The motion is that of the camera.
void Smear::find_floor_motions(const Floor& floor, const View& view, const View& from_view, const View& to_view) {
  if (longest_floor_motion(floor, view, from_view, to_view, width_, height_) < kMinMotion) return;
  drawing_rows(height_, [&](int y) {
    for (int x = 0; x < width_; ++x) {
      PixelMotion& pixel = motions_[static_cast<std::size_t>(y) * width_ + x];
      PixelMotion found = floor_motion(floor, view, x + 0.5, y + 0.5, from_view, to_view, width_, height_);
      const float length = found.motion.norm();
      if (length < kMinMotion || found.nearness <= pixel.nearness) continue;
      if (length > kMaxMotion) found.motion *= kMaxMotion / length;
      pixel = found;
    }
  });
}

/// Stores for each tile the longest motion in this tile and its eight neighbours. If this motion is
/// below kMinMotion, the pixels of the tile stay sharp.
void Smear::dilate_motions() {
  const int columns = (width_ + kTile - 1) / kTile, rows = (height_ + kTile - 1) / kTile;
  std::vector<Eigen::Vector2f> tiles(static_cast<std::size_t>(columns) * rows, Eigen::Vector2f::Zero());
  const auto take = [](Eigen::Vector2f& longest, const Eigen::Vector2f& motion) {
    if (motion.squaredNorm() > longest.squaredNorm()) longest = motion;
  };
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x)
      take(tiles[static_cast<std::size_t>(y / kTile) * columns + x / kTile],
           motions_[static_cast<std::size_t>(y) * width_ + x].motion);
  dilated_motions_ = tiles;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column)
      for (int other = std::max(row - 1, 0); other <= std::min(row + 1, rows - 1); ++other)
        for (int beside = std::max(column - 1, 0); beside <= std::min(column + 1, columns - 1); ++beside)
          take(dilated_motions_[static_cast<std::size_t>(row) * columns + column],
               tiles[static_cast<std::size_t>(other) * columns + beside]);
}

/// Averages samples along a motion through pixel (x, y), after McGuire et al., "A Reconstruction Filter for Plausible
/// Motion Blur", 2012. Each sample compares the surface at its own position with the surface at the pixel. If the
/// nearer of the two moves at least as far as the distance between sample and pixel, the sample has the colour at its
/// own position: either the surface at the sample crosses the pixel, or that at the pixel uncovers the sample.
/// Otherwise, the sample has the colour of the pixel.
Eigen::Vector3f Smear::smear_pixel(int x, int y, const Eigen::Vector2f& motion,
                                   std::span<const Eigen::Vector3f> sharp) const {
  const std::size_t here = static_cast<std::size_t>(y) * width_ + x;
  const float length = motion.norm(), own = 0.5f * motions_[here].motion.norm();
  // Samples are at most one pixel apart. The middle one is at (x, y).
  const int taps = 2 * static_cast<int>(std::ceil(0.5f * length)) + 1;
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (int k = 0; k < taps; ++k) {
    const float t = (static_cast<float>(k) + 0.5f) / static_cast<float>(taps) - 0.5f;
    const int to_x = std::clamp(static_cast<int>(std::lround(static_cast<float>(x) + t * motion.x())), 0, width_ - 1),
              to_y = std::clamp(static_cast<int>(std::lround(static_cast<float>(y) + t * motion.y())), 0, height_ - 1);
    const std::size_t there = static_cast<std::size_t>(to_y) * width_ + to_x;
    // `extent`: distance that the nearer surface moves to either side [pixels]; of the faster surface if both are
    // equally near. `weight`: that of the colour at the sample; it falls from 1 to 0 over one pixel around `extent`.
    constexpr float kSame = 1.01f;
    const float distance = std::abs(t) * length, other = 0.5f * motions_[there].motion.norm();
    const bool before = motions_[there].nearness > kSame * motions_[here].nearness,
               behind = motions_[here].nearness > kSame * motions_[there].nearness;
    const float extent = before ? other : behind ? own : std::max(own, other);
    const float weight = std::clamp(extent - distance + 0.5f, 0.0f, 1.0f);
    sum += weight * sharp[there] + (1 - weight) * sharp[here];
  }
  return sum / static_cast<float>(taps);
}

void Smear::add(std::span<const SurfaceBuffers> surfaces, const std::optional<Floor>& floor, const View& view,
                const frame::FrameSnapshot& from, const View& from_view, const frame::FrameSnapshot& to,
                const View& to_view, std::span<const Eigen::Vector3f> sharp, std::vector<Eigen::Vector3f>& sum) {
  find_motions(surfaces, view, from, from_view, to, to_view);
  if (floor) find_floor_motions(*floor, view, from_view, to_view);
  dilate_motions();
  const int columns = (width_ + kTile - 1) / kTile;
  drawing_rows(height_, [&](int y) {
    for (int x = 0; x < width_; ++x) {
      const std::size_t at = static_cast<std::size_t>(y) * width_ + x;
      const Eigen::Vector2f& motion = dilated_motions_[static_cast<std::size_t>(y / kTile) * columns + x / kTile];
      sum[at] += motion.norm() < kMinMotion ? sharp[at] : smear_pixel(x, y, motion, sharp);
    }
  });
}

}  // namespace weft::render
