#include "film/render/shaded_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/error.hpp"

namespace weft::render {
namespace {

// Margin that is added to the crease angle [degrees]. Neighbouring faces of a regular prism can differ by exactly the
// crease angle (12 faces: 30 degrees). Without the margin, rounding would decide in each frame whether such an edge is
// sharp.
constexpr double kCreaseMargin = 0.37;

Vec3 unit_or_up(const Vec3& sum) {
  const double length = sum.norm();
  return length > 0 ? Vec3(sum / length) : Vec3::UnitZ();
}

}  // namespace

CornerMap::CornerMap(std::span<const Triangle> triangles, std::size_t vertex_count)
    : first_(vertex_count + 1, 0), corners_(triangles.size() * 3) {
  // Counting sort: count, prefix sum, then fill in corner order.
  for (const Triangle& triangle : triangles) {
    for (const Index vertex : triangle) {
      if (vertex < 0 || static_cast<std::size_t>(vertex) >= vertex_count) {
        throw Error(ExitCode::internal, "triangle names vertex {}, expected 0 to {}", vertex, vertex_count - 1);
      }
      ++first_[vertex + 1];
    }
  }
  for (std::size_t v = 0; v < vertex_count; ++v) first_[v + 1] += first_[v];
  std::vector<std::int32_t> next(first_.begin(), first_.end() - 1);
  for (std::size_t c = 0; c < corners_.size(); ++c) {
    corners_[next[triangles[c / 3][c % 3]]++] = static_cast<std::int32_t>(c);
  }
}

bool is_closed(std::span<const Triangle> triangles) {
  std::vector<std::pair<Index, Index>> edges;
  for (const Triangle& t : triangles) edges.insert(edges.end(), {{t[0], t[1]}, {t[1], t[2]}, {t[2], t[0]}});
  std::sort(edges.begin(), edges.end());
  if (std::adjacent_find(edges.begin(), edges.end()) != edges.end()) return false;
  return !edges.empty() && std::all_of(edges.begin(), edges.end(), [&](const auto& edge) {
    return std::binary_search(edges.begin(), edges.end(), std::pair(edge.second, edge.first));
  });
}

std::vector<Vec3> area_normals(std::span<const Triangle> triangles, std::span<const Vec3> positions) {
  std::vector<Vec3> normals(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto& [a, b, c] = triangles[t];
    normals[t] = (positions[b] - positions[a]).cross(positions[c] - positions[a]);
  }
  return normals;
}

ShadedMesh make_shaded_mesh(std::span<const Triangle> triangles, const CornerMap& corners,
                            std::span<const Vec3> positions, double crease_angle) {
  const std::vector<Vec3> areas = area_normals(triangles, positions);
  ShadedMesh mesh;
  if (crease_angle >= 180) {
    mesh.source.resize(positions.size());
    mesh.normals.resize(positions.size());
    for (std::size_t v = 0; v < positions.size(); ++v) {
      Vec3 sum = Vec3::Zero();
      for (const std::int32_t corner : corners.corners(v)) sum += areas[corner / 3];
      mesh.source[v] = static_cast<Index>(v);
      mesh.normals[v] = unit_or_up(sum);
    }
    mesh.triangles.assign(triangles.begin(), triangles.end());
    return mesh;
  }
  mesh.triangles.resize(triangles.size());
  const double cos_crease = std::cos((crease_angle + kCreaseMargin) * std::numbers::pi / 180);
  // A vertex becomes one drawn vertex for each distinct normal among its corners.
  for (std::size_t v = 0; v < positions.size(); ++v) {
    const std::size_t first = mesh.normals.size();
    for (const std::int32_t corner : corners.corners(v)) {
      const Vec3& own = areas[corner / 3];
      Vec3 sum = Vec3::Zero();
      for (const std::int32_t other : corners.corners(v)) {
        const Vec3& area = areas[other / 3];
        if (other == corner || own.dot(area) > cos_crease * own.norm() * area.norm()) sum += area;
      }
      const Vec3 normal = unit_or_up(sum);
      // Corners whose normals are means over the same triangles have bitwise equal normals, because the order of
      // addition is the same.
      std::size_t drawn = first;
      while (drawn < mesh.normals.size() && mesh.normals[drawn] != normal) ++drawn;
      if (drawn == mesh.normals.size()) {
        mesh.source.push_back(static_cast<Index>(v));
        mesh.normals.push_back(normal);
      }
      mesh.triangles[corner / 3][corner % 3] = static_cast<Index>(drawn);
    }
  }
  return mesh;
}

}  // namespace weft::render
