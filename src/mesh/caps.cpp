#include "mesh/caps.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "mesh/polygon.hpp"

namespace weft::mesh {
namespace {

using Way = std::array<Index, 2>;  // an edge as its triangle runs along it

std::set<Way> ways_of(std::span<const Triangle> triangles) {
  std::set<Way> ways;
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) ways.insert({t[k], t[(k + 1) % 3]});
  return ways;
}

}  // namespace

void close_cuts(std::span<const Triangle> whole, std::span<const Vec3> positions, std::vector<Triangle>& kept) {
  const std::set<Way> all = ways_of(whole), left = ways_of(kept);
  std::multimap<Index, Index> lid;  // the ways of the lids, against those of the triangles beside them
  for (const auto& [from, to] : left)
    if (!left.contains({to, from}) && all.contains({to, from})) lid.emplace(to, from);

  std::vector<Index> path;
  while (!lid.empty()) {
    if (path.empty()) path.push_back(lid.begin()->first);
    const auto next = lid.find(path.back());
    if (next == lid.end()) {  // a cut that runs into a border of the whole closes nothing
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
