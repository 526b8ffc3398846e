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
  drawing_for(static_cast<std::size_t>(height_), std::size_t{16}, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      const int v = std::min(y * divisor_ + divisor_ / 2, picture_height_ - 1);
      const float high = half.y() * (2 * (static_cast<float>(v) + 0.5f) / static_cast<float>(picture_height_) - 1);
      for (int x = 0; x < width_; ++x) {
        const int u = std::min(x * divisor_ + divisor_ / 2, picture_width_ - 1);
        const std::size_t at = static_cast<std::size_t>(v) * picture_width_ + static_cast<std::size_t>(u);
        const float across = half.x() * (2 * (static_cast<float>(u) + 0.5f) / static_cast<float>(picture_width_) - 1);
        const Eigen::Vector3f position =
            eye + seen[at].distance * (world_from_view * Eigen::Vector3f(across, high, -1));
        const int number = static_cast<int>(std::floor(seen[at].surface));
        Kind kind = Kind::nothing;
        Eigen::Vector3f normal = up;
        float rise = 0;
        if (number == kFloor) {
          kind = Kind::floor;
        } else if (number >= kFirstSurface) {
          kind = kinds[static_cast<std::size_t>(number - kFirstSurface)];
          const float length = normals[at].head<3>().norm();
          normal = normals[at].head<3>() / length;
          rise = length - 1;
        }
        for (int axis = 0; axis < 3; ++axis) {
          position_[axis].row(y)[x] = position[axis];
          normal_[axis].row(y)[x] = normal[axis];
        }
        rise_.row(y)[x] = rise;
        density_.row(y)[x] = per_metre / seen[at].distance;
        surface_.row(y)[x] = seen[at].surface;
        kinds_.row(y)[x] = static_cast<float>(kind);
      }
    }
  });
}

}  // namespace weft::render
