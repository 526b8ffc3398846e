#include "physics/mesh/shapes.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "physics/mesh/quads.hpp"

namespace weft::mesh {
namespace {

constexpr double kPi = std::numbers::pi;

/// Minimum number of faces around an axis with which a shape encloses a volume.
constexpr int kMinSegments = 3;

Index add_vertex(Mesh& mesh, const Vec3& x) {
  mesh.positions.push_back(x);
  return static_cast<Index>(mesh.positions.size() - 1);
}

void add_quad(Mesh& mesh, const Quad& q, bool first_diagonal) {
  for (const Triangle& t : split_quad(q, first_diagonal)) mesh.topology.triangles.push_back(t);
}

/// Number of pieces of about the length `edge` into which `length` is cut, from 1 to `limit`.
/// Without the limit, long thin bars would get thousands of rows.
int piece_count(double length, double edge, int limit) {
  return static_cast<int>(std::clamp(std::round(length / edge), 1.0, static_cast<double>(limit)));
}

/// Point of a profile that is revolved around the z axis.
struct ProfilePoint {
  double radius, z;
};

/// Subdivides a profile so that the quads of the revolved surface are about square at radius `radius`.
std::vector<ProfilePoint> refine(const std::vector<ProfilePoint>& corners, double radius, int segments) {
  const double edge = 2 * kPi * radius / segments;
  std::vector<ProfilePoint> profile;
  for (std::size_t k = 0; k + 1 < corners.size(); ++k) {
    const auto [r0, z0] = corners[k];
    const auto [r1, z1] = corners[k + 1];
    const int count = piece_count(std::hypot(r1 - r0, z1 - z0), edge, segments);
    for (int i = 0; i < count; ++i) profile.push_back({r0 + (r1 - r0) * i / count, z0 + (z1 - z0) * i / count});
  }
  profile.push_back(corners.back());
  return profile;
}

/// Revolves a profile around the z axis. If the profile runs upward with the axis on its left, the surface faces
/// outward. A point on the axis (radius 0) becomes one vertex. If `closed`, the last point is joined to the first.
Mesh revolve(const std::vector<ProfilePoint>& profile, int segments, bool closed) {
  Mesh mesh;
  const auto around = static_cast<std::size_t>(segments);
  std::vector<std::vector<Index>> rings;
  for (const auto& [radius, z] : profile) {
    std::vector<Index> ring;
    if (radius == 0) {
      ring.assign(around, add_vertex(mesh, {0, 0, z}));
    } else {
      for (int k = 0; k < segments; ++k) {
        const double angle = 2 * kPi * k / segments;
        ring.push_back(add_vertex(mesh, {radius * std::cos(angle), radius * std::sin(angle), z}));
      }
    }
    rings.push_back(std::move(ring));
  }
  const std::size_t bands = closed ? rings.size() : rings.size() - 1;
  for (std::size_t b = 0; b < bands; ++b) {
    const auto& low = rings[b];
    const auto& high = rings[(b + 1) % rings.size()];
    for (std::size_t k = 0; k < around; ++k) {
      const Quad q{low[k], low[(k + 1) % around], high[(k + 1) % around], high[k]};
      if (q[0] == q[1]) {
        mesh.topology.triangles.push_back({q[0], q[2], q[3]});
      } else if (q[2] == q[3]) {
        mesh.topology.triangles.push_back({q[0], q[1], q[2]});
      } else {
        add_quad(mesh, q, (b + k) % 2 == 0);
      }
    }
  }
  return mesh;
}

/// The twelve corners of an icosahedron, cyclic permutations of (0, ±1, ±golden ratio), and its twenty faces. The axes
/// pass through the middles of edges.
Mesh icosahedron() {
  const double g = std::numbers::phi;
  Mesh mesh;
  mesh.positions = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                    {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  mesh.topology.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                             {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                             {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  return mesh;
}

}  // namespace

Mesh make_sphere(double radius, int segments) {
  // With n pieces per side, the measured mean length of a piece is 1.20 radius / n, so 5.24 n pieces go around the
  // sphere. An even n puts vertices on the axes.
  const int pieces_per_side = 2 * std::max(1, static_cast<int>(std::lround(segments / (2 * 5.24))));
  const Mesh coarse = icosahedron();
  Mesh mesh;
  // The key of a vertex lists the coarse corners with their integer weights, so that neighbouring
  // faces share the vertices on their common side.
  std::map<std::array<std::array<int, 2>, 3>, Index> known;
  for (const Triangle& side : coarse.topology.triangles) {
    const auto vertex = [&](int b, int c) {
      const std::array<int, 3> weights{pieces_per_side - b - c, b, c};
      std::array<std::array<int, 2>, 3> key{};
      for (std::size_t k = 0; k < 3; ++k)
        key[k] = weights[k] > 0 ? std::array{side[k] + 1, weights[k]} : std::array{0, 0};
      std::sort(key.begin(), key.end());
      const auto [entry, is_new] = known.try_emplace(key, static_cast<Index>(mesh.positions.size()));
      if (is_new) {
        Vec3 x = Vec3::Zero();
        for (const auto& [corner, weight] : key)
          if (weight > 0) x += weight * coarse.positions[corner - 1];
        add_vertex(mesh, radius * x.normalized());
      }
      return entry->second;
    };
    for (int b = 0; b < pieces_per_side; ++b) {
      for (int c = 0; b + c < pieces_per_side; ++c) {
        mesh.topology.triangles.push_back({vertex(b, c), vertex(b + 1, c), vertex(b, c + 1)});
        if (b + c + 1 < pieces_per_side)
          mesh.topology.triangles.push_back({vertex(b + 1, c), vertex(b + 1, c + 1), vertex(b, c + 1)});
      }
    }
  }
  return mesh;
}

Mesh make_cone(double radius, double height, int segments) {
  segments = std::max(segments, kMinSegments);
  const double h = 0.5 * height;
  return revolve(refine({{0, -h}, {radius, -h}, {0, h}}, radius, segments), segments, false);
}

Mesh make_cylinder(double radius, double height, int segments) {
  segments = std::max(segments, kMinSegments);
  const double h = 0.5 * height;
  return revolve(refine({{0, -h}, {radius, -h}, {radius, h}, {0, h}}, radius, segments), segments, false);
}

Mesh make_torus(double radius, double tube_radius, int segments) {
  segments = std::max(segments, kMinSegments);
  // Quads are about square at the outer equator. With a multiple of four quads around the tube, a ring of vertices lies
  // at the lowest height.
  const double edge = 2 * kPi * (radius + tube_radius) / segments;
  const int around_tube = 4 * std::max(2, static_cast<int>(std::lround(2 * kPi * tube_radius / edge / 4)));
  std::vector<ProfilePoint> circle;
  for (int k = 0; k < around_tube; ++k) {
    const double angle = 2 * kPi * k / around_tube;
    circle.push_back({radius + tube_radius * std::cos(angle), tube_radius * std::sin(angle)});
  }
  return revolve(circle, segments, true);
}

Mesh make_half_pipe(double radius, double length, double thickness, int segments) {
  const int steps = std::max(segments / 2, 2);
  const int rows = piece_count(length, kPi * radius / steps, std::max(segments, 2));
  const auto arc = static_cast<std::size_t>(steps) + 1;
  Mesh mesh;
  // Each row holds the profile: the inner arc from -y over the bottom to +y, then the outer arc the same way.
  for (int row = 0; row <= rows; ++row) {
    const double x = length * row / rows - 0.5 * length;
    for (const double r : {radius, radius + thickness}) {
      for (int k = 0; k <= steps; ++k) {
        // Set z = 0 exactly at the rims: the rounded sine of π is not 0.
        const bool rim = k == 0 || k == steps;
        const double angle = kPi * k / steps;
        add_vertex(mesh, {x, -r * std::cos(angle), rim ? 0.0 : -r * std::sin(angle)});
      }
    }
  }
  const auto inner = [&](int row, int k) { return static_cast<Index>(static_cast<std::size_t>(row) * 2 * arc) + k; };
  const auto outer = [&](int row, int k) { return inner(row, k) + static_cast<Index>(arc); };
  for (int row = 0; row < rows; ++row) {
    for (int k = 0; k < steps; ++k) {
      const bool parity = (row + k) % 2 == 0;
      add_quad(mesh, {inner(row, k), inner(row + 1, k), inner(row + 1, k + 1), inner(row, k + 1)}, parity);
      add_quad(mesh, {outer(row, k), outer(row, k + 1), outer(row + 1, k + 1), outer(row + 1, k)}, parity);
    }
    add_quad(mesh, {inner(row, 0), outer(row, 0), outer(row + 1, 0), inner(row + 1, 0)}, true);
    add_quad(mesh, {inner(row, steps), inner(row + 1, steps), outer(row + 1, steps), outer(row, steps)}, true);
  }
  for (int k = 0; k < steps; ++k) {
    add_quad(mesh, {inner(0, k), inner(0, k + 1), outer(0, k + 1), outer(0, k)}, true);
    add_quad(mesh, {inner(rows, k), outer(rows, k), outer(rows, k + 1), inner(rows, k + 1)}, true);
  }
  return mesh;
}

Mesh make_plane(const Vec2& size) {
  Mesh mesh = make_sheet({.nu = 2, .nv = 2, .lu = size.x(), .lv = size.y()});
  mesh.uv.clear();
  return mesh;
}

}  // namespace weft::mesh
