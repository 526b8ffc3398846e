// The rest shape of a mesh from its UVs.
#include "film/garment/uv_rest.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "physics/mesh/shapes.hpp"
#include "physics/mesh/topology.hpp"

namespace weft::garment {
namespace {

struct Textured {
  mesh::Mesh mesh;
  std::vector<UvCorners> uv;

  std::vector<UvCorners> scaled(const Vec2& by) const {
    std::vector<UvCorners> result = uv;
    for (UvCorners& corners : result)
      for (Vec2& c : corners) c = c.cwiseProduct(by);
    return result;
  }
};

// A tube of two pleated panels. A pattern point (u, v) lies at arc length u along a regular zigzag around a circle, so
// all mesh edges along u or v have the same lengths as in the pattern. In the pattern, the second panel is mirrored.
Textured pleated_tube() {
  constexpr int kAround = 24, kUp = 6;
  constexpr double kStep = 0.02;
  Textured tube;
  const double angle = 2 * std::numbers::pi / kAround;
  // The two radii for which neighbouring points are one step apart.
  const double inner = 0.07,
               outer = inner * std::cos(angle) + std::sqrt(kStep * kStep - std::pow(inner * std::sin(angle), 2));
  for (int j = 0; j <= kUp; ++j)
    for (int i = 0; i < kAround; ++i) {
      const double r = i % 2 == 0 ? inner : outer;
      tube.mesh.positions.emplace_back(r * std::cos(i * angle), r * std::sin(i * angle), kStep * j);
    }
  for (int j = 0; j < kUp; ++j)
    for (int i = 0; i < kAround; ++i) {
      const bool behind = i >= kAround / 2;
      const auto at = [&](int column, int row) { return static_cast<Index>(column % kAround + kAround * row); };
      const auto uv = [&](int column, int row) {
        const Vec2 p = kStep * Vec2(behind ? column - kAround / 2 : column, row);
        return behind ? Vec2(1 - p.x(), p.y()) : p;
      };
      const std::array<std::pair<int, int>, 4> c{{{i, j}, {i + 1, j}, {i + 1, j + 1}, {i, j + 1}}};
      for (const auto& [a, b, d] : {std::array{0, 1, 2}, std::array{0, 2, 3}}) {
        tube.mesh.topology.triangles.push_back(
            {at(c[a].first, c[a].second), at(c[b].first, c[b].second), at(c[d].first, c[d].second)});
        tube.uv.push_back({uv(c[a].first, c[a].second), uv(c[b].first, c[b].second), uv(c[d].first, c[d].second)});
      }
    }
  return tube;
}

// Rounding error of lengths below a metre.
constexpr double kRounding = 1e-12;

TEST(UvRest, IslandsArePanelsAlsoThoseDrawnFromBehind) {
  const Textured tube = pleated_tube();
  const UvRest rest = rest_from_uv(tube.mesh, tube.uv, std::nullopt);
  EXPECT_EQ(rest.islands, 2U);
  EXPECT_EQ(rest.mirrored, tube.uv.size() / 2);
  EXPECT_EQ(rest.unit, "metres");
  EXPECT_EQ(rest.unusable, 0U);
  EXPECT_TRUE(rest.has_panel_lengths());
  EXPECT_LT(rest.stretch_quantile_95, 1e-9);
  for (std::size_t t = 0; t < tube.uv.size(); ++t) {
    const UvCorners& m = rest.material[t];
    const Vec2 a = m[1] - m[0], b = m[2] - m[0];
    EXPECT_NEAR(a.x() * b.y() - a.y() * b.x(), 0.02 * 0.02, kRounding) << t;
  }
}

TEST(UvRest, TheSizeIsMeasuredOrAUnitOrGiven) {
  const Textured tube = pleated_tube();
  const auto scale_of = [&](const Vec2& by) { return rest_from_uv(tube.mesh, tube.scaled(by), std::nullopt); };
  EXPECT_EQ(scale_of({100, 100}).unit, "centimetres");
  EXPECT_EQ(scale_of({1.01, 1.01}).scale, Vec2(1, 1)) << "a garment that is stretched by a percent";
  const UvRest even = scale_of({0.7, 0.7});
  EXPECT_EQ(even.unit, "");
  EXPECT_NEAR(even.scale.x(), 1 / 0.7, 1e-9);
  EXPECT_EQ(even.scale.x(), even.scale.y());
  const UvRest uneven = scale_of({0.7, 1.9});
  EXPECT_NEAR(uneven.scale.x(), 1 / 0.7, 1e-6);
  EXPECT_NEAR(uneven.scale.y(), 1 / 1.9, 1e-6);
  EXPECT_TRUE(uneven.has_panel_lengths());
  const UvRest given = rest_from_uv(tube.mesh, tube.uv, Vec2(2, 3));
  EXPECT_EQ(given.scale, Vec2(2, 3));
  EXPECT_FALSE(given.has_panel_lengths());
  EXPECT_NEAR(given.stretch_quantile_95, 1 - 1.0 / 3, 1e-9);
}

// One row of edges is stretched far. It must not change the scale of the rest shape.
TEST(UvRest, SeamsThatAreStretchedDoNotCount) {
  Textured tube = pleated_tube();
  for (std::size_t v = 0; v < 24; ++v) tube.mesh.positions[v].z() -= 0.5;  // the lowest ring
  const UvRest rest = rest_from_uv(tube.mesh, tube.uv, std::nullopt);
  EXPECT_EQ(rest.scale, Vec2(1, 1));
  EXPECT_TRUE(rest.has_panel_lengths());
  EXPECT_GT(rest.stretch_quantile_95, 10);
}

TEST(UvRest, TrianglesWithoutAreaKeepThatOfTheMesh) {
  Textured tube = pleated_tube();
  tube.uv[0] = {Vec2(0, 0), Vec2(0, 0), Vec2(0, 0)};
  tube.uv[1][2].x() = std::numeric_limits<double>::quiet_NaN();
  const UvRest rest = rest_from_uv(tube.mesh, tube.uv, std::nullopt);
  EXPECT_EQ(rest.unusable, 2U);
  EXPECT_NEAR(rest.unusable_area, 2.0 / static_cast<double>(tube.uv.size()), 1e-9);
  EXPECT_NEAR((rest.material[0][1] - rest.material[0][0]).norm(), 0.02, kRounding);
}

TEST(UvRest, TheAreaThatFlatTrianglesLackIsUnusable) {
  const Textured tube = pleated_tube();
  std::vector<UvCorners> pressed = tube.uv;
  for (std::size_t t = 0; t < pressed.size() / 2; ++t)
    for (Vec2& c : pressed[t]) c.y() /= 85;  // 0.24 mm high, less than 1/80 of 28 mm
  const UvRest rest = rest_from_uv(tube.mesh, pressed, Vec2(1, 1), 1.0 / 80);
  EXPECT_EQ(rest.unusable, pressed.size() / 2);
  EXPECT_NEAR(rest.unusable_area, 0.5 * (1 - 1.0 / 85), 1e-9);
  EXPECT_FALSE(rest.has_panel_lengths());
  const UvRest fitting = rest_from_uv(tube.mesh, tube.scaled({0.999, 0.999}), Vec2(1, 1), 1);
  EXPECT_EQ(fitting.unusable, tube.uv.size());
  EXPECT_NEAR(fitting.unusable_area, 1 - 0.999 * 0.999, 1e-9);
  EXPECT_TRUE(fitting.has_panel_lengths());
}

TEST(UvRest, ChartsOfABodyAreNoPanels) {
  Textured ball;
  ball.mesh = mesh::make_sphere(0.5, 48);
  for (const mesh::Triangle& t : ball.mesh.topology.triangles) {
    auto& corners = ball.uv.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& x = ball.mesh.positions[static_cast<std::size_t>(t[k])];
      corners[k] = {std::atan2(x.y(), x.x()) / (2 * std::numbers::pi), std::acos(2 * x.z()) / std::numbers::pi};
    }
  }
  const UvRest rest = rest_from_uv(ball.mesh, ball.uv, std::nullopt);
  EXPECT_FALSE(rest.has_panel_lengths()) << rest.describe();
}

TEST(UvRest, OfTrianglesThatAreTooFlatForTheRestIsTheMesh) {
  Textured tube = pleated_tube();
  UvCorners& needle = tube.uv[30];
  // The needle is 0.25 mm high. The longest edge of all triangles is 28 mm, so 1/80 of it is 0.35 mm.
  needle[2] = needle[0] + 0.3 * (needle[1] - needle[0]) + Vec2(0, 2.5e-4);
  ASSERT_EQ(rest_from_uv(tube.mesh, tube.uv, Vec2(1, 1)).unusable, 0U);
  const UvRest rest = rest_from_uv(tube.mesh, tube.uv, Vec2(1, 1), 1.0 / 80);
  EXPECT_EQ(rest.unusable, 1U);
  const mesh::Triangle& t = tube.mesh.topology.triangles[30];
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_NEAR((rest.material[30][(k + 1) % 3] - rest.material[30][k]).norm(),
                (tube.mesh.positions[t[(k + 1) % 3]] - tube.mesh.positions[t[k]]).norm(), 1e-12);
}

}  // namespace
}  // namespace weft::garment
