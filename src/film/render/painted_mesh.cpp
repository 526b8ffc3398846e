#include "film/render/painted_mesh.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace weft::render {
namespace {

/// Computes the paint coordinates of each drawn vertex. If the triangle corners at a vertex have different coordinates,
/// splits the vertex into one vertex for each pair of coordinates.
std::vector<Eigen::Vector2f> split_by_place(std::span<const std::array<Vec2, 3>> corners, ShadedMesh& mesh) {
  constexpr Index kNone = -1;
  std::vector<Eigen::Vector2f> places(mesh.source.size(), Eigen::Vector2f::Zero());
  std::vector<char> placed(mesh.source.size(), 0);
  std::vector<Index> next(mesh.source.size(), kNone);  // per drawn vertex: its next copy, which has other coordinates
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector2f place = corners[t][k].cast<float>();
      Index at = mesh.triangles[t][k];
      if (placed[static_cast<std::size_t>(at)] == 0) {
        placed[static_cast<std::size_t>(at)] = 1;
        places[static_cast<std::size_t>(at)] = place;
        continue;
      }
      while (places[static_cast<std::size_t>(at)] != place) {
        if (next[static_cast<std::size_t>(at)] == kNone) {
          next[static_cast<std::size_t>(at)] = static_cast<Index>(mesh.source.size());
          mesh.source.push_back(mesh.source[static_cast<std::size_t>(at)]);
          mesh.normals.push_back(Vec3(mesh.normals[static_cast<std::size_t>(at)]));
          places.push_back(place);
          placed.push_back(1);
          next.push_back(kNone);
        }
        at = next[static_cast<std::size_t>(at)];
      }
      mesh.triangles[t][k] = at;
    }
  }
  return places;
}

}  // namespace

PaintedMesh make_painted_mesh(const frame::Surface& surface, ShadedMesh& mesh) {
  PaintedMesh painted;
  if (surface.paint_uv.size() == mesh.triangles.size()) {
    painted.places = split_by_place(surface.paint_uv, mesh);
  } else {
    for (const Index v : mesh.source)
      painted.places.push_back(surface.uv.empty()
                                   ? Eigen::Vector2f(Eigen::Vector2f::Zero())
                                   : Eigen::Vector2f(surface.uv[static_cast<std::size_t>(v)].cast<float>()));
  }
  const auto& parts = surface.part_of_triangle;
  if (parts.size() != mesh.triangles.size()) {
    painted.ranges = {{0, mesh.triangles.size(), &surface.appearance}};
    return painted;
  }
  std::vector<std::size_t> order(mesh.triangles.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t t) { return parts[t]; });
  std::vector<Triangle> sorted;
  for (const std::size_t t : order) {
    const frame::Appearance* look = &surface.parts[static_cast<std::size_t>(parts[t])].appearance;
    if (painted.ranges.empty() || painted.ranges.back().look != look)
      painted.ranges.push_back({sorted.size(), 0, look});
    ++painted.ranges.back().count;
    sorted.push_back(mesh.triangles[t]);
  }
  mesh.triangles = std::move(sorted);
  return painted;
}

bool covers_color(const frame::Paint& paint) {
  using Alpha = frame::Paint::Alpha;
  using Wrap = frame::Paint::Wrap;
  return paint.alpha == Alpha::over_color ||
         (paint.alpha == Alpha::ignored && (paint.wrap_u == Wrap::once || paint.wrap_v == Wrap::once));
}

Holes::Holes(const PaintedMesh& mesh, std::vector<const Opacity*> opacity)
    : mesh_(&mesh), opacity_(std::move(opacity)) {}

bool Holes::any() const {
  return std::ranges::any_of(opacity_, [](const Opacity* opacity) { return opacity != nullptr; });
}

Eigen::Vector2f Holes::place(std::size_t range, Index vertex) const {
  const Eigen::Vector2f& at = mesh_->places[static_cast<std::size_t>(vertex)];
  const auto map = mesh_->ranges[range].look->paint.texture_from_uv.cast<float>();
  return map * at.homogeneous();
}

}  // namespace weft::render
