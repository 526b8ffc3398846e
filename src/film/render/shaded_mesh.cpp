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

/// Adds the drawn vertices of one surface vertex: one for each distinct normal among its corners.
class VertexSplitter {
 public:
  VertexSplitter(ShadedMesh& mesh, std::span<const Vec3> areas, double cos_crease)
      : mesh_(mesh), areas_(areas), cos_crease_(cos_crease) {}

  void split(Index vertex, std::span<const std::int32_t> corners) {
    const std::size_t first = mesh_.normals.size();
    for (const std::int32_t corner : corners) {
      const Vec3 normal = corner_normal(corner, corners);
      // Corners whose normals are means over the same triangles have bitwise equal normals, because the order of
      // addition is the same.
      std::size_t drawn = first;
      while (drawn < mesh_.normals.size() && mesh_.normals[drawn] != normal) ++drawn;
      if (drawn == mesh_.normals.size()) {
        mesh_.source.push_back(vertex);
        mesh_.normals.push_back(normal);
      }
      mesh_.triangles[corner / 3][corner % 3] = static_cast<Index>(drawn);
    }
  }

 private:
  Vec3 corner_normal(std::int32_t corner, std::span<const std::int32_t> corners) const {
    const Vec3& own = areas_[corner / 3];
    Vec3 sum = Vec3::Zero();
    for (const std::int32_t other : corners) {
      const Vec3& area = areas_[other / 3];
      if (other == corner || own.dot(area) > cos_crease_ * own.norm() * area.norm()) sum += area;
    }
    return unit_or_up(sum);
  }

  ShadedMesh& mesh_;
  std::span<const Vec3> areas_;
  double cos_crease_;
};

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
  VertexSplitter splitter(mesh, areas, std::cos((crease_angle + kCreaseMargin) * std::numbers::pi / 180));
  for (std::size_t v = 0; v < positions.size(); ++v) splitter.split(static_cast<Index>(v), corners.corners(v));
  return mesh;
}

}  // namespace weft::render
