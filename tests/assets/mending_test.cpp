// Repair of small surfaces that are not valid sheets.
#include "film/assets/mending.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "physics/mesh/topology.hpp"

namespace weft::assets {
namespace {

constexpr double kFlattest = 1.0 / 80;

/// Squares of 1 m side by side along x, each of two triangles that face +z; u and v are x and y.
LoadedMesh strip(int squares) {
  LoadedMesh loaded;
  for (int i = 0; i <= squares; ++i)
    for (int j = 0; j < 2; ++j) loaded.mesh.positions.emplace_back(i, j, 0);
  for (Index i = 0; i < squares; ++i) {
    loaded.mesh.topology.triangles.push_back({2 * i, 2 * i + 2, 2 * i + 3});
    loaded.mesh.topology.triangles.push_back({2 * i, 2 * i + 3, 2 * i + 1});
  }
  for (std::size_t v = 0; v < loaded.mesh.positions.size(); ++v)
    loaded.groups["all"].push_back(0.1 * static_cast<double>(v));
  return loaded;
}

void paint(LoadedMesh& loaded) {
  loaded.uv.clear();
  for (const mesh::Triangle& t : loaded.mesh.topology.triangles) {
    auto& corners = loaded.uv.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) corners[k] = loaded.mesh.positions[static_cast<std::size_t>(t[k])].head<2>();
  }
}

bool manifold(const LoadedMesh& loaded) {
  return mesh::inspect(loaded.mesh.topology.triangles, loaded.mesh.positions.size()).manifold();
}

Vec3 normal(const LoadedMesh& loaded, const mesh::Triangle& t) {
  const std::vector<Vec3>& x = loaded.mesh.positions;
  return (x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]);
}

/// Expects each UV to equal the x and y of its corner.
void expect_uv_of_places(const LoadedMesh& loaded) {
  for (std::size_t t = 0; t < loaded.uv.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_EQ(loaded.uv[t][k], loaded.mesh.positions[loaded.mesh.topology.triangles[t][k]].head<2>()) << t;
}

TEST(MendedSheet, IsLeftAsItIsWhereNothingIsWrong) {
  LoadedMesh loaded = strip(5);
  const std::vector<mesh::Triangle> triangles = loaded.mesh.topology.triangles;
  const MendingReport mended = mend_sheet(loaded, kFlattest);
  EXPECT_FALSE(mended.any()) << mended.describe();
  EXPECT_EQ(loaded.mesh.topology.triangles, triangles);
}

// Vertices without triangles would be particles without mass.
TEST(MendedSheet, HasNoVerticesWithoutTriangles) {
  LoadedMesh loaded = strip(2);
  loaded.mesh.positions.emplace(loaded.mesh.positions.begin(), 7, 7, 7);
  loaded.groups["all"].insert(loaded.groups["all"].begin(), 1);
  for (mesh::Triangle& t : loaded.mesh.topology.triangles)
    for (Index& v : t) ++v;
  loaded.lost_vertices = 1;
  paint(loaded);
  EXPECT_FALSE(mend_sheet(loaded, kFlattest).any());
  ASSERT_EQ(loaded.mesh.positions.size(), 6U);
  EXPECT_EQ(loaded.groups["all"].size(), 6U);
  EXPECT_EQ(std::ranges::count(loaded.groups["all"], 1), 0);
  expect_uv_of_places(loaded);
}

TEST(MendedSheet, FacesAsMostOfItsAreaDoes) {
  LoadedMesh loaded = strip(6);
  for (const std::size_t t : {1, 4, 5, 10})
    std::swap(loaded.mesh.topology.triangles[t][0], loaded.mesh.topology.triangles[t][1]);
  paint(loaded);
  const MendingReport mended = mend_sheet(loaded, kFlattest);
  EXPECT_EQ(mended.flipped, 4U);
  EXPECT_EQ(mended.cut_edges, 0U);
  ASSERT_TRUE(manifold(loaded));
  for (const mesh::Triangle& t : loaded.mesh.topology.triangles) EXPECT_GT(normal(loaded, t).z(), 0);
  expect_uv_of_places(loaded);
}

// SketchUp writes a two-sided face as two triangles.
TEST(MendedSheet, HasOneOfTwoTrianglesThatLieOnEachOther) {
  LoadedMesh loaded = strip(3);
  for (std::size_t t = 0; t < 6; ++t) {
    const auto [a, b, c] = loaded.mesh.topology.triangles[t];
    loaded.mesh.topology.triangles.push_back({c, b, a});
  }
  paint(loaded);
  EXPECT_EQ(mend_sheet(loaded, kFlattest).duplicates, 6U);
  EXPECT_TRUE(manifold(loaded));
  EXPECT_EQ(loaded.mesh.topology.triangles.size(), 6U);
  expect_uv_of_places(loaded);
}

/// A strip of eight squares, with a flap of `triangles` triangles at the edge between the third and the fourth square.
LoadedMesh with_flap(int triangles) {
  LoadedMesh loaded = strip(8);
  for (int i = 0; i < triangles; ++i) {
    const auto top = static_cast<Index>(loaded.mesh.positions.size());
    loaded.mesh.positions.emplace_back(3, 0.5 + i, 1);
    loaded.groups["all"].push_back(9);
    loaded.mesh.topology.triangles.push_back(i == 0 ? mesh::Triangle{6, 7, top} : mesh::Triangle{top - 1, 7, top});
  }
  paint(loaded);
  return loaded;
}

TEST(MendedSheet, LosesASmallFlap) {
  LoadedMesh loaded = with_flap(1);
  loaded.mesh.positions.back() = {3, 0.5, 0.1};
  const MendingReport mended = mend_sheet(loaded, kFlattest);
  EXPECT_EQ(mended.cut_edges, 1U);
  EXPECT_EQ(mended.pieces, 1U);
  EXPECT_NEAR(mended.left_out, 0.05 / 8.05, 1e-12);
  EXPECT_TRUE(manifold(loaded));
  EXPECT_EQ(loaded.mesh.positions.size(), 18U);
  EXPECT_EQ(loaded.mesh.topology.triangles.size(), 16U);
}

TEST(MendedSheet, KeepsALargeFlapALittleBeforeTheEdge) {
  LoadedMesh loaded = with_flap(2);
  const MendingReport mended = mend_sheet(loaded, kFlattest);
  EXPECT_EQ(mended.cut_edges, 1U);
  EXPECT_EQ(mended.pieces, 0U);
  ASSERT_TRUE(manifold(loaded));
  EXPECT_EQ(loaded.mesh.topology.triangles.size(), 18U);
  ASSERT_EQ(loaded.mesh.positions.size(), 22U) << "two more for the flap, two copies";
  const std::vector<Index> piece = mesh::components(loaded.mesh.topology.triangles, 22);
  EXPECT_EQ(*std::ranges::max_element(piece), 1);
  int stay = 0, before = 0;
  for (std::size_t v = 0; v < 22; ++v) {
    const Vec3& x = loaded.mesh.positions[v];
    if (piece[v] == 0) stay += x.z() == 0 ? 1 : 0;
    if (piece[v] == 1 && x.z() > 0 && x.z() < 0.2) ++before;
  }
  EXPECT_EQ(stay, 18) << "the strip is where it was";
  EXPECT_EQ(before, 2) << "a fifth of the way to the middle of its triangles, a third of a metre up";
  EXPECT_EQ(loaded.groups["all"].size(), 22U);
}

TEST(MendedSheet, CannotFaceAlikeAllAroundAMoebiusStrip) {
  LoadedMesh loaded = strip(8);
  // The ends of the strip are joined upside down, which makes a Möbius strip.
  for (mesh::Triangle& t : loaded.mesh.topology.triangles)
    for (Index& v : t) v = v == 16 ? 1 : v == 17 ? 0 : v;
  for (std::size_t v = 0; v < 16; ++v) {
    const double angle = static_cast<double>(v / 2) * std::acos(-1.0) / 4, half = (v % 2 == 0 ? 0.5 : -0.5);
    loaded.mesh.positions[v] = Vec3(std::cos(angle) * (2 + half * std::cos(angle / 2)),
                                    std::sin(angle) * (2 + half * std::cos(angle / 2)), half * std::sin(angle / 2));
  }
  loaded.mesh.positions.resize(16);
  loaded.groups["all"].resize(16);
  EXPECT_FALSE(manifold(loaded));
  const MendingReport mended = mend_sheet(loaded, kFlattest);
  EXPECT_EQ(mended.cut_edges, 1U);
  EXPECT_TRUE(manifold(loaded));
}

TEST(MendedSheet, LosesNeedlesAndTurnsTheEdgeOfWhatIsFlat) {
  LoadedMesh loaded = strip(4);
  // One vertex close to another makes two needle triangles; one close to the middle of an edge makes a flat triangle.
  std::vector<mesh::Triangle>& triangles = loaded.mesh.topology.triangles;
  const auto near_corner = static_cast<Index>(loaded.mesh.positions.size());
  loaded.mesh.positions.emplace_back(1.004, 0.003, 0);
  const mesh::Triangle whole = triangles[2];  // (2, 4, 5)
  triangles[2] = {whole[0], whole[1], near_corner};
  triangles.push_back({whole[1], whole[2], near_corner});
  triangles.push_back({whole[2], whole[0], near_corner});
  const Index near_edge = near_corner + 1;
  loaded.mesh.positions.emplace_back(3.5, 0.504, 0);
  const mesh::Triangle other = triangles[7];  // (6, 9, 7), above its longest edge, from (3, 0) to (4, 1)
  triangles[7] = {other[0], other[1], near_edge};
  triangles.push_back({other[1], other[2], near_edge});
  triangles.push_back({other[2], other[0], near_edge});
  loaded.groups["all"].resize(12, 0.5);
  paint(loaded);
  ASSERT_TRUE(manifold(loaded));
  const MendingReport mended = mend_sheet(loaded, kFlattest);
  EXPECT_EQ(mended.collapsed, 2U) << mended.describe();
  ASSERT_TRUE(manifold(loaded));
  EXPECT_EQ(loaded.mesh.topology.triangles.size(), 10U) << "8, and 2 around the vertex near an edge";
  double area = 0;
  for (const mesh::Triangle& t : loaded.mesh.topology.triangles) {
    const Vec3 n = normal(loaded, t);
    EXPECT_GT(n.z(), 0.1);
    area += n.z() / 2;
  }
  EXPECT_NEAR(area, 4, 1e-12) << "the strip, without holes and folds";
  expect_uv_of_places(loaded);
}

TEST(MendedSheet, KeepsItsOutlineWhereNeedlesAreAtTheBorder) {
  LoadedMesh loaded = strip(2);
  // A needle along the border cuts off the corner (2, 1).
  loaded.mesh.positions.emplace_back(2, 0.997, 0);
  loaded.groups["all"].push_back(0);
  const auto close = static_cast<Index>(loaded.mesh.positions.size() - 1);
  std::vector<mesh::Triangle>& triangles = loaded.mesh.topology.triangles;
  const mesh::Triangle last = triangles[2];  // (2, 4, 5)
  triangles[2] = {last[0], last[1], close};
  triangles.push_back({last[0], close, last[2]});
  paint(loaded);
  EXPECT_EQ(mend_sheet(loaded, kFlattest).collapsed, 1U);
  ASSERT_TRUE(manifold(loaded));
  EXPECT_EQ(loaded.mesh.topology.triangles.size(), 4U);
  double area = 0;
  for (const mesh::Triangle& t : loaded.mesh.topology.triangles) area += normal(loaded, t).z() / 2;
  EXPECT_NEAR(area, 2, 0.003 / 2 + 1e-12) << "at most the needle";
}

}  // namespace
}  // namespace weft::assets
