#include "physics/mesh/caps.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "physics/mesh/polygon.hpp"

namespace weft::mesh {
namespace {

using DirectedEdge = std::array<Index, 2>;  // start and end, as the triangle traverses the edge

std::set<DirectedEdge> directed_edges(std::span<const Triangle> triangles) {
  std::set<DirectedEdge> edges;
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) edges.insert({t[k], t[(k + 1) % 3]});
  return edges;
}

}  // namespace

void close_cuts(std::span<const Triangle> whole, std::span<const Vec3> positions, std::vector<Triangle>& kept) {
  const std::set<DirectedEdge> whole_edges = directed_edges(whole), kept_edges = directed_edges(kept);
  std::multimap<Index, Index> lid;  // directed edges of the lids, opposite to those of the adjacent triangles
  for (const auto& [from, to] : kept_edges)
    if (!kept_edges.contains({to, from}) && whole_edges.contains({to, from})) lid.emplace(to, from);

  std::vector<Index> path;
  while (!lid.empty()) {
    if (path.empty()) path.push_back(lid.begin()->first);
    const auto next = lid.find(path.back());
    if (next == lid.end()) {  // a cut that ends at a border of `whole` gets no lid
      path.pop_back();
      continue;
    }
    const Index to = next->second;
    lid.erase(next);
    const auto ring = std::ranges::find(path, to);
    if (ring == path.end()) {
      path.push_back(to);
      continue;
    }
    const std::vector<Index> corners(ring, path.end());
    path.erase(ring + 1, path.end());
    if (corners.size() > 2) triangulate_polygon(corners, positions, kept);
  }
}

}  // namespace weft::mesh
