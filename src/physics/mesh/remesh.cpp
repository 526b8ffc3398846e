#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "physics/mesh/geometry.hpp"
#include "physics/mesh/isosurface.hpp"
#include "physics/mesh/topology.hpp"

namespace weft::mesh {
namespace {

// Edges are split if the ratio of their length to the wanted length is above the maximum, and collapsed if it is below
// the minimum (Botsch & Kobbelt 2004).
constexpr double kMaxEdgeRatio = 4.0 / 3, kMinEdgeRatio = 4.0 / 5;

/// Projects a point to the zero set by two Newton steps along the gradient (forward differences). If `in_plane`, keeps
/// the x coordinate.
Vec3 project_to_surface(const Field& field, Vec3 p, bool in_plane) {
  constexpr double step = 1e-6;  // m
  for (int n = 0; n < 2; ++n) {
    const double value = field(p);
    Vec3 gradient = Vec3::Zero();
    for (int k = in_plane ? 1 : 0; k < 3; ++k) gradient[k] = (field(p + step * Vec3::Unit(k)) - value) / step;
    p -= value / std::max(gradient.squaredNorm(), 1e-4) * gradient;
  }
  return p;
}

double angle_at(const Vec3& corner, const Vec3& a, const Vec3& b) {
  return std::atan2((a - corner).cross(b - corner).norm(), (a - corner).dot(b - corner));
}

/// Changes a triangle mesh, and keeps the list of triangles around each vertex up to date.
class Remesher {
 public:
  Remesher(Mesh& mesh, const Field& field, const Sizing& edge_length)
      : x_(mesh.positions), triangles_(mesh.topology.triangles), field_(field), edge_length_(edge_length) {}

  void run_round() {
    split_long_edges();
    update_connectivity();
    collapse_short_edges();
    drop_unused();
    update_connectivity();
    flip_edges();
    relax();
  }

 private:
  /// Adds a vertex in the middle of every edge that is too long (kMaxEdgeRatio), projects it to the
  /// surface, and cuts the triangles at these vertices.
  void split_long_edges() {
    const EdgeSet edges = collect_edges(triangles_);
    std::vector<Index> middle(edges.edges.size(), -1);
    for (std::size_t e = 0; e < middle.size(); ++e) {
      const auto [a, b] = edges.edges[e].vertices;
      const Vec3 m = 0.5 * (x_[a] + x_[b]);
      if ((x_[b] - x_[a]).norm() <= kMaxEdgeRatio * edge_length_(m)) continue;
      middle[e] = static_cast<Index>(x_.size());
      x_.push_back(project_to_surface(field_, m, edges.edges[e].triangles[1] < 0));
    }
    std::vector<Triangle> cut;
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      const auto& of = edges.of_triangle[t];
      cut_triangle(triangles_[t], {middle[of[0]], middle[of[1]], middle[of[2]]}, cut);
    }
    triangles_ = std::move(cut);
  }

  /// Appends the pieces of a triangle to `out`. `m[k]`: vertex between corners k and k + 1; -1 if that edge is not cut.
  void cut_triangle(Triangle t, std::array<Index, 3> m, std::vector<Triangle>& out) const {
    const auto count = std::count_if(m.begin(), m.end(), [](Index v) { return v >= 0; });
    if (count == 0) return out.push_back(t);
    if (count == 3) {
      out.insert(out.end(), {{t[0], m[0], m[2]}, {t[1], m[1], m[0]}, {t[2], m[2], m[1]}, {m[0], m[1], m[2]}});
      return;
    }
    // Rotate the triangle so that its first edge is cut and its last edge is not.
    while (m[0] < 0 || m[2] >= 0) {
      std::rotate(t.begin(), t.begin() + 1, t.end());
      std::rotate(m.begin(), m.begin() + 1, m.end());
    }
    if (count == 1) {
      out.insert(out.end(), {{t[0], m[0], t[2]}, {m[0], t[1], t[2]}});
    } else {
      out.insert(out.end(), {{m[0], t[1], m[1]}, {t[0], m[0], m[1]}, {t[0], m[1], t[2]}});
    }
  }

  /// Collects the triangles around each vertex, the edges, and the vertices on the border.
  void update_connectivity() {
    around_.resize(x_.size());
    for (std::vector<Index>& triangles : around_) triangles.clear();  // keeps their memory
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      for (const Index v : triangles_[t]) around_[v].push_back(static_cast<Index>(t));
    }
    edges_ = collect_edges(triangles_).edges;
    border_.assign(x_.size(), false);
    for (const Edge& edge : edges_) {
      if (edge.triangles[1] < 0) border_[edge.vertices[0]] = border_[edge.vertices[1]] = true;
    }
  }

  /// Vertices that share a triangle with v, ascending, without duplicates.
  std::vector<Index> neighbours(Index v) const {
    std::vector<Index> list;
    list.reserve(2 * around_[v].size());
    for (const Index t : around_[v]) {
      for (const Index w : triangles_[t]) {
        if (w != v) list.push_back(w);
      }
    }
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    return list;
  }

  void collapse_short_edges() {
    std::vector<std::pair<double, std::size_t>> queue;
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      const auto [a, b] = edges_[e].vertices;
      const double wanted = edge_length_(0.5 * (x_[a] + x_[b]));
      const double length = (x_[b] - x_[a]).norm();
      if (length < kMinEdgeRatio * wanted) queue.emplace_back(length / wanted, e);
    }
    std::sort(queue.begin(), queue.end());
    for (const auto& [ratio, e] : queue) {
      auto [keep, gone] = edges_[e].vertices;
      if (border_[gone] && !border_[keep]) std::swap(keep, gone);
      collapse(keep, gone, edges_[e].triangles[1] < 0);
    }
  }

  /// Whether `gone` may be merged into `keep` without a change of topology (link condition).
  bool link_allows(Index keep, Index gone, bool on_border) const {
    if (border_[gone] && !on_border) return false;
    // Earlier collapses may have removed one of the vertices.
    if (around_[keep].empty() || around_[gone].empty()) return false;
    const std::vector<Index> a = neighbours(keep), b = neighbours(gone);
    if (!std::binary_search(a.begin(), a.end(), gone)) return false;
    std::vector<Index> common;
    std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(common));
    if (common.size() != (on_border ? 1U : 2U)) return false;
    // No inner edge may join two border vertices. The mirror image of such an edge has the same two vertices, so four
    // triangles would share this edge after join_mirror_image().
    return on_border || !border_[keep] ||
           std::none_of(b.begin(), b.end(), [&](Index w) { return w != keep && border_[w]; });
  }

  /// Whether `v` may move to p: the normals of the triangles at `v` that do not contain `other`
  /// turn by at most 60°, and no edge at `v` of these triangles becomes too long (kMaxEdgeRatio).
  bool shape_allows(Index v, Index other, const Vec3& p) const {
    for (const Index t : around_[v]) {
      Triangle corner = triangles_[t];
      if (std::find(corner.begin(), corner.end(), other) != corner.end()) continue;
      while (corner[0] != v) std::rotate(corner.begin(), corner.begin() + 1, corner.end());
      const Vec3 &q = x_[corner[1]], &r = x_[corner[2]];
      const Vec3 before = (q - x_[v]).cross(r - x_[v]), after = (q - p).cross(r - p);
      if (before.dot(after) < 0.5 * before.norm() * after.norm()) return false;
      if ((q - p).norm() > kMaxEdgeRatio * edge_length_(0.5 * (p + q))) return false;
    }
    return true;
  }

  void collapse(Index keep, Index gone, bool on_border) {
    if (!link_allows(keep, gone, on_border)) return;
    const bool to_keep = border_[keep] && !on_border;
    const Vec3 p = to_keep ? x_[keep] : project_to_surface(field_, 0.5 * (x_[keep] + x_[gone]), on_border);
    if (!shape_allows(keep, gone, p) || !shape_allows(gone, keep, p)) return;
    x_[keep] = p;
    for (const Index t : around_[gone]) {
      Triangle& corner = triangles_[t];
      if (std::find(corner.begin(), corner.end(), keep) == corner.end()) {
        std::replace(corner.begin(), corner.end(), gone, keep);
        around_[keep].push_back(t);
        continue;
      }
      for (const Index v : corner) {
        if (v != gone) std::erase(around_[v], t);
      }
      corner = {-1, -1, -1};
    }
    around_[gone].clear();
  }

  void drop_unused() {
    std::erase_if(triangles_, [](const Triangle& t) { return t[0] < 0; });
    std::vector<Index> place(x_.size(), -1);
    std::size_t count = 0;
    for (std::size_t v = 0; v < x_.size(); ++v) {
      if (around_[v].empty()) continue;
      place[v] = static_cast<Index>(count);
      x_[count++] = x_[v];
    }
    x_.resize(count);
    for (Triangle& t : triangles_) {
      for (Index& v : t) v = place[v];
    }
  }

  /// Flips each edge whose two opposite angles add up to more than π (it is not locally Delaunay),
  /// unless the new edge exists already, would join two border vertices, or would fold the surface.
  void flip_edges() {
    for (const Edge& edge : edges_) {
      if (edge.triangles[1] < 0) continue;
      const auto [a, b] = edge.vertices;
      // Earlier flips may have changed the triangles at this edge, so collect them anew.
      std::vector<Index> sides;
      for (const Index t : around_[a]) {
        const Triangle& corner = triangles_[t];
        if (std::find(corner.begin(), corner.end(), b) != corner.end()) sides.push_back(t);
      }
      if (sides.size() == 2) flip(a, b, sides[0], sides[1]);
    }
  }

  void flip(Index a, Index b, Index left, Index right) {
    const auto opposite = [&](Index t) {
      const Triangle& corner = triangles_[t];
      return *std::find_if(corner.begin(), corner.end(), [&](Index v) { return v != a && v != b; });
    };
    // Let `left` be the triangle that traverses the edge from a to b.
    const auto follows = [&](Index t) {
      const Triangle& corner = triangles_[t];
      const auto at = std::find(corner.begin(), corner.end(), a) - corner.begin();
      return corner[static_cast<std::size_t>(at + 1) % 3] == b;
    };
    if (!follows(left)) std::swap(left, right);
    const Index c = opposite(left), d = opposite(right);
    if (c == d || (border_[c] && border_[d])) return;
    const Vec3 &pa = x_[a], &pb = x_[b], &pc = x_[c], &pd = x_[d];
    if (angle_at(pc, pa, pb) + angle_at(pd, pa, pb) < std::numbers::pi + 1e-6) return;
    const std::vector<Index> of_c = neighbours(c);
    if (std::binary_search(of_c.begin(), of_c.end(), d)) return;
    // Avoid folds: the normals of the new triangles may deviate by at most 45° from the mean normal
    // of the old ones.
    const Vec3 normal = (pb - pa).cross(pc - pa) + (pd - pa).cross(pb - pa);
    const Vec3 first = (pd - pa).cross(pc - pa), second = (pb - pd).cross(pc - pd);
    if (first.dot(normal) < 0.7 * first.norm() * normal.norm() ||
        second.dot(normal) < 0.7 * second.norm() * normal.norm()) {
      return;
    }
    triangles_[left] = {a, d, c};
    triangles_[right] = {d, b, c};
    std::erase(around_[a], right);
    std::erase(around_[b], left);
    around_[c].push_back(right);
    around_[d].push_back(left);
  }

  /// Moves each vertex along the surface toward the weighted mean of its neighbours. For a vertex on the border, only
  /// neighbours on the border count.
  void relax() {
    std::vector<Vec3> normals(x_.size());
    vertex_normals(triangles_, x_, normals);
    std::vector<Vec3> target(x_);
    for (std::size_t v = 0; v < x_.size(); ++v) {
      Vec3 sum = Vec3::Zero();
      double count = 0;
      for (const Index w : neighbours(static_cast<Index>(v))) {
        if (border_[v] && !border_[w]) continue;
        // The weight is larger where wanted edges are shorter, so that the size of triangles changes gradually.
        const double weight = 1 / edge_length_(0.5 * (x_[v] + x_[w]));
        sum += weight * x_[w];
        count += weight;
      }
      Vec3 move = 0.8 * (sum / count - x_[v]);
      move -= normals[v].dot(move) * normals[v];
      if (border_[v]) move.x() = 0;
      target[v] = project_to_surface(field_, x_[v] + move, border_[v]);
    }
    x_ = std::move(target);
  }

  std::vector<Vec3>& x_;
  std::vector<Triangle>& triangles_;
  const Field& field_;
  const Sizing& edge_length_;
  std::vector<std::vector<Index>> around_;
  std::vector<Edge> edges_;
  std::vector<bool> border_;
};

}  // namespace

void remesh(Mesh& surface, const Field& field, const Sizing& edge_length, int rounds) {
  Remesher remesher(surface, field, edge_length);
  for (int n = 0; n < rounds; ++n) remesher.run_round();
}

}  // namespace weft::mesh
