#include "film/render/edges.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace weft::render {
namespace {

constexpr double kLineOpacity = 0.62;  // fraction by which a line reduces sRGB values
// An edge is hidden if it is farther from the eye than the visible surface by more than this
// fraction of its own distance.
constexpr double kDepthTolerance = 4e-3;

std::vector<std::pair<Index, Index>> edges_of(const frame::Surface& surface) {
  std::vector<std::pair<Index, Index>> edges;
  const auto add = [&](const auto& faces) {
    for (const auto& face : faces)
      for (std::size_t k = 0; k < face.size(); ++k) edges.push_back(std::minmax(face[k], face[(k + 1) % face.size()]));
  };
  surface.quads.empty() ? add(surface.triangles) : add(surface.quads);
  std::ranges::sort(edges);
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

/// Draws antialiased lines into a picture (Wu, "An Efficient Antialiasing Technique", 1991).
class Canvas {
 public:
  Canvas(int width, int height, std::span<const Seen> seen, std::span<std::uint64_t> picture)
      : width_(width), height_(height), seen_(seen), picture_(picture) {}

  /// Darkens the pixels along the line between two places (place_in_picture()) that show the surface with the number
  /// `surface` (see Seen).
  void line(Vec3 a, Vec3 b, float surface) {
    const bool steep = std::abs(b.y() - a.y()) > std::abs(b.x() - a.x());
    const auto along = [&](const Vec3& p) { return steep ? p.y() : p.x(); };
    const auto across = [&](const Vec3& p) { return steep ? p.x() : p.y(); };
    if (along(a) > along(b)) std::swap(a, b);
    const double length = along(b) - along(a);
    if (!(length > 0)) return;
    const double end = steep ? height_ : width_;
    const int from = static_cast<int>(std::clamp(std::ceil(along(a) - 0.5), 0.0, end));
    const int to = static_cast<int>(std::clamp(std::ceil(along(b) - 0.5), 0.0, end));
    for (int step = from; step < to; ++step) {
      const double fraction = (step + 0.5 - along(a)) / length;
      const double cross_place = across(a) + fraction * (across(b) - across(a)) - 0.5;
      const double nearness = a.z() + fraction * (b.z() - a.z());
      const double pixel = std::floor(cross_place);
      for (int side = 0; side < 2; ++side) {
        const int cross_pixel = static_cast<int>(pixel) + side;
        const double cover = side ? cross_place - pixel : 1 - (cross_place - pixel);
        steep ? darken(cross_pixel, step, nearness, surface, cover)
              : darken(step, cross_pixel, nearness, surface, cover);
      }
    }
  }

 private:
  void darken(int x, int y, double nearness, float surface, double cover) {
    if (x < 0 || y < 0 || x >= width_ || y >= height_) return;
    const std::size_t at = static_cast<std::size_t>(y) * width_ + x;
    if (std::floor(seen_[at].surface) != surface || nearness * seen_[at].distance < 1 - kDepthTolerance) return;
    const double keep = 1 - kLineOpacity * cover;
    std::uint64_t dark = picture_[at] & ~((std::uint64_t{1} << 48) - 1);
    for (int k = 0; k < 48; k += 16)
      dark |= static_cast<std::uint64_t>(static_cast<double>(picture_[at] >> k & 0xFFFF) * keep) << k;
    picture_[at] = dark;
  }

  int width_, height_;
  std::span<const Seen> seen_;
  std::span<std::uint64_t> picture_;
};

}  // namespace

void draw_edges(std::span<const SurfaceBuffers> surfaces, const View& view, int width, int height,
                std::span<const Seen> seen, std::span<std::uint64_t> picture) {
  Canvas canvas(width, height, seen, picture);
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    std::vector<Eigen::Vector4d> clip;
    for (const Vec3& position : surfaces[i].state().positions)
      clip.push_back(view.clip_from_world * position.homogeneous());
    for (const auto& [a, b] : edges_of(surfaces[i].surface())) {
      Eigen::Vector4d from = clip[a], to = clip[b];
      if (from.w() > to.w()) std::swap(from, to);
      if (to.w() <= view.near) continue;
      if (from.w() < view.near) from += (view.near - from.w()) / (to.w() - from.w()) * (to - from);
      canvas.line(place_in_picture(from, width, height), place_in_picture(to, width, height),
                  static_cast<float>(kFirstSurface + i));
    }
  }
}

}  // namespace weft::render
