// The surface points that pixels show. Each coordinate has its own array, so that loops process eight points at once.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "film/render/ray_scene.hpp"
#include "film/render/seen.hpp"
#include "film/render/view.hpp"

namespace weft::render {

/// One channel of a picture: a number per point. Each row has a border at both ends, so that
/// neighbours in the row can be read without a check.
class Plane {
 public:
  static constexpr int kBorder = 8;  ///< number of values before and after each row; as many as Lanes holds

  Plane() = default;
  Plane(int width, int height, float value);
  void fill(float value) { std::ranges::fill(values_, value); }
  float* row(int y) { return values_.data() + start(y); }
  const float* row(int y) const { return values_.data() + start(y); }

 private:
  std::size_t start(int y) const { return static_cast<std::size_t>(y) * stride_ + kBorder; }
  std::size_t stride_ = 0;
  std::vector<float> values_;
};

/// Position, normal and surface of the point at every `divisor`-th pixel.
class PixelPoints {
 public:
  enum class Kind : std::uint8_t { nothing, floor, solid, cloth };

  /// For pictures of width x height pixels, with a point at every `divisor`-th pixel in both directions.
  PixelPoints(int width, int height, int divisor);

  /// Fills in the points. `seen`, `normals`: as read from the geometry buffer. `kinds`: one per surface.
  void read(std::span<const Seen> seen, std::span<const Eigen::Vector4f> normals, std::span<const Kind> kinds,
            const View& view, const std::optional<Floor>& floor);

  int width() const { return width_; }
  int height() const { return height_; }
  int divisor() const { return divisor_; }

  /// Kind of point x of row y. x may be up to Plane::kBorder beyond either end of the row; the result is then
  /// Kind::nothing.
  Kind kind(int x, int y) const { return static_cast<Kind>(static_cast<int>(kinds_.row(y)[x])); }
  /// The next four functions return values of eight points of row y, from x on. kinds(): values of Kind as numbers.
  Lanes kinds(int x, int y) const { return Eigen::Map<const Lanes>(kinds_.row(y) + x); }
  Lanes3 positions(int x, int y) const { return lanes(position_, x, y); }
  Lanes3 normals(int x, int y) const { return lanes(normal_, x, y); }
  /// Height above the drawn triangle, along the normal [m], of the smooth surface that the triangles approximate
  /// (rise() in geometry.frag).
  Lanes rises(int x, int y) const { return Eigen::Map<const Lanes>(rise_.row(y) + x); }

  /// The functions below return a row of values. surfaces(): number as in Seen; -1 beyond the ends of the row.
  const float* surfaces(int y) const { return surface_.row(y); }
  const float* position(int axis, int y) const { return position_[axis].row(y); }
  const float* normal(int axis, int y) const { return normal_[axis].row(y); }
  /// Points per metre [1/m] at the distance of each point, measured perpendicular to the view axis.
  const float* densities(int y) const { return density_.row(y); }

 private:
  static Lanes3 lanes(const std::array<Plane, 3>& planes, int x, int y) {
    const auto of = [&](int axis) { return Lanes(Eigen::Map<const Lanes>(planes[axis].row(y) + x)); };
    return {of(0), of(1), of(2)};
  }

  int picture_width_, picture_height_, divisor_, width_, height_;
  std::array<Plane, 3> position_, normal_;
  Plane rise_, surface_, kinds_, density_;
};

}  // namespace weft::render
