#include "film/garment/uv_rest.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/disjoint_sets.hpp"
#include "physics/mesh/geometry.hpp"
#include "physics/mesh/topology.hpp"

namespace weft::garment {
namespace {

// If the scales along u and v differ by at most this ratio, one scale is used for both. Such a difference may come from
// the stretch of hanging cloth, which is some percent in one direction.
constexpr double kMaxScaleDifference = 0.05;
// UVs are in one of the units below if more than kMinFractionInUnit of all edges (weighted by length in the UVs) are as
// long as in the mesh within kUnitTolerance (relative).
constexpr double kUnitTolerance = 0.02, kMinFractionInUnit = 0.2;
constexpr std::array<std::pair<double, const char*>, 4> kUnits{
    {{1, "metres"}, {0.01, "centimetres"}, {0.001, "millimetres"}, {0.0254, "inches"}}};
// The UVs of a triangle are unusable if the triangle is longer or shorter in the mesh by this factor or more. For
// comparison: before sewing, triangles can be 36 times as long as in their pattern.
constexpr double kMaxSizeRatio = 100;
// Number of rounds of iteratively reweighted least squares that fit the scale.
constexpr int kScaleRounds = 30;
// Maximum relative difference in length of an edge that fits (UvRest::fitting_edge_fraction).
constexpr double kFittingEdgeTolerance = 0.05;

/// An edge of a triangle.
struct UvEdge {
  double du, dv, length;  // du, dv in the UVs; length in the mesh [m]
};

bool has_uv(const UvCorners& c) {
  return c[0].allFinite() && c[1].allFinite() && c[2].allFinite();
}

double twice_area(const UvCorners& c) {
  const Vec2 a = c[1] - c[0], b = c[2] - c[0];
  return a.x() * b.y() - a.y() * b.x();
}

/// A triangle of the mesh, rotated into the plane.
UvCorners flatten_triangle(const mesh::Triangle& t, std::span<const Vec3> x) {
  const Vec3 a = x[at(t[1])] - x[at(t[0])], b = x[at(t[2])] - x[at(t[0])];
  const double length = a.norm(), along = b.dot(a) / length;
  return {Vec2(0, 0), Vec2(length, 0), Vec2(along, a.cross(b).norm() / length)};
}

std::vector<UvEdge> edges_of(const mesh::Mesh& mesh, std::span<const UvCorners> uv) {
  std::vector<UvEdge> edges;
  for (std::size_t t = 0; t < uv.size(); ++t) {
    if (!has_uv(uv[t])) continue;
    const mesh::Triangle& triangle = mesh.topology.triangles[t];
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec2 d = uv[t][(k + 1) % 3] - uv[t][k];
      const double length = (mesh.positions[at(triangle[(k + 1) % 3])] - mesh.positions[at(triangle[k])]).norm();
      if (d.squaredNorm() > 0) edges.push_back({d.x(), d.y(), length});
    }
  }
  return edges;
}

/// Weighted quantile: the smallest value such that all values up to it have at least `fraction` of the total weight. 0
/// if there are no values. `values`: pairs of value and weight.
double quantile(std::vector<std::pair<double, double>> values, double fraction) {
  double total = 0, sum = 0;
  for (const auto& [value, weight] : values) total += weight;
  std::ranges::sort(values);
  for (const auto& [value, weight] : values)
    if ((sum += weight) >= fraction * total) return value;
  return 0;
}

/// Median length of one UV unit [m]. Edges are weighted by their length in the UVs, because weights by length in the
/// mesh would favour stretched edges.
double median_scale(const std::vector<UvEdge>& edges) {
  std::vector<std::pair<double, double>> ratios;
  for (const UvEdge& e : edges) {
    const double in_uv = std::hypot(e.du, e.dv);
    ratios.emplace_back(e.length / in_uv, in_uv);
  }
  return quantile(std::move(ratios), 0.5);
}

/// Fits the lengths (su, sv) of a UV unit along u and v, so that (su du)² + (sv dv)² is the squared length of edges in
/// the mesh. Minimises the sum of absolute relative errors of squared lengths, weighted by length in the UVs, by
/// iteratively reweighted least squares. `even`: start value of both lengths. Returns nothing if the edges do not
/// determine both.
std::optional<Vec2> fit_anisotropic_scale(const std::vector<UvEdge>& edges, double even) {
  Vec2 squares = Vec2::Constant(even * even);
  for (int round = 0; round < kScaleRounds; ++round) {
    Eigen::Matrix2d matrix = Eigen::Matrix2d::Zero();
    Vec2 right = Vec2::Zero();
    for (const UvEdge& e : edges) {
      const Vec2 row = Vec2(e.du * e.du, e.dv * e.dv) / (e.length * e.length);
      const double weight = std::hypot(e.du, e.dv) / std::max(1e-4, std::abs(row.dot(squares) - 1));
      matrix += weight * row * row.transpose();
      right += weight * row;
    }
    const double trace = matrix.trace();
    if (!(matrix.determinant() > kRoundoff * trace * trace)) return std::nullopt;
    const Vec2 next = matrix.inverse() * right;
    if (!(next.minCoeff() > 0)) return std::nullopt;
    squares = next;
  }
  return Vec2(squares.cwiseSqrt());
}

/// Fraction of all edges, weighted by length in the UVs, whose scaled length in the UVs differs from that in the mesh
/// by at most `tolerance` (relative).
double fraction_of_fitting_edges(const std::vector<UvEdge>& edges, const Vec2& scale, double tolerance) {
  double fitting = 0, total = 0;
  for (const UvEdge& e : edges) {
    const double in_uv = std::hypot(e.du, e.dv);
    total += in_uv;
    if (std::abs(std::hypot(scale.x() * e.du, scale.y() * e.dv) / e.length - 1) <= tolerance) fitting += in_uv;
  }
  return total > 0 ? fitting / total : 0;
}

/// Finds scale and unit, and writes them to `rest`.
void measure_scale(const std::vector<UvEdge>& edges, UvRest& rest) {
  double best = kMinFractionInUnit;
  for (const auto& [length, name] : kUnits)
    if (const double fraction = fraction_of_fitting_edges(edges, Vec2::Constant(length), kUnitTolerance);
        fraction > best)
      best = fraction, rest.scale = Vec2::Constant(length), rest.unit = name;
  if (!rest.unit.empty() || edges.empty()) return;
  const double even = median_scale(edges);
  const auto both = fit_anisotropic_scale(edges, even);
  const bool differ = both && std::abs(std::log(both->x() / both->y())) > std::log1p(kMaxScaleDifference);
  rest.scale = differ ? *both : Vec2::Constant(even);
}

/// Singular values of the linear map from a triangle's rest shape to its shape in the mesh.
Vec2 principal_stretches(const UvCorners& from, const UvCorners& to) {
  Eigen::Matrix2d a, b;
  a << from[1] - from[0], from[2] - from[0];
  b << to[1] - to[0], to[2] - to[0];
  // A 2×2 matrix is the sum of a scaled rotation and a scaled reflection.
  const Eigen::Matrix2d map = b * a.inverse();
  const double rotation = 0.5 * std::hypot(map(0, 0) + map(1, 1), map(1, 0) - map(0, 1));
  const double reflection = 0.5 * std::hypot(map(0, 0) - map(1, 1), map(1, 0) + map(0, 1));
  return {rotation + reflection, std::abs(rotation - reflection)};
}

std::size_t count_islands(const mesh::Mesh& mesh, std::span<const UvCorners> uv) {
  DisjointSets sets(uv.size());
  const auto corner = [&](Index triangle, Index vertex) {
    const mesh::Triangle& t = mesh.topology.triangles[at(triangle)];
    return uv[at(triangle)][static_cast<std::size_t>(std::ranges::find(t, vertex) - t.begin())];
  };
  for (const mesh::Edge& edge : mesh::collect_edges(mesh.topology.triangles).edges) {
    const Index a = edge.triangles[0], b = edge.triangles[1];
    if (b < 0) continue;
    if (std::ranges::all_of(edge.vertices, [&](Index v) { return corner(a, v) == corner(b, v); })) sets.join(a, b);
  }
  std::size_t islands = 0;
  for (std::size_t t = 0; t < uv.size(); ++t)
    islands += has_uv(uv[t]) && sets.root(static_cast<Index>(t)) == static_cast<Index>(t);
  return islands;
}

/// Gives triangles that are flat in the panel the shape that they have in the mesh, if they are higher there. A
/// triangle is flat if its height is less than `flattest` times the longest edge of all panel triangles. Counts
/// replaced triangles as unusable, and adds the area that they lack in the panel [m²] to `unusable_area`.
void replace_flat_triangles(const mesh::Mesh& mesh, double flattest, UvRest& rest) {
  const auto longest_edge = [](const UvCorners& c) {
    return std::max({(c[1] - c[0]).norm(), (c[2] - c[1]).norm(), (c[0] - c[2]).norm()});
  };
  double longest = 0;
  for (const UvCorners& c : rest.material) longest = std::max(longest, longest_edge(c));
  for (std::size_t t = 0; t < rest.material.size(); ++t) {
    UvCorners& panel = rest.material[t];
    const auto height = [&](const UvCorners& c) { return twice_area(c) / longest_edge(c); };
    const UvCorners own = flatten_triangle(mesh.topology.triangles[t], mesh.positions);
    if (height(panel) >= flattest * longest || height(own) <= height(panel)) continue;
    rest.unusable_area += std::max(0.0, 0.5 * (twice_area(own) - twice_area(panel)));
    panel = own;
    ++rest.unusable;
  }
}

}  // namespace

bool UvRest::has_panel_lengths() const {
  return unusable_area < 0.01 && fitting_edge_fraction >= 0.5;
}

std::string UvRest::describe() const {
  const std::string length = scale.x() == scale.y() ? fmt::format("1 unit = {:.4g} m", scale.x())
                                                    : fmt::format("1 unit = {:.4g} by {:.4g} m", scale.x(), scale.y());
  return fmt::format(
      "{} island{}, {}{}, {:.0f} % of all edges as long as in the mesh within 5 %; its triangles are off by {:.1f} % "
      "(median), 95 % of them by at most {:.1f} %",
      islands, islands == 1 ? "" : "s", length, unit.empty() ? "" : " (" + unit + ")", 100 * fitting_edge_fraction,
      100 * median_stretch, 100 * stretch_quantile_95);
}

UvRest rest_from_uv(const mesh::Mesh& mesh, std::span<const UvCorners> uv, const std::optional<Vec2>& scale,
                    double flattest) {
  UvRest rest;
  if (uv.empty()) return rest;
  const std::vector<UvEdge> edges = edges_of(mesh, uv);
  if (scale)
    rest.scale = *scale;
  else
    measure_scale(edges, rest);
  rest.fitting_edge_fraction = fraction_of_fitting_edges(edges, rest.scale, kFittingEdgeTolerance);
  rest.islands = count_islands(mesh, uv);
  std::vector<std::pair<double, double>> deviations;
  double total = 0;
  for (std::size_t t = 0; t < uv.size(); ++t) {
    const UvCorners own = flatten_triangle(mesh.topology.triangles[t], mesh.positions);
    const double area = 0.5 * twice_area(own);
    total += area;
    UvCorners& panel = rest.material.emplace_back(uv[t]);
    for (Vec2& c : panel) c = c.cwiseProduct(rest.scale);
    if (twice_area(panel) < 0) {
      // The triangle is mirrored in the UVs. Exchanges left and right.
      for (Vec2& c : panel) c.x() = -c.x();
      ++rest.mirrored;
    }
    const Vec2 stretch = has_uv(panel) && twice_area(panel) != 0 ? principal_stretches(panel, own) : Vec2(0, 0);
    if (!(stretch.x() < kMaxSizeRatio) || !(stretch.y() > 1 / kMaxSizeRatio)) {
      panel = own;
      ++rest.unusable;
      rest.unusable_area += area;
      continue;
    }
    deviations.emplace_back(std::max(std::abs(stretch.x() - 1), std::abs(stretch.y() - 1)), area);
  }
  replace_flat_triangles(mesh, flattest, rest);
  rest.unusable_area /= total;
  rest.median_stretch = quantile(deviations, 0.5);
  rest.stretch_quantile_95 = quantile(deviations, 0.95);
  return rest;
}

}  // namespace weft::garment
