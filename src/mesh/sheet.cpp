#include "mesh/sheet.hpp"

#include <algorithm>
#include <limits>

#include "mesh/geometry.hpp"
#include "mesh/quads.hpp"

namespace weft::mesh {
namespace {

// Share of x left in the plane of a triangle below which its direction there is taken from the warp [1]: a slope of
// 84°.
constexpr double kAcross = 0.1;

// Unit directions of weft and warp in a triangle with this normal.
std::array<Vec3, 2> axes(const Vec3& normal) {
  const Vec3 n = normal.normalized();
  Vec3 weft = Vec3::UnitX() - n.x() * n;
  if (weft.norm() < kAcross) weft = Vec3::UnitY().cross(n);
  weft.normalize();
  return {weft, n.cross(weft)};
}

}  // namespace

Sheet make_sheet_of(const Mesh& mesh) {
  Sheet sheet{mesh.topology.triangles, mesh.positions, {}};
  for (const Triangle& t : sheet.triangles) {
    const auto [weft, warp] = axes(area_vector(t, sheet.rest));
    auto& corners = sheet.material.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& x = sheet.rest[static_cast<std::size_t>(t[k])];
      corners[k] = {weft.dot(x), warp.dot(x)};
    }
  }
  return sheet;
}

double least_height(const Sheet& sheet) {
  double least = std::numeric_limits<double>::infinity();
  for (const Triangle& t : sheet.triangles) {
    const auto corner = [&](std::size_t k) -> const Vec3& { return sheet.rest[static_cast<std::size_t>(t[k])]; };
    const double longest =
        std::max({(corner(1) - corner(0)).norm(), (corner(2) - corner(1)).norm(), (corner(0) - corner(2)).norm()});
    least = std::min(least, 2 * area_vector(t, sheet.rest).norm() / longest);
  }
  return least;
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

}  // namespace weft::mesh
