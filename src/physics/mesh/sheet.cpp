#include "physics/mesh/sheet.hpp"

#include <algorithm>
#include <limits>

#include "physics/mesh/geometry.hpp"
#include "physics/mesh/quads.hpp"

namespace weft::mesh {
namespace {

// Minimum length of the projection of the unit vector x onto a triangle, with which weft follows x (0.1: x at 84° to
// the triangle). If the projection is shorter, warp follows the projection of y.
constexpr double kMinProjectedWeft = 0.1;

// Unit directions of weft and warp in a triangle with this normal.
std::array<Vec3, 2> axes(const Vec3& normal) {
  const Vec3 n = normal.normalized();
  Vec3 weft = Vec3::UnitX() - n.x() * n;
  if (weft.norm() < kMinProjectedWeft) weft = Vec3::UnitY().cross(n);
  weft.normalize();
  return {weft, n.cross(weft)};
}

}  // namespace

Sheet make_sheet_from_mesh(const Mesh& mesh) {
  Sheet sheet;
  sheet.triangles = mesh.topology.triangles;
  sheet.rest = mesh.positions;
  for (const Triangle& t : sheet.triangles) {
    const auto [weft, warp] = axes(area_vector(t, sheet.rest));
    auto& corners = sheet.material.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& x = sheet.rest[t[k]];
      corners[k] = {weft.dot(x), warp.dot(x)};
    }
  }
  return sheet;
}

double rest_area(const Sheet& sheet, std::size_t triangle) {
  const auto& m = sheet.material[triangle];
  const Vec2 a = m[1] - m[0], b = m[2] - m[0];
  return 0.5 * (a.x() * b.y() - a.y() * b.x());
}

double min_height(const Sheet& sheet) {
  return find_flat_triangles(sheet).least_height;
}

Mesh make_triangle_sheet(const Grid& grid, Pattern pattern) {
  Mesh sheet = make_sheet(grid);
  const std::vector<Quad> quads = std::move(sheet.topology.quads);
  sheet.topology = {};
  for (const Quad& q : quads) {
    if (pattern == Pattern::aligned) {
      for (const Triangle& t : split_quad(q, true)) sheet.topology.triangles.push_back(t);
      continue;
    }
    const auto middle = static_cast<Index>(sheet.positions.size());
    const auto a = static_cast<std::size_t>(q[0]), b = static_cast<std::size_t>(q[2]);
    sheet.positions.emplace_back(0.5 * (sheet.positions[a] + sheet.positions[b]));
    sheet.uv.emplace_back(0.5 * (sheet.uv[a] + sheet.uv[b]));
    for (std::size_t k = 0; k < 4; ++k) sheet.topology.triangles.push_back({q[k], q[(k + 1) % 4], middle});
  }
  return sheet;
}

FlatTriangles find_flat_triangles(const Sheet& sheet) {
  FlatTriangles found;
  found.least_height = std::numeric_limits<double>::infinity();
  std::vector<double> heights;
  for (std::size_t t = 0; t < sheet.triangles.size(); ++t) {
    const auto& m = sheet.material[t];
    const double longest = std::max({(m[1] - m[0]).norm(), (m[2] - m[1]).norm(), (m[0] - m[2]).norm()});
    const double height = heights.emplace_back(2 * rest_area(sheet, t) / longest);
    found.longest_edge = std::max(found.longest_edge, longest);
    if (height < found.least_height) found.least_height = height, found.flattest = t;
  }
  const double limit = found.longest_edge / kMaxEdgeToHeightRatio;
  found.count = static_cast<std::size_t>(std::ranges::count_if(heights, [&](double h) { return h < limit; }));
  return found;
}

}  // namespace weft::mesh
