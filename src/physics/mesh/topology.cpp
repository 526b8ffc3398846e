#include "physics/mesh/topology.hpp"

#include <algorithm>
#include <tuple>

#include "core/disjoint_sets.hpp"

namespace weft::mesh {
namespace {

/// One side of one triangle, with `low <= high`. `forward`: the triangle traverses it from low to high.
struct Side {
  Index low, high;
  Index triangle;
  int corner;
  bool forward;
};

std::vector<Side> sorted_sides(std::span<const Triangle> triangles) {
  std::vector<Side> sides;
  sides.reserve(3 * triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const Index a = triangles[t][k];
      const Index b = triangles[t][(k + 1) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), static_cast<Index>(t), k, a < b});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.low, a.high, a.triangle, a.corner) < std::tie(b.low, b.high, b.triangle, b.corner);
  });
  return sides;
}

/// Calls visit(first, last) for each edge, with the range of sorted sides that share it.
template <class Visit>
void for_each_edge(const std::vector<Side>& sides, const Visit& visit) {
  for (auto first = sides.begin(); first != sides.end();) {
    const auto last = std::find_if(
        first, sides.end(), [&](const Side& side) { return side.low != first->low || side.high != first->high; });
    visit(first, last);
    first = last;
  }
}

}  // namespace

EdgeSet collect_edges(std::span<const Triangle> triangles) {
  EdgeSet set;
  set.of_triangle.resize(triangles.size());
  set.edges.reserve(triangles.size() + triangles.size() / 2 + 1);
  for_each_edge(sorted_sides(triangles), [&](auto first, auto last) {
    const auto edge = static_cast<Index>(set.edges.size());
    Edge entry{{first->low, first->high}};
    for (auto side = first; side != last; ++side) {
      set.of_triangle[side->triangle][side->corner] = edge;
      if (side - first < 2) entry.triangles[side - first] = side->triangle;
    }
    set.edges.push_back(entry);
  });
  return set;
}

TopologyReport inspect(std::span<const Triangle> triangles, std::size_t vertex_count) {
  TopologyReport report;
  std::vector<Triangle> sound;
  sound.reserve(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto [a, b, c] = triangles[t];
    const auto [low, high] = std::minmax({a, b, c});
    if (low < 0 || static_cast<std::size_t>(high) >= vertex_count) {
      report.out_of_range.push_back(static_cast<Index>(t));
    } else if (a == b || b == c || c == a) {
      report.degenerate.push_back(static_cast<Index>(t));
    } else {
      sound.push_back(triangles[t]);
    }
  }
  for_each_edge(sorted_sides(sound), [&](auto first, auto last) {
    const std::array<Index, 2> edge{first->low, first->high};
    const auto count = last - first;
    if (count > 2) report.non_manifold.push_back(edge);
    if (count == 1) report.border.push_back(edge);
    if (count == 2 && first->forward == (first + 1)->forward) report.misoriented.push_back(edge);
  });
  return report;
}

std::vector<Index> components(std::span<const Triangle> triangles, std::size_t vertex_count) {
  DisjointSets sets(vertex_count);
  for (const Triangle& t : triangles) {
    sets.join(t[0], t[1]);
    sets.join(t[0], t[2]);
  }
  std::vector<Index> numbers(vertex_count);
  Index count = 0;
  for (std::size_t v = 0; v < vertex_count; ++v) {
    const auto root = static_cast<std::size_t>(sets.root(static_cast<Index>(v)));
    numbers[v] = root == v ? count++ : numbers[root];
  }
  return numbers;
}

}  // namespace weft::mesh
