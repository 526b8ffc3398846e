#include "physics/mesh/quads.hpp"

#include "physics/mesh/geometry.hpp"

namespace weft::mesh {
namespace {

/// Whether the two triangles of this split face the same way. If so, the diagonal lies inside the quad.
bool diagonal_inside(const Quad& q, bool first, std::span<const Vec3> x) {
  const auto [a, b] = split_quad(q, first);
  return area_vector(a, x).dot(area_vector(b, x)) > 0;
}

bool choose_first(const Quad& q, std::span<const Vec3> x) {
  const bool first_inside = diagonal_inside(q, true, x);
  if (first_inside != diagonal_inside(q, false, x)) return first_inside;
  const auto corner = [&](std::size_t k) -> const Vec3& { return x[q[k]]; };
  return (corner(2) - corner(0)).squaredNorm() <= (corner(3) - corner(1)).squaredNorm();
}

}  // namespace

std::vector<Triangle> split_quads(std::span<const Quad> quads, std::span<const Vec3> positions) {
  std::vector<Triangle> triangles;
  triangles.reserve(2 * quads.size());
  for (const Quad& q : quads)
    for (const Triangle& t : split_quad(q, choose_first(q, positions))) triangles.push_back(t);
  return triangles;
}

Mesh make_sheet(const Grid& grid) {
  Mesh sheet;
  const auto particles = static_cast<std::size_t>(grid.size());
  const auto quads = static_cast<std::size_t>(grid.nu - 1) * static_cast<std::size_t>(grid.nv - 1);
  sheet.positions.reserve(particles);
  sheet.uv.reserve(particles);
  sheet.topology.quads.reserve(quads);
  sheet.topology.triangles.reserve(2 * quads);
  for (int j = 0; j < grid.nv; ++j) {
    for (int i = 0; i < grid.nu; ++i) {
      sheet.uv.emplace_back(grid.u(i), grid.v(j));
      sheet.positions.emplace_back(grid.x(i), grid.y(j), 0);
    }
  }
  for (int j = 0; j + 1 < grid.nv; ++j) {
    for (int i = 0; i + 1 < grid.nu; ++i) {
      const Quad q{grid.index(i, j), grid.index(i + 1, j), grid.index(i + 1, j + 1), grid.index(i, j + 1)};
      sheet.topology.quads.push_back(q);
      for (const Triangle& t : split_quad(q, (i + j) % 2 == 0)) sheet.topology.triangles.push_back(t);
    }
  }
  return sheet;
}

}  // namespace weft::mesh
