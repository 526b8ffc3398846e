#include "film/garment/triangulation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "physics/mesh/polygon.hpp"

namespace weft::garment {
namespace {

// Minimum distance of lattice points from the outline [spacings]. The strip between lattice and outline is then about
// 0.6 to 1.6 spacings wide, so that its triangles have no very small or very large angles.
constexpr double kMinOutlineDistance = 0.62;
// During triangulation, each lattice row is shifted by this length relative to the row below [spacings]. The shift
// makes the Delaunay diagonal of each square unique. It is large compared with rounding errors, and its sum over all
// rows is small compared with the spacing.
constexpr double kRowShift = 1e-6;

double cross(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}
double orientation(const Vec2& a, const Vec2& b, const Vec2& c) {
  return cross(b - a, c - a);
}

// Positive if d lies inside the circle through a, b, c (counter-clockwise).
double in_circle(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  const Vec2 p = a - d, q = b - d, r = c - d;
  return p.squaredNorm() * cross(q, r) + q.squaredNorm() * cross(r, p) + r.squaredNorm() * cross(p, q);
}

/// A Delaunay triangulation into which points are inserted.
class Delaunay {
 public:
  explicit Delaunay(std::span<const Vec2> outline) : points_(outline.begin(), outline.end()) {
    std::vector<Index> corners;
    std::vector<Vec3> flat;
    for (const Vec2& p : outline) {
      corners.push_back(static_cast<Index>(corners.size()));
      flat.emplace_back(p.x(), p.y(), 0);
    }
    mesh::triangulate_polygon(corners, flat, triangles_);
    neighbours_.assign(triangles_.size(), {-1, -1, -1});
    const mesh::EdgeSet edges = mesh::collect_edges(triangles_);
    for (std::size_t t = 0; t < triangles_.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k) {
        const mesh::Edge& edge = edges.edges[at(edges.of_triangle[t][k])];
        neighbours_[t][k] = edge.triangles[0] == static_cast<Index>(t) ? edge.triangles[1] : edge.triangles[0];
        stack_.emplace_back(static_cast<Index>(t), k);
      }
    flip_edges();
  }

  void insert(const Vec2& p) {
    const Index t = locate(p);
    const auto vertex = static_cast<Index>(points_.size());
    points_.push_back(p);
    // Splits the triangle into three at the point. If the point is on an edge of the triangle, one of the three has no
    // area until flip_edges() flips that edge.
    const auto [a, b, c] = triangles_[at(t)];
    const auto [ab, bc, ca] = neighbours_[at(t)];
    const auto u = static_cast<Index>(triangles_.size()), v = u + 1;
    triangles_[at(t)] = {a, b, vertex}, neighbours_[at(t)] = {ab, u, v};
    triangles_.push_back({b, c, vertex}), neighbours_.push_back({bc, v, t});
    triangles_.push_back({c, a, vertex}), neighbours_.push_back({ca, t, u});
    replace_neighbour(bc, t, u);
    replace_neighbour(ca, t, v);
    for (Index each : {t, u, v}) stack_.emplace_back(each, 0);
    flip_edges();
    last_ = t;
  }

  FlatMesh take() { return {std::move(points_), std::move(triangles_)}; }

 private:
  const Vec2& point(Index i) const { return points_[at(i)]; }

  // Finds the triangle that contains p. Starts from the triangle of the last insertion, and repeatedly crosses an edge
  // that separates the current triangle from p. If this leads out of the polygon or does not end, searches all
  // triangles for the one in which p is deepest.
  Index locate(const Vec2& p) const {
    Index t = last_;
    for (std::size_t steps = 0; steps < triangles_.size(); ++steps) {
      const std::size_t beyond = side_towards(t, p);
      if (beyond == 3) return t;
      t = neighbours_[at(t)][beyond];
      if (t < 0) break;
    }
    Index nearest = 0;
    double best = -std::numeric_limits<double>::infinity();
    for (Index each = 0; each < static_cast<Index>(triangles_.size()); ++each)
      if (const double depth = depth_in(each, p); depth > best) best = depth, nearest = each;
    return nearest;
  }
  double depth_in(Index t, const Vec2& p) const {
    const mesh::Triangle& corners = triangles_[at(t)];
    double smallest = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < 3; ++k)
      smallest = std::min(smallest, orientation(point(corners[k]), point(corners[(k + 1) % 3]), p));
    return smallest;
  }
  // A side of the triangle that has p on its outer side; 3 if there is none.
  std::size_t side_towards(Index t, const Vec2& p) const {
    const mesh::Triangle& corners = triangles_[at(t)];
    for (std::size_t k = 0; k < 3; ++k)
      if (orientation(point(corners[k]), point(corners[(k + 1) % 3]), p) < 0) return k;
    return 3;
  }

  void replace_neighbour(Index of, Index from, Index to) {
    if (of >= 0) std::ranges::replace(neighbours_[at(of)], from, to);
  }

  // Flips edges until all edges on the stack are locally Delaunay.
  void flip_edges() {
    while (!stack_.empty()) {
      const auto [t, k] = stack_.back();
      stack_.pop_back();
      const Index s = neighbours_[at(t)][k];
      if (s < 0) continue;
      std::size_t m = 0;
      while (neighbours_[at(s)][m] != t) ++m;
      const Index a = triangles_[at(t)][k], b = triangles_[at(t)][(k + 1) % 3], c = triangles_[at(t)][(k + 2) % 3];
      const Index d = triangles_[at(s)][(m + 2) % 3];
      if (!should_flip(a, b, c, d)) continue;
      const Index bc = neighbours_[at(t)][(k + 1) % 3], ca = neighbours_[at(t)][(k + 2) % 3];
      const Index ad = neighbours_[at(s)][(m + 1) % 3], db = neighbours_[at(s)][(m + 2) % 3];
      triangles_[at(t)] = {c, a, d}, neighbours_[at(t)] = {ca, ad, s};
      triangles_[at(s)] = {d, b, c}, neighbours_[at(s)] = {db, bc, t};
      replace_neighbour(ad, s, t);
      replace_neighbour(bc, t, s);
      for (std::size_t side : {0U, 1U}) stack_.emplace_back(t, side), stack_.emplace_back(s, side);
    }
  }
  // Whether to flip the edge between the triangles (a, b, c) and (b, a, d): if the quadrilateral a, d, b, c is convex,
  // and d is inside the circumcircle of (a, b, c) by more than rounding errors.
  bool should_flip(Index a, Index b, Index c, Index d) const {
    const Vec2 &pa = point(a), &pb = point(b), &pc = point(c), &pd = point(d);
    if (orientation(pc, pa, pd) <= 0 || orientation(pd, pb, pc) <= 0) return false;
    const double size = std::max((pa - pb).squaredNorm(), (pc - pd).squaredNorm());
    // A triangle without area has no circumcircle, and any flip improves it.
    if (orientation(pa, pb, pc) <= 1e-12 * size) return true;
    return in_circle(pa, pb, pc, pd) > 1e-12 * size * size;
  }

  std::vector<Vec2> points_;
  std::vector<mesh::Triangle> triangles_;
  std::vector<std::array<Index, 3>> neighbours_;  // across the side from corner k to k + 1; −1: none (outline)
  std::vector<std::pair<Index, std::size_t>> stack_;
  Index last_ = 0;
};

// The places along x, ascending, at which the horizontal line at y crosses the outline. A point on this line is inside
// the outline if an odd number of them is below its x (even-odd rule).
std::vector<double> crossings_at(std::span<const Vec2> outline, double y) {
  std::vector<double> crossings;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vec2 &a = outline[i], &b = outline[(i + 1) % outline.size()];
    if ((a.y() > y) != (b.y() > y)) crossings.push_back(a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x()));
  }
  std::ranges::sort(crossings);
  return crossings;
}

bool is_far_from(std::span<const Vec2> outline, const Vec2& p, double distance) {
  for (std::size_t i = 0; i < outline.size(); ++i)
    if (distance_sq(p, outline[i], outline[(i + 1) % outline.size()]) < distance * distance) return false;
  return true;
}

}  // namespace

double distance_sq(const Vec2& p, const Vec2& a, const Vec2& b) {
  const Vec2 side = b - a;
  const double length_sq = side.squaredNorm();
  const double fraction = length_sq > 0 ? std::clamp((p - a).dot(side) / length_sq, 0.0, 1.0) : 0;
  return (a + fraction * side - p).squaredNorm();
}

FlatMesh triangulate(std::span<const Vec2> outline, std::span<const Vec2> inside) {
  Delaunay delaunay(outline);
  for (const Vec2& p : inside) delaunay.insert(p);
  return delaunay.take();
}

FlatMesh mesh_panel(std::span<const Vec2> outline, const Vec2& warp, double spacing) {
  // Converts to coordinates along weft and warp, in which the lattice is axis-aligned.
  const auto to_lattice = [&](const Vec2& p) -> Vec2 { return {cross(p, warp), p.dot(warp)}; };
  std::vector<Vec2> rotated;
  Vec2 low = to_lattice(outline[0]), high = low;
  for (const Vec2& p : outline) {
    rotated.push_back(to_lattice(p));
    low = low.cwiseMin(rotated.back());
    high = high.cwiseMax(rotated.back());
  }
  // The lattice has whole squares and is centred, so that a symmetric panel gets a symmetric lattice. If the size of
  // the panel is a multiple of the spacing, rounding down could remove a row; adding kRowShift prevents this.
  std::array<int, 2> count{};
  for (int axis = 0; axis < 2; ++axis) count[axis] = static_cast<int>((high[axis] - low[axis]) / spacing + kRowShift);
  const Vec2 first = 0.5 * (low + high) - 0.5 * spacing * Vec2(count[0], count[1]);
  std::vector<Vec2> inside;
  std::vector<Vec2> exact(outline.begin(), outline.end());
  // The outline is searched once for each row: a narrow diagonal panel has few of the lattice points around it.
  for (int j = 0; j <= count[1]; ++j) {
    const std::vector<double> crossings = crossings_at(rotated, first.y() + spacing * j);
    for (int i = 0; i <= count[0]; ++i) {
      const Vec2 p = first + spacing * Vec2(i, j);
      const auto below = std::ranges::lower_bound(crossings, p.x()) - crossings.begin();
      if (below % 2 == 0 || !is_far_from(rotated, p, kMinOutlineDistance * spacing)) continue;
      inside.emplace_back(p.x() + j * kRowShift * spacing, p.y());
      exact.emplace_back(p.x() * Vec2(warp.y(), -warp.x()) + p.y() * warp);
    }
  }
  FlatMesh mesh = triangulate(rotated, inside);
  mesh.points = std::move(exact);
  return mesh;
}

double polygon_area(std::span<const Vec2> outline) {
  double sum = 0;
  for (std::size_t i = 0; i < outline.size(); ++i)
    sum += 0.5 * cross(outline[i] - outline[0], outline[(i + 1) % outline.size()] - outline[0]);
  return sum;
}

std::optional<std::pair<std::size_t, std::size_t>> self_crossing(std::span<const Vec2> outline) {
  const std::size_t n = outline.size();
  const auto end = [&](std::size_t i) -> const Vec2& { return outline[(i + 1) % n]; };
  const auto left = [&](std::size_t i) { return std::min(outline[i].x(), end(i).x()); };
  const auto right = [&](std::size_t i) { return std::max(outline[i].x(), end(i).x()); };
  // Only sides whose ranges along x overlap can cross. In this order, those of a side follow it one after the other.
  std::vector<std::size_t> sides(n);
  std::iota(sides.begin(), sides.end(), std::size_t{0});
  std::ranges::stable_sort(sides, {}, left);
  for (std::size_t k = 0; k < n; ++k)
    for (std::size_t m = k + 1; m < n && left(sides[m]) <= right(sides[k]); ++m) {
      const auto [i, j] = std::minmax(sides[k], sides[m]);
      if (j - i == 1 || (i == 0 && j + 1 == n)) continue;
      const Vec2 &a = outline[i], &b = end(i), &c = outline[j], &d = end(j);
      // Skips sides whose bounding boxes do not overlap. Without this, collinear sides would always seem to cross,
      // because the orientations below are 0.
      if ((a.cwiseMax(b) - c.cwiseMin(d)).minCoeff() < 0 || (c.cwiseMax(d) - a.cwiseMin(b)).minCoeff() < 0) continue;
      if (orientation(a, b, c) * orientation(a, b, d) <= 0 && orientation(c, d, a) * orientation(c, d, b) <= 0)
        return std::pair(i, j);
    }
  return std::nullopt;
}

}  // namespace weft::garment
