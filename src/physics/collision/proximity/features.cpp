#include "physics/collision/proximity/features.hpp"

#include <algorithm>
#include <tuple>

namespace weft::collision {

Features::Features(std::span<const Triangle> triangles, Index vertex_count)
    : triangles_(triangles), owned_(triangles.size(), 0) {
  collect_triangles_at_vertices(vertex_count);
  own_edges();
}

void Features::collect_triangles_at_vertices(Index vertex_count) {
  // Counting sort by vertex. A repeated corner (of a piece of rope) counts once.
  const auto for_each_corner = [&](const auto& visit) {
    for (std::size_t t = 0; t < triangles_.size(); ++t)
      for (std::size_t c = 0; c < 3; ++c)
        if (std::find(triangles_[t].begin(), triangles_[t].begin() + c, triangles_[t][c]) == triangles_[t].begin() + c)
          visit(t, c);
  };
  around_begin_.assign(static_cast<std::size_t>(vertex_count) + 1, 0);
  for_each_corner(
      [&](std::size_t t, std::size_t c) { ++around_begin_[static_cast<std::size_t>(triangles_[t][c]) + 1]; });
  for (std::size_t v = 1; v < around_begin_.size(); ++v) around_begin_[v] += around_begin_[v - 1];
  around_.resize(around_begin_.back());
  std::vector<Index> next(around_begin_.begin(), around_begin_.end() - 1);
  for_each_corner([&](std::size_t t, std::size_t c) {
    const auto v = static_cast<std::size_t>(triangles_[t][c]);
    if (next[v] == around_begin_[v]) owned_[t] |= static_cast<std::uint8_t>(1U << c);
    around_[at(next[v]++)] = static_cast<Index>(t);
  });
}

void Features::own_edges() {
  struct Side {
    Index low, high, triangle, corner;
    bool same_edge(const Side& other) const { return low == other.low && high == other.high; }
  };
  std::vector<Side> sides;
  sides.reserve(3 * triangles_.size());
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    for (std::size_t c = 0; c < 3; ++c) {
      const auto [low, high] = std::minmax(triangles_[t][c], triangles_[t][(c + 1) % 3]);
      if (low != high) sides.push_back({low, high, static_cast<Index>(t), static_cast<Index>(c)});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.low, a.high, a.triangle, a.corner) < std::tie(b.low, b.high, b.triangle, b.corner);
  });

  // Equal edges are consecutive now. The first triangle in each group of equal edges owns the edge.
  edge_.resize(triangles_.size());
  across_.assign(triangles_.size(), {-1, -1, -1});
  apexes_begin_ = {0};
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    while (end < sides.size() && sides[end].same_edge(sides[begin])) ++end;
    const Side& owner = sides[begin];
    owned_[owner.triangle] |= static_cast<std::uint8_t>(8U << owner.corner);
    edge_[owner.triangle][owner.corner] = static_cast<Index>(apexes_begin_.size() - 1);
    // A piece of rope (a, b, b) has the edge twice; then no other triangle is across the edge.
    if (end - begin == 2 && sides[begin + 1].triangle != owner.triangle)
      across_[owner.triangle][owner.corner] = sides[begin + 1].triangle;
    for (std::size_t i = begin; i < end; ++i)
      apexes_.push_back(triangles_[sides[i].triangle][static_cast<std::size_t>(sides[i].corner + 2) % 3]);
    apexes_begin_.push_back(static_cast<Index>(apexes_.size()));
  }
  apexes_.shrink_to_fit();
  apexes_begin_.shrink_to_fit();
}

std::vector<TrianglePair> Features::hinges(Index first, Index count) const {
  std::vector<TrianglePair> pairs;
  for (Index a = first; a < first + count; ++a)
    for (std::size_t c = 0; c < 3; ++c) {
      const Index from = triangle(a)[c], to = triangle(a)[(c + 1) % 3];
      for (const Index b : triangles_at(from))
        if (b > a && from != to && has_vertex(triangle(b), to)) pairs.push_back({a, b});
    }
  std::ranges::sort(pairs);
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

}  // namespace weft::collision
