#include "physics/forces/triangle_curvature.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <map>
#include <numbers>

namespace weft::forces {
namespace {

using Point = std::complex<double>;

// Maximum number of triangle rings around an edge whose vertices define its slope. One suffices for nearly all edges;
// near a border, or if the vertices are nearly on a conic, two or three are necessary.
constexpr int kMaxRings = 3;
// Maximum norm of the correction of a slope's weights, relative to the norm of the uncorrected weights
// (across_opposite). A larger correction makes the slope a small difference of large numbers; fit_quadratic() then adds
// a ring.
constexpr double kMaxCorrection = 1;

/// Derivative of a function at the middle of an edge, along the outward normal of the edge's first triangle, as a
/// weighted sum of the function's values at vertices [1/m].
struct Slope {
  std::vector<std::pair<Index, double>> weights;
  bool depends_on_pins = false;  ///< `held` may change the weights: see fit_clamped()
};

/// Computes the slopes across the edges of a sheet; see curvature_stencils().
class Slopes {
 public:
  Slopes(const mesh::Sheet& sheet, std::span<const char> pinned, std::span<const char> held)
      : sheet_(sheet), edges_(mesh::collect_edges(sheet.triangles)), pinned_(pinned), held_(held) {}

  const mesh::EdgeSet& edges() const { return edges_; }
  Slope across(const mesh::Edge& edge) const;

 private:
  /// Triangles around an edge, unfolded into the plane of the first one.
  struct Patch {
    std::vector<std::pair<Index, std::array<Point, 3>>> triangles;
    // Vertices and their positions: the two ends of the edge, the two vertices opposite it, then others.
    std::vector<std::pair<Index, Point>> vertices;
    std::size_t last_ring = 0;  // index of the first triangle of the last ring
  };
  /// Oblique coordinates (a, b) of a point: point − middle = a along + b over. `middle` and `along` are those of the
  /// edge; `over` is the vector between the two vertices opposite the edge.
  struct Axes {
    Point middle, along, over;

    Vec2 operator()(const Point& at) const {
      const Point d = at - middle;
      return Vec2(cross(d, over), cross(along, d)) / cross(along, over);
    }
  };
  static double cross(const Point& a, const Point& b) { return (std::conj(a) * b).imag(); }
  bool is_held(Index triangle) const { return all_corners_marked(sheet_.triangles[at(triangle)], held_); }
  Eigen::VectorXd fit_quadratic(Patch& patch, const Axes& axes) const;
  Eigen::VectorXd fit_clamped(const Patch& patch, const Axes& axes) const;
  Eigen::VectorXd fit_in_front_of_clamp(const Patch& patch, const Axes& axes, const std::array<Point, 2>& clamp) const;
  void add_ring(Patch& patch) const;
  void add_neighbour(Patch& patch, std::size_t member, std::size_t side) const;
  std::size_t side_of(Index triangle, const mesh::Edge& edge) const;
  Point material(Index triangle, std::size_t corner) const {
    const Vec2& m = sheet_.material[at(triangle)][corner % 3];
    return {m.x(), m.y()};
  }

  const mesh::Sheet& sheet_;
  mesh::EdgeSet edges_;
  std::span<const char> pinned_, held_;
};

// Returns the index of this edge among the triangle's sides.
std::size_t Slopes::side_of(Index triangle, const mesh::Edge& edge) const {
  const auto& of = edges_.of_triangle[at(triangle)];
  const auto index = static_cast<Index>(&edge - edges_.edges.data());
  return static_cast<std::size_t>(std::find(of.begin(), of.end(), index) - of.begin());
}

// Adds the triangle beyond one side of patch.triangles[member], unfolded, if it exists and is not in the patch.
void Slopes::add_neighbour(Patch& patch, std::size_t member, std::size_t side) const {
  const auto [triangle, corners] = patch.triangles[member];
  const mesh::Edge& edge = edges_.edges[at(edges_.of_triangle[at(triangle)][side])];
  const Index next = edge.triangles[0] == triangle ? edge.triangles[1] : edge.triangles[0];
  if (next < 0 || std::ranges::any_of(patch.triangles, [&](const auto& t) { return t.first == next; })) return;
  // Both triangles are counter-clockwise, so the side runs in the opposite direction in the neighbour.
  const std::size_t m = side_of(next, edge);
  const Point from = corners[(side + 1) % 3], to = corners[side];
  Point turn = (to - from) / (material(next, m + 1) - material(next, m));
  turn /= std::abs(turn);
  const Point apex = from + turn * (material(next, m + 2) - material(next, m));
  std::array<Point, 3> places;
  places[m] = from, places[(m + 1) % 3] = to, places[(m + 2) % 3] = apex;
  patch.triangles.emplace_back(next, places);
  const Index vertex = sheet_.triangles[at(next)][(m + 2) % 3];
  if (std::ranges::none_of(patch.vertices, [&](const auto& v) { return v.first == vertex; }))
    patch.vertices.emplace_back(vertex, apex);
}

void Slopes::add_ring(Patch& patch) const {
  const std::size_t first = patch.last_ring, last = patch.triangles.size();
  patch.last_ring = last;
  for (std::size_t member = first; member < last; ++member)
    for (std::size_t side = 0; side < 3; ++side) add_neighbour(patch, member, side);
}

// Returns `weights` plus the smallest correction after which moments × weights = `wanted`. Each row of `moments`
// contains the values of one function at the vertices, and `wanted` its exact derivative. Returns an empty vector if
// the correction is too large or none exists.
Eigen::VectorXd correct_weights(const Eigen::VectorXd& weights, const Eigen::MatrixXd& moments,
                                const Eigen::VectorXd& wanted) {
  const Eigen::VectorXd moment_error = wanted - moments * weights;
  const Eigen::VectorXd correction = moments.completeOrthogonalDecomposition().solve(moment_error);
  if ((moments * correction - moment_error).norm() < kRoundoff &&
      correction.norm() < kMaxCorrection * std::numbers::sqrt2)
    return weights + correction;
  return {};
}

// Weights of the difference between the two vertices opposite the edge: ∂/∂b (see Axes), exact for linear functions.
Eigen::VectorXd across_opposite(std::size_t count) {
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(count));
  weights[3] = 1, weights[2] = -1;
  return weights;
}

// Corrects the weights of across_opposite() so that the slope is exact for quadratic functions. The result is invariant
// under linear maps of the patch, so that stretched meshes are as accurate as others.
Eigen::VectorXd Slopes::fit_quadratic(Patch& patch, const Axes& axes) const {
  for (int ring = 1; ring <= kMaxRings; ++ring) {
    add_ring(patch);
    const auto count = static_cast<Eigen::Index>(patch.vertices.size());
    Eigen::MatrixXd moments(6, count);
    for (Eigen::Index k = 0; k < count; ++k) {
      const Vec2 d = axes(patch.vertices[k].second);
      moments.col(k) << 1, d.x(), d.y(), d.x() * d.x(), d.x() * d.y(), d.y() * d.y();
    }
    Eigen::VectorXd weights =
        correct_weights(across_opposite(patch.vertices.size()), moments, Eigen::VectorXd::Unit(6, 2));
    if (weights.size() > 0) return weights;
  }
  // No suitable weights: usually, too few vertices are near, as in a mesh of one or two triangles,
  // or at a corner of a mesh.
  return across_opposite(patch.vertices.size());
}

// Weights of the slope in a patch with held triangles (three held corners). Empty if no triangle is
// held, or if correct_weights() finds no weights.
Eigen::VectorXd Slopes::fit_clamped(const Patch& patch, const Axes& axes) const {
  // If a triangle at the edge is held, the slope is that of the linear function through its corners.
  for (std::size_t member : {0, 1}) {
    if (!is_held(patch.triangles[member].first)) continue;
    const std::size_t apex = 2 + member;
    const Vec2 d = axes(patch.vertices[apex].second);
    Eigen::VectorXd weights = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(patch.vertices.size()));
    weights[static_cast<Eigen::Index>(apex)] = 1 / d.y();
    weights[0] = (-0.5 + d.x()) / d.y(), weights[1] = (-0.5 - d.x()) / d.y();
    return weights;
  }
  // Finds the nearest clamp: a side between a held triangle and one that is not held.
  double nearest = std::numeric_limits<double>::infinity();
  std::array<Point, 2> clamp;
  for (const auto& [triangle, corners] : patch.triangles) {
    if (!is_held(triangle)) continue;
    for (std::size_t side = 0; side < 3; ++side) {
      const mesh::Edge& edge = edges_.edges[at(edges_.of_triangle[at(triangle)][side])];
      const Index next = edge.triangles[0] == triangle ? edge.triangles[1] : edge.triangles[0];
      const Point from = corners[side], to = corners[(side + 1) % 3];
      const double distance = std::abs(0.5 * (from + to) - axes.middle);
      if (next < 0 || is_held(next) || distance >= nearest) continue;
      nearest = distance;
      clamp = {from, to};
    }
  }
  return std::isinf(nearest) ? Eigen::VectorXd() : fit_in_front_of_clamp(patch, axes, clamp);
}

// Weights of a slope that is exact for linear functions and for s². s is the distance in front of
// the clamp, and 0 at the vertices of held triangles. The held triangle is on the left of the edge
// `clamp`. Empty if correct_weights() finds none.
Eigen::VectorXd Slopes::fit_in_front_of_clamp(const Patch& patch, const Axes& axes,
                                              const std::array<Point, 2>& clamp) const {
  const Point line = clamp[1] - clamp[0];
  // The distance is in units of the clamp's length, so that the moments are about 1.
  const auto distance = [&](const Point& at) { return std::max(0.0, cross(at - clamp[0], line) / std::norm(line)); };
  const auto count = static_cast<Eigen::Index>(patch.vertices.size());
  std::vector<char> in_clamp(patch.vertices.size());
  for (const auto& [triangle, corners] : patch.triangles) {
    if (!is_held(triangle)) continue;
    for (std::size_t k = 0; k < in_clamp.size(); ++k)
      for (Index corner : sheet_.triangles[at(triangle)]) in_clamp[k] |= patch.vertices[k].first == corner;
  }
  Eigen::MatrixXd moments(4, count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const Vec2 d = axes(patch.vertices[k].second);
    const double s = in_clamp[k] ? 0 : distance(patch.vertices[k].second);
    moments.col(k) << 1, d.x(), d.y(), s * s;
  }
  const double across = cross(axes.over, line) / std::norm(line);  // ∂s/∂b
  const Eigen::Vector4d wanted(0, 0, 1, 2 * distance(axes.middle) * across);
  return correct_weights(across_opposite(patch.vertices.size()), moments, wanted);
}

Slope Slopes::across(const mesh::Edge& edge) const {
  const Index triangle = edge.triangles[0];
  const std::size_t side = side_of(triangle, edge);
  Patch patch;
  patch.triangles.push_back({triangle, {material(triangle, 0), material(triangle, 1), material(triangle, 2)}});
  for (std::size_t k : {side, (side + 1) % 3, (side + 2) % 3})
    patch.vertices.emplace_back(sheet_.triangles[at(triangle)][k], material(triangle, k));
  add_neighbour(patch, 0, side);
  if (patch.vertices.size() < 4) return {};  // both triangles have the same corners

  const Point p = patch.vertices[0].second, q = patch.vertices[1].second;
  const Axes axes{0.5 * (p + q), q - p, patch.vertices[3].second - patch.vertices[2].second};
  Eigen::VectorXd best = fit_quadratic(patch, axes);
  Slope slope;
  slope.depends_on_pins = std::ranges::any_of(
      patch.triangles, [&](const auto& t) { return all_corners_marked(sheet_.triangles[at(t.first)], pinned_); });
  if (slope.depends_on_pins)
    if (const Eigen::VectorXd of_clamp = fit_clamped(patch, axes); of_clamp.size() > 0) best = of_clamp;

  // Converts the derivative along `over` to that along the outward normal n. With the unit tangent t, over = c t + d n.
  const double length = std::abs(axes.along), c = (std::conj(axes.along) * axes.over).real() / length,
               d = -cross(axes.along, axes.over) / length;
  best[1] -= c / length;
  best[0] += c / length;
  for (Eigen::Index k = 0; k < best.size(); ++k) slope.weights.emplace_back(patch.vertices[k].first, best[k] / d);
  return slope;
}

// The symmetric part of a matrix as (uu, vv, √2 uv): the dot product of two such vectors is the
// Frobenius product of the symmetric parts.
Vec3 packed(const Eigen::Matrix2d& m) {
  return {m(0, 0), m(1, 1), std::numbers::sqrt2 * 0.5 * (m(0, 1) + m(1, 0))};
}

// Projection that removes the curvature across the border edges of a triangle (see
// curvature_stencils()). `border_normals`: packed(n nᵀ) for each border edge, with its normal n.
Mat3 project_out_borders(const std::vector<Vec3>& border_normals) {
  Mat3 p = Mat3::Identity();
  for (const Vec3& direction : border_normals) {
    const Vec3 rest = p * direction;
    // Two parallel borders count once.
    if (rest.norm() > 1e-6) p -= rest * rest.transpose() / rest.squaredNorm();
  }
  return p;
}

}  // namespace

std::vector<CurvatureStencil> curvature_stencils(const mesh::Sheet& sheet, std::span<const char> pinned,
                                                 std::span<const char> held) {
  const Slopes slopes(sheet, pinned, held);
  const mesh::EdgeSet& edges = slopes.edges();
  std::vector<Slope> across(edges.edges.size());
  for (std::size_t e = 0; e < across.size(); ++e)
    if (edges.edges[e].triangles[1] >= 0) across[e] = slopes.across(edges.edges[e]);

  std::vector<CurvatureStencil> stencils(sheet.triangles.size());
  for (std::size_t t = 0; t < stencils.size(); ++t) {
    const auto& m = sheet.material[t];
    const mesh::Triangle& corners = sheet.triangles[t];
    const double area = mesh::rest_area(sheet, t);
    std::map<Index, Vec3> weights;
    const auto add = [&](Index vertex, const Vec3& weight) {
      weights.try_emplace(vertex, Vec3::Zero()).first->second += weight;
    };
    std::vector<Vec3> border_normals;
    bool depends_on_pins = false;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec2 side = m[(k + 1) % 3] - m[k], along = side.normalized(), outward(along.y(), -along.x());
      const Vec3 twist = packed(outward * along.transpose()) / area;  // the factor l cancels the 1/l of ∂s/∂t
      add(corners[(k + 1) % 3], twist);
      add(corners[k], -twist);
      const Vec3 bend = packed(outward * outward.transpose());
      const auto e = at(edges.of_triangle[t][k]);
      if (across[e].weights.empty()) border_normals.push_back(bend);
      const double sign = edges.edges[e].triangles[0] == static_cast<Index>(t) ? 1 : -1;
      depends_on_pins |= across[e].depends_on_pins;
      for (const auto& [vertex, slope] : across[e].weights) add(vertex, sign * slope * side.norm() / area * bend);
    }
    const Mat3 border_projection = project_out_borders(border_normals);
    const auto append = [&](Index vertex, Vec3 weight) {
      weight = border_projection * weight;
      weight.z() /= std::numbers::sqrt2;
      stencils[t].vertices.push_back(vertex);
      stencils[t].weights.push_back(weight);
    };
    for (Index corner : corners) append(corner, weights.at(corner));
    // Omits vertices whose weights cancel by symmetry up to rounding, unless pins may change the weights.
    for (const auto& [vertex, weight] : weights)
      if (std::find(corners.begin(), corners.end(), vertex) == corners.end() &&
          (depends_on_pins || weight.norm() * area > kRoundoff))
        append(vertex, weight);
  }
  return stencils;
}

}  // namespace weft::forces
