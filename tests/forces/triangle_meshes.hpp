// Triangulated sheets for tests: regular, crossed, Delaunay, stretched and graded.
#pragma once

#include <array>
#include <random>
#include <vector>

#include "physics/mesh/sheet.hpp"

namespace weft::forces::testing {

/// Determinant of the in-circle test: positive if d lies inside the circle through a, b, c (counter-clockwise). It is
/// of the order of the fourth power of the edge length, which is about one.
inline double in_circle(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  Mat3 m;
  int row = 0;
  for (const Vec2& p : {a, b, c}) m.row(row++) << (p - d).transpose(), (p - d).squaredNorm();
  return m.determinant();
}

/// Flips edges of a triangulation until it is Delaunay in the coordinates `p` (Lawson, "Software for C1 Surface
/// Interpolation", 1977).
inline void make_delaunay(std::vector<mesh::Triangle>& triangles, const std::vector<Vec2>& p) {
  const auto at = [&](Index i) -> const Vec2& { return p[i]; };
  for (bool turned = true; turned;) {
    turned = false;
    std::vector<char> touched(triangles.size());
    for (const mesh::Edge& edge : mesh::collect_edges(triangles).edges) {
      if (edge.triangles[1] < 0) continue;
      const auto s = static_cast<std::size_t>(edge.triangles[0]), t = static_cast<std::size_t>(edge.triangles[1]);
      if (touched[s] || touched[t]) continue;
      const auto opposite = [&](const mesh::Triangle& triangle) {
        std::size_t k = 0;
        while (triangle[k] == edge.vertices[0] || triangle[k] == edge.vertices[1]) ++k;
        return k;
      };
      const std::size_t k = opposite(triangles[s]);
      const Index r = triangles[s][k], a = triangles[s][(k + 1) % 3], b = triangles[s][(k + 2) % 3];
      const Index far = triangles[t][opposite(triangles[t])];
      if (in_circle(at(r), at(a), at(b), at(far)) < 1e-9) continue;
      triangles[s] = {r, a, far}, triangles[t] = {r, far, b};
      touched[s] = touched[t] = 1;
      turned = true;
    }
  }
}

/// The particles of a grid, each moved by up to `jitter` cells (border particles only along the border). The triangles
/// are Delaunay in grid coordinates (i, j), so triangles of cells that are not square are stretched like the cells.
inline mesh::Mesh delaunay_sheet(const mesh::Grid& grid, double jitter, unsigned seed) {
  mesh::Mesh sheet = mesh::make_triangle_sheet(grid, mesh::Pattern::aligned);
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> number(-jitter, jitter);
  std::vector<Vec2> places;
  for (int j = 0; j < grid.nv; ++j)
    for (int i = 0; i < grid.nu; ++i) {
      Vec2 moved(number(engine), number(engine));
      if (i == 0 || i + 1 == grid.nu) moved.x() = 0;
      if (j == 0 || j + 1 == grid.nv) moved.y() = 0;
      places.emplace_back(i + moved.x(), j + moved.y());
    }
  make_delaunay(sheet.topology.triangles, places);
  for (std::size_t k = 0; k < places.size(); ++k) {
    sheet.uv[k] = {places[k].x() * grid.lu, places[k].y() * grid.lv};
    sheet.positions[k] += Vec3(sheet.uv[k].x(), sheet.uv[k].y(), 0) -
                          Vec3(static_cast<double>(k % static_cast<std::size_t>(grid.nu)) * grid.lu,
                               static_cast<double>(k / static_cast<std::size_t>(grid.nu)) * grid.lv, 0);
  }
  return sheet;
}

/// A kind of mesh for a sheet of `size` metres with `cells` cells along its shorter side. Crossed meshes have fewer
/// cells, but as many particles.
struct Meshing {
  const char* name;
  mesh::Mesh (*make)(const Vec2& size, int cells);
};

inline mesh::Grid grid_with(const Vec2& size, int along, int across) {
  return {along + 1, across + 1, size.x() / along, size.y() / across};
}
inline mesh::Grid grid_of_squares(const Vec2& size, double cells) {
  const double l = size.minCoeff() / cells;
  return grid_with(size, static_cast<int>(size.x() / l + 0.5), static_cast<int>(size.y() / l + 0.5));
}

/// Grid with twice as many cells along warp and half as many along weft: cells have an aspect ratio of 4.
inline mesh::Grid grid_of_aspect_4(const Vec2& size, int cells) {
  const double l = size.minCoeff() / cells;
  return grid_with(size, static_cast<int>(size.x() / (2 * l) + 0.5), static_cast<int>(size.y() / (0.5 * l) + 0.5));
}

inline const std::array<Meshing, 6> kMeshings{{
    {"aligned",
     [](const Vec2& size, int cells) {
       return mesh::make_triangle_sheet(grid_of_squares(size, cells), mesh::Pattern::aligned);
     }},
    {"crossed",  // half as many cells give as many particles
     [](const Vec2& size, int cells) {
       return mesh::make_triangle_sheet(grid_of_squares(size, 0.75 * cells), mesh::Pattern::crossed);
     }},
    {"delaunay", [](const Vec2& size, int cells) { return delaunay_sheet(grid_of_squares(size, cells), 0.35, 7); }},
    {"stretched aligned",
     [](const Vec2& size, int cells) {
       return mesh::make_triangle_sheet(grid_of_aspect_4(size, cells), mesh::Pattern::aligned);
     }},
    {"stretched delaunay",
     [](const Vec2& size, int cells) { return delaunay_sheet(grid_of_aspect_4(size, cells), 0.3, 7); }},
    {"graded delaunay",  // cells are four times as large at one end as at the other
     [](const Vec2& size, int cells) {
       mesh::Mesh sheet = delaunay_sheet(grid_of_squares(size, cells), 0.35, 7);
       for (std::size_t k = 0; k < sheet.uv.size(); ++k) {
         const Vec2 fraction = sheet.uv[k].cwiseQuotient(size);
         sheet.uv[k] = size.cwiseProduct(Vec2(0.4 * fraction + 0.6 * fraction.cwiseProduct(fraction)));
         sheet.positions[k] = Vec3(sheet.uv[k].x() - 0.5 * size.x(), sheet.uv[k].y() - 0.5 * size.y(), 0);
       }
       return sheet;
     }},
}};

}  // namespace weft::forces::testing
