// Flat meshes of panels: exact outlines, large minimum angles, Delaunay property.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "film/garment/garment.hpp"
#include "film/garment/pattern.hpp"
#include "film/garment/triangulation.hpp"
#include "physics/mesh/topology.hpp"
#include "support/mesh_measures.hpp"

namespace weft::garment {
namespace {

// Returns the polygon with its sides cut into pieces of about `spacing`.
std::vector<Vec2> cut_sides(const std::vector<Vec2>& corners, double spacing) {
  std::vector<Vec2> points;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Vec2 &a = corners[k], &b = corners[(k + 1) % corners.size()];
    const int pieces = std::max(1, static_cast<int>(std::lround((b - a).norm() / spacing)));
    for (int i = 0; i < pieces; ++i) points.push_back(a + double(i) / pieces * (b - a));
  }
  return points;
}

const std::vector<Vec2> kL{{0, 0}, {1, 0}, {1, 0.4}, {0.4, 0.4}, {0.4, 1}, {0, 1}};
const std::vector<Vec2> kNotched{{0, 0}, {0.4, 0}, {0.5, 0.4}, {0.6, 0}, {1, 0}, {0.9, 0.8}, {0.1, 0.8}};

double area_of(const FlatMesh& mesh) {
  double sum = 0;
  for (const mesh::Triangle& t : mesh.triangles) {
    const auto p = [&](std::size_t k) { return mesh.points[t[k]]; };
    sum += polygon_area(std::vector<Vec2>{p(0), p(1), p(2)});
  }
  return sum;
}

TEST(PanelMeshes, FillTheirOutlineExactly) {
  for (const auto& corners : {kL, kNotched})
    for (double spacing : {0.1, 0.03, 0.011})
      for (double grain : {0.0, 0.4}) {
        const std::vector<Vec2> outline = cut_sides(corners, spacing);
        const FlatMesh mesh = mesh_panel(outline, {-std::sin(grain), std::cos(grain)}, spacing);
        // Tolerance: rounding of a sum of some thousand areas, 1e-16 m² each.
        EXPECT_NEAR(area_of(mesh), polygon_area(corners), 1e-12);
        const auto report = mesh::inspect(mesh.triangles, mesh.points.size());
        EXPECT_TRUE(report.manifold());
        ASSERT_EQ(report.border.size(), outline.size());
        for (std::size_t k = 0; k < outline.size(); ++k) EXPECT_EQ(mesh.points[k], outline[k]);
        for (const auto& [a, b] : report.border)
          EXPECT_TRUE(b - a == 1 || (a == 0 && b + 1 == static_cast<Index>(outline.size()))) << a << " " << b;
        const auto edges = mesh::collect_edges(mesh.triangles).edges.size();
        EXPECT_EQ(
            static_cast<long>(mesh.points.size()) - static_cast<long>(edges) + static_cast<long>(mesh.triangles.size()),
            1);  // Euler characteristic of a disc
      }
}

// The circumcircle of each triangle contains no point that is visible from the triangle; for a convex outline, no point
// at all.
TEST(PanelMeshes, AreDelaunay) {
  const std::vector<Vec2> outline = cut_sides({{0, 0}, {1, 0.1}, {0.9, 0.7}, {0.2, 0.8}}, 0.05);
  const FlatMesh mesh = mesh_panel(outline, {0, 1}, 0.05);
  for (const mesh::Triangle& t : mesh.triangles) {
    const Vec2 &a = mesh.points[t[0]], &b = mesh.points[t[1]], &c = mesh.points[t[2]];
    Eigen::Matrix2d sides;
    sides << 2 * (b - a).transpose(), 2 * (c - a).transpose();
    const Vec2 centre = sides.inverse() * Vec2(b.squaredNorm() - a.squaredNorm(), c.squaredNorm() - a.squaredNorm());
    // Tolerance of the radius: the mesher shifts rows by less than 1e-4 spacings, to make the choice of diagonals
    // unique.
    const double radius = (a - centre).norm() - 1e-4 * 0.05;
    for (const Vec2& p : mesh.points) EXPECT_GT((p - centre).norm(), radius - 1e-9);
  }
}

// In floating point 0.3 / 0.1 is less than 3. If it were rounded down to 2, the mesh would lack a row, and the strips
// along the outline would be one and a half spacings wide.
TEST(PanelMeshes, OfWholeSquaresAreSquaresUpToTheOutline) {
  const FlatMesh mesh = mesh_panel(cut_sides({{-0.2, 0}, {0.2, 0}, {0.2, 0.3}, {-0.2, 0.3}}, 0.1), {0, 1}, 0.1);
  EXPECT_EQ(mesh.points.size(), 5U * 4U);
  for (const mesh::Triangle& t : mesh.triangles) EXPECT_NEAR(support::smallest_angle(t, mesh.points), 45, 1e-9);
}

TEST(PanelMeshes, InnerLatticePointsHaveSixNeighbours) {
  const FlatMesh mesh = mesh_panel(cut_sides({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 0.05), {0, 1}, 0.05);
  std::map<Index, int> degree;
  for (const mesh::Edge& edge : mesh::collect_edges(mesh.triangles).edges)
    for (Index v : edge.vertices) ++degree[v];
  int inner = 0;
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    const Vec2& p = mesh.points[v];
    if ((p - Vec2(0.5, 0.5)).cwiseAbs().maxCoeff() > 0.35) continue;
    ++inner;
    EXPECT_EQ(degree[static_cast<Index>(v)], 6) << p.transpose();
  }
  EXPECT_GT(inner, 150);
}

// Triangles at corners of the outline may have smaller angles, because the angles of corners are given.
TEST(PanelMeshes, AnglesOfThePatternsThatShipAreAtLeast23Degrees) {
  for (const char* name : {"dress", "skirt", "tshirt"}) {
    const Pattern pattern = load_pattern(std::string(WEFT_SOURCE_DIR) + "/scenes/patterns/" + name + ".toml", "a test");
    for (double spacing : {0.03, 0.02, 0.0128}) {
      double min_angle = 180, mean = 0;
      std::size_t count = 0;
      for (const Panel& panel : pattern.panels) {
        std::vector<int> segments;
        for (const PanelEdge& edge : panel.edges)
          segments.push_back(std::max(1, static_cast<int>(std::lround(Arclength(edge.curves).length() / spacing))));
        const FlatMesh mesh = mesh_of(panel, segments, spacing);
        std::vector<Index> corners;
        Index at = 0;
        for (int n : segments) corners.push_back(at), at += n;
        for (const mesh::Triangle& t : mesh.triangles) {
          const double angle = support::smallest_angle(t, mesh.points);
          mean += angle, ++count;
          const bool at_corner =
              std::ranges::any_of(t, [&](Index v) { return std::ranges::find(corners, v) != corners.end(); });
          if (!at_corner) min_angle = std::min(min_angle, angle);
          EXPECT_GT(angle, 14) << name << ", " << panel.name << ", " << spacing;
        }
      }
      EXPECT_GT(min_angle, 23) << name << " at " << spacing;
      std::printf("%s at %g m: %zu triangles, least angle %.1f away from corners, mean of the least %.1f degrees\n",
                  name, spacing, count, min_angle, mean / static_cast<double>(count));
    }
  }
}

TEST(PanelMeshes, OutlinesThatCrossThemselvesAreFound) {
  EXPECT_FALSE(self_crossing(kL));
  EXPECT_FALSE(self_crossing(cut_sides(kNotched, 0.01)));
  EXPECT_TRUE(self_crossing(std::vector<Vec2>{{0, 0}, {1, 1}, {1, 0}, {0, 1}}));
  // This outline touches itself.
  EXPECT_TRUE(self_crossing(std::vector<Vec2>{{0, 0}, {1, 0}, {1, 1}, {0.5, 0}, {0, 1}}));
}

}  // namespace
}  // namespace weft::garment
