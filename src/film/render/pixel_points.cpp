#include "film/render/pixel_points.hpp"

#include <algorithm>
#include <cmath>

#include "film/render/drawing_time.hpp"

namespace weft::render {

Plane::Plane(int width, int height, float value)
    : stride_(static_cast<std::size_t>((width + kLanes - 1) / kLanes * kLanes + 2 * kBorder)),
      values_(stride_ * static_cast<std::size_t>(height), value) {}

PixelPoints::PixelPoints(int width, int height, int divisor)
    : picture_width_(width),
      picture_height_(height),
      divisor_(divisor),
      width_((width + divisor - 1) / divisor),
      height_((height + divisor - 1) / divisor) {
  for (int axis = 0; axis < 3; ++axis) position_[axis] = normal_[axis] = Plane(width_, height_, 0);
  rise_ = density_ = Plane(width_, height_, 0);
  surface_ = Plane(width_, height_, -1);
  kinds_ = Plane(width_, height_, static_cast<float>(Kind::nothing));
}

void PixelPoints::read(std::span<const Seen> seen, std::span<const Eigen::Vector4f> normals,
                       std::span<const Kind> kinds, const View& view, const std::optional<Floor>& floor) {
  const Eigen::Matrix3f world_from_view = view.view_from_world.block<3, 3>(0, 0).transpose().cast<float>();
  const Eigen::Vector3f eye = view.eye.cast<float>();
  const Eigen::Vector3f up = floor ? Eigen::Vector3f(floor->normal.cast<float>()) : Eigen::Vector3f::UnitZ();
  const Eigen::Vector2f half(static_cast<float>(view.tan_half_width), static_cast<float>(view.tan_half_height));
  const float per_metre = static_cast<float>(picture_height_) / (2 * half.y() * static_cast<float>(divisor_));
  // Per column of points: the column of pixels, and the tangent of its horizontal angle to the view axis.
  std::vector<int> pixel(static_cast<std::size_t>(width_));
  std::vector<float> across(pixel.size());
  for (std::size_t x = 0; x < pixel.size(); ++x) {
    pixel[x] = std::min(static_cast<int>(x) * divisor_ + divisor_ / 2, picture_width_ - 1);
    across[x] = half.x() * (2 * (static_cast<float>(pixel[x]) + 0.5f) / static_cast<float>(picture_width_) - 1);
  }
  drawing_for(static_cast<std::size_t>(height_), std::size_t{16}, [&](std::size_t begin, std::size_t end) {
    std::vector<float> distance(across.size());
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      const int v = std::min(y * divisor_ + divisor_ / 2, picture_height_ - 1);
      const float high = half.y() * (2 * (static_cast<float>(v) + 0.5f) / static_cast<float>(picture_height_) - 1);
      const std::size_t row = static_cast<std::size_t>(v) * static_cast<std::size_t>(picture_width_);
      const Seen* const seen_row = seen.data() + row;
      float* const surface = surface_.row(y);
      for (int x = 0; x < width_; ++x) {
        distance[x] = seen_row[pixel[x]].distance;
        surface[x] = seen_row[pixel[x]].surface;
      }
      // Each loop writes one array, so that the compiler vectorises it.
      float* const density = density_.row(y);
      for (int x = 0; x < width_; ++x) density[x] = per_metre / distance[x];
      for (int axis = 0; axis < 3; ++axis) {
        const float from = eye[axis], right = world_from_view(axis, 0), above = world_from_view(axis, 1) * high,
                    ahead = -world_from_view(axis, 2);
        float* const position = position_[axis].row(y);
        for (int x = 0; x < width_; ++x) position[x] = from + distance[x] * (right * across[x] + above + ahead);
        std::fill_n(normal_[axis].row(y), width_, up[axis]);
      }
      float *const rise = rise_.row(y), *const kind = kinds_.row(y);
      for (int x = 0; x < width_; ++x) {
        const int number = static_cast<int>(std::floor(surface[x]));
        rise[x] = 0;
        kind[x] = static_cast<float>(number == kFloor ? Kind::floor : Kind::nothing);
        if (number < kFirstSurface) continue;
        kind[x] = static_cast<float>(kinds[static_cast<std::size_t>(number - kFirstSurface)]);
        const auto normal = normals[row + static_cast<std::size_t>(pixel[x])].head<3>();
        const float length = normal.norm();
        for (int axis = 0; axis < 3; ++axis) normal_[axis].row(y)[x] = normal[axis] / length;
        rise[x] = length - 1;
      }
    }
  });
}

}  // namespace weft::render
