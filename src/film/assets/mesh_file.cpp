#include "film/assets/mesh_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "core/disjoint_sets.hpp"
#include "film/assets/character_file.hpp"
#include "film/assets/raw_mesh.hpp"
#include "physics/mesh/topology.hpp"

namespace weft::assets {
namespace {

/// For each vertex, the first vertex at exactly the same position.
std::vector<Index> first_at_same_place(const std::vector<Vec3>& positions) {
  const auto key = [&](Index i) {
    const Vec3& x = positions[i];
    return std::array{x.x(), x.y(), x.z()};
  };
  std::vector<Index> order(positions.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](Index a, Index b) { return std::pair(key(a), a) < std::pair(key(b), b); });
  std::vector<Index> first(positions.size());
  Index start = -1;  // first vertex of the current run of equal positions
  for (const Index i : order) {
    if (start < 0 || key(i) != key(start)) start = i;
    first[i] = start;
  }
  return first;
}

/// Merges vertices at exactly the same position (0 and −0 are equal), removes vertices that no face uses, and orders
/// the others by their first use in faces. Adds the number of merged copies to `joined`. Returns the new index of each
/// vertex; −1: removed.
std::vector<Index> join_vertices(RawMesh& raw, std::size_t& joined) {
  const std::vector<Index> first = first_at_same_place(raw.positions);
  std::vector<Index> renamed = first;
  std::vector<Vec3> kept;
  for (const Index v : join_groups(raw, renamed)) kept.push_back(raw.positions[at(first[at(v)])]);
  raw.positions = std::move(kept);
  for (std::size_t v = 0; v < first.size(); ++v) joined += first[v] == static_cast<Index>(v) ? 0 : 1;
  return renamed;
}

/// Copies colours and groups of vertices. `renamed`: new index of each vertex; −1: removed.
void copy_vertex_data(const RawMesh& raw, const std::vector<Index>& renamed, LoadedMesh& result) {
  const std::size_t count = result.mesh.positions.size();
  for (std::size_t v = 0; v < renamed.size(); ++v) {
    if (renamed[v] < 0 || !raw.colors[v].allFinite()) continue;
    if (result.colors.empty()) result.colors.assign(count, Vec3::Zero());
    Vec3& color = result.colors[static_cast<std::size_t>(renamed[v])];
    color = color.cwiseMax(raw.colors[v]).cwiseMin(1);
  }
  for (const RawMesh::Weight& weight : raw.weights) {
    const Index vertex = renamed[static_cast<std::size_t>(weight.vertex)];
    if (vertex < 0 || !(weight.weight > 0)) continue;
    std::vector<double>& group = result.groups[raw.group_names[static_cast<std::size_t>(weight.group)]];
    group.resize(count);
    double& most = group[static_cast<std::size_t>(vertex)];
    most = std::min(1.0, std::max(most, weight.weight));
  }
}

/// UVs of the triangles of make_topology(). `raw`: the raw mesh before its vertices are merged, with the same list of
/// triangles.
std::vector<std::array<Vec2, 3>> uv_of_corners(const RawMesh& raw) {
  std::vector<std::array<Vec2, 3>> corners;
  if (std::ranges::none_of(raw.uv, [](const Vec2& uv) { return uv.allFinite(); })) return corners;
  std::size_t removed = 0;
  for (const mesh::Triangle& t : make_topology(raw, removed).triangles)
    corners.push_back({raw.uv[t[0]], raw.uv[t[1]], raw.uv[t[2]]});
  return corners;
}

/// A border vertex, and the maximum distance at which another border vertex is merged with it [m].
struct BorderVertex {
  Index vertex;
  double weld_distance;
};

std::vector<BorderVertex> border_of(const mesh::Mesh& mesh, double ratio) {
  std::vector<double> shortest(mesh.positions.size(), std::numeric_limits<double>::infinity());
  for (const auto& [a, b] : mesh::inspect(mesh.topology.triangles, mesh.positions.size()).border)
    for (const Index v : {a, b})
      shortest[at(v)] = std::min(shortest[at(v)], (mesh.positions[at(a)] - mesh.positions[at(b)]).norm());
  std::vector<BorderVertex> border;
  for (std::size_t v = 0; v < shortest.size(); ++v)
    if (std::isfinite(shortest[v])) border.push_back({static_cast<Index>(v), ratio * shortest[v]});
  return border;
}

}  // namespace

Welded weld_borders(LoadedMesh& loaded, double ratio) {
  const std::vector<Vec3>& x = loaded.mesh.positions;
  std::vector<BorderVertex> border = border_of(loaded.mesh, ratio);
  // Sorts by the x coordinate, so that only vertices with similar x are compared.
  std::ranges::stable_sort(border, {}, [&](const BorderVertex& b) { return x[at(b.vertex)].x(); });
  DisjointSets sets(x.size());
  Welded welded;
  for (std::size_t i = 0; i < border.size(); ++i)
    for (std::size_t j = i + 1; j < border.size(); ++j) {
      const Vec3 offset = x[at(border[j].vertex)] - x[at(border[i].vertex)];
      if (offset.x() > border[i].weld_distance) break;
      if (offset.norm() > std::min(border[i].weld_distance, border[j].weld_distance)) continue;
      sets.join(border[i].vertex, border[j].vertex);
      welded.widest = std::max(welded.widest, offset.norm());
    }
  std::vector<Index> renamed(x.size());
  LoadedMesh result = loaded;
  result.mesh.positions.clear();
  std::vector<int> copies;
  for (std::size_t v = 0; v < x.size(); ++v) {
    const auto first = at(sets.root(static_cast<Index>(v)));
    if (first == v) {
      renamed[v] = static_cast<Index>(copies.size());
      result.mesh.positions.push_back(x[v]);
      copies.push_back(1);
      continue;
    }
    ++welded.vertices;
    renamed[v] = renamed[first];
    result.mesh.positions[at(renamed[v])] += x[v];
    ++copies[at(renamed[v])];
  }
  if (welded.vertices == 0) return welded;
  for (std::size_t v = 0; v < copies.size(); ++v) result.mesh.positions[v] /= copies[v];
  for (auto& quad : result.mesh.topology.quads)
    for (Index& v : quad) v = renamed[at(v)];
  for (auto& triangle : result.mesh.topology.triangles)
    for (Index& v : triangle) v = renamed[at(v)];
  if (!mesh::inspect(result.mesh.topology.triangles, copies.size()).manifold()) return {};
  if (!loaded.colors.empty()) result.colors.assign(copies.size(), Vec3::Zero());
  for (std::size_t v = 0; v < loaded.colors.size(); ++v)
    result.colors[at(renamed[v])] = result.colors[at(renamed[v])].cwiseMax(loaded.colors[v]);
  for (auto& [name, weights] : result.groups) {
    weights.assign(copies.size(), 0);
    const std::vector<double>& before = loaded.groups.at(name);
    for (std::size_t v = 0; v < before.size(); ++v)
      weights[at(renamed[v])] = std::max(weights[at(renamed[v])], before[v]);
  }
  loaded = std::move(result);
  return welded;
}

namespace {

LoadedMesh load(const Source& source, const MeshAxes& axes, const std::string& object) {
  RawMesh raw = from_bytes(source.read([&] { return to_bytes(read_raw_mesh(source.file, object)); }));
  if (raw.triangles.empty() && raw.quads.empty()) source.fail("expected faces, got none");
  scene::FileUp up = axes.up;
  if (up == scene::FileUp::as_file) up = raw.up ? static_cast<scene::FileUp>(*raw.up + 1) : axes.default_up;
  Mat3 turn = Mat3::Identity();
  if (up != scene::FileUp::as_file) turn = rotation_to_scene_axes(static_cast<int>(up) - 1, axes.scene_up);
  for (Vec3& x : raw.positions) {
    x = axes.scale * (turn * x);
    source.check_coordinates(x);  // also ensures that products of squared lengths are finite
  }

  LoadedMesh result;
  result.uv = uv_of_corners(raw);
  const std::vector<Index> renamed = join_vertices(raw, result.joined_vertices);
  result.mesh.topology = make_topology(raw, result.removed_triangles);
  if (result.mesh.topology.triangles.empty()) source.fail("expected faces with an area, got none");
  result.mesh.positions = std::move(raw.positions);
  std::vector<std::uint8_t> used(result.mesh.positions.size(), 0);
  for (const mesh::Triangle& t : result.mesh.topology.triangles)
    for (const Index v : t) used[at(v)] = 1;
  result.lost_vertices = static_cast<std::size_t>(std::ranges::count(used, 0));
  copy_vertex_data(raw, renamed, result);
  return result;
}

}  // namespace

LoadedMesh load_mesh(const std::filesystem::path& file, const MeshAxes& axes, const std::string& where,
                     const std::string& object) {
  const Source source{file, where};
  return source.checked([&] { return load(source, axes, object); });
}

}  // namespace weft::assets
