// Bending of sheets of which some particles are held: clamps, hinges, and release.
#include <gtest/gtest.h>

#include <cmath>

#include "forces/sheets.hpp"
#include "forces/triangle_meshes.hpp"

namespace weft::forces {
namespace {

using testing::kRigidity;
using testing::Positions;

constexpr double kCurvature = 4;  // [1/m]
const Vec2 kHeldSize(0.2, 0.1);

/// Marks the particles up to the weft coordinate `clamp` [m] as held.
std::vector<char> held_up_to(const std::vector<Vec2>& uv, double clamp) {
  std::vector<char> held;
  for (const Vec2& place : uv) held.push_back(place.x() < clamp + 1e-9);
  return held;
}

// Height at u [m] of a sheet that is flat up to `clamp` [m] and has the curvature kCurvature beyond it.
double in_front(double u, double clamp) {
  return 0.5 * kCurvature * std::pow(std::max(0.0, u - clamp), 2);
}

TEST(HeldBend, QuadsBendWithTheirOwnCurvatureFromTheClampOn) {
  mesh::Grid grid{9, 5, 0.02, 0.03};
  grid.weft_grading = 5;
  for (const bool along_weft : {true, false}) {
    if (!along_weft) grid = {grid.nv, grid.nu, grid.lv, grid.lu, 1, 5};
    Bend bend(grid, 0, {kRigidity, 0});
    const double clamp = along_weft ? grid.u(2) : grid.v(2), end = along_weft ? grid.u(8) : grid.v(8);
    const double across = along_weft ? grid.v(4) : grid.u(4);
    std::vector<char> held;
    const Positions x = testing::shaped(grid, [&](double u, double v) {
      const double s = along_weft ? u : v;
      held.push_back(s < clamp + 1e-9);
      return Vec3(u, v, in_front(s, clamp));
    });
    bend.set_held(held);
    // Area that has bending energy: the free part of the sheet without half a spacing at its free end, where particles
    // have no second difference.
    const double area = (end - clamp - (along_weft ? grid.width_u(8) : grid.width_v(8))) * across;
    const double expected = 0.5 * kRigidity * kCurvature * kCurvature * area;
    EXPECT_NEAR(bend.energy(x), expected, 1e-12 * expected);
  }
}

TEST(HeldBend, TrianglesBendWithTheirOwnCurvatureFromTheClampOn) {
  for (const std::size_t meshing : {0, 1, 3}) {  // meshes with straight columns
    const mesh::Mesh mesh = testing::kMeshings[meshing].make(kHeldSize, 8);
    const mesh::Sheet sheet = mesh::make_sheet_from_mesh(mesh);
    const double clamp = mesh.uv[2].x();
    const std::vector<char> held = held_up_to(mesh.uv, clamp);
    const auto stencils = curvature_stencils(sheet, held, held);
    const mesh::EdgeSet edges = mesh::collect_edges(sheet.triangles);
    for (std::size_t t = 0; t < stencils.size(); ++t) {
      if (std::ranges::any_of(edges.of_triangle[t], [&](Index e) { return edges.edges[e].triangles[1] < 0; })) continue;
      Vec3 curvature = Vec3::Zero();
      for (std::size_t k = 0; k < stencils[t].vertices.size(); ++k)
        curvature += stencils[t].weights[k] * in_front(mesh.uv[stencils[t].vertices[k]].x(), clamp);
      const bool clamped = std::ranges::all_of(sheet.triangles[t], [&](Index v) { return held[v] != 0; });
      // Tolerance: the rounding errors of weights of 1e4 to 1e6 1/m², times heights of at most 0.1 m, are below 1e-10
      // 1/m.
      EXPECT_LT((curvature - Vec3(clamped ? 0 : kCurvature, 0, 0)).norm(), 1e-9)
          << testing::kMeshings[meshing].name << ", triangle " << t;
    }
  }
}

/// A crumpled Delaunay mesh whose first quarter along weft is held. The mesh has no straight columns, so the edge of
/// the clamp is ragged.
struct RaggedClamp {
  mesh::Mesh mesh = testing::delaunay_sheet(testing::grid_of_squares(kHeldSize, 5), 0.35, 3);
  mesh::Sheet sheet = mesh::make_sheet_from_mesh(mesh);
  std::vector<char> held = held_up_to(mesh.uv, 0.05), none = std::vector<char>(mesh.uv.size());
  TriangleBend bend{sheet, 0, {kRigidity, 1e-5}, held};
  Positions x = testing::shaken(sheet.rest, 0.004, 11), v = testing::random_vectors(x.size(), 0.1, 12);
};

TEST(HeldBend, RaggedClampHasTheJacobianOfItsForceAndIsDefinite) {
  RaggedClamp clamp;
  const Eigen::MatrixXd jacobian = testing::jacobian_of(clamp.bend, clamp.x, clamp.v, 50);
  const Eigen::MatrixXd differences = testing::stiffness_by_differences(clamp.bend, clamp.x, clamp.v, 50, 1e-6);
  // Measured error of the differences: 2e-9 of the largest entry.
  EXPECT_LT((jacobian - differences).cwiseAbs().maxCoeff(), 1e-7 * jacobian.cwiseAbs().maxCoeff());
  const Eigen::MatrixXd definite = testing::stiffness_of(clamp.bend, clamp.x, clamp.v, 50);
  const Eigen::VectorXd values = definite.selfadjointView<Eigen::Lower>().eigenvalues();
  EXPECT_GT(values.minCoeff(), -1e-12 * values.maxCoeff());
  // After a rigid motion, the energy is zero up to rounding.
  EXPECT_LT(clamp.bend.energy(testing::moved_rigidly(clamp.sheet.rest)), 1e-24);
}

TEST(HeldBend, WhatIsLetGoBendsAsIfItHadNeverBeenHeld) {
  RaggedClamp clamp;
  const TriangleBend never(clamp.sheet, 0, {kRigidity, 1e-5});
  const double held = clamp.bend.energy(clamp.x);
  const Eigen::MatrixXd stiff = testing::stiffness_of(clamp.bend, clamp.x, clamp.v, 0);
  clamp.bend.set_held(clamp.none);
  EXPECT_GT(held, 1.05 * clamp.bend.energy(clamp.x));
  // Tolerance: curvature_stencils() removes weights of the size of rounding errors, but not near pinned particles;
  // `clamp.bend` has pinned particles, `never` has none.
  EXPECT_NEAR(clamp.bend.energy(clamp.x), never.energy(clamp.x), 1e-12 * held);
  clamp.bend.set_held(clamp.held);
  EXPECT_EQ(clamp.bend.energy(clamp.x), held);
  EXPECT_EQ(testing::stiffness_of(clamp.bend, clamp.x, clamp.v, 0), stiff);

  const mesh::Grid grid = testing::kGrid;
  const Positions x = testing::crumpled(grid, 0.005, 4);
  std::vector<char> two_columns;
  for (int j = 0; j < grid.nv; ++j)
    for (int i = 0; i < grid.nu; ++i) two_columns.push_back(i < 2);
  Bend quads(grid, 0, {kRigidity, 0});
  const double free = quads.energy(x);
  quads.set_held(two_columns);
  EXPECT_GT(quads.energy(x), 1.05 * free);
  quads.set_held(std::vector<char>(x.size()));
  EXPECT_EQ(quads.energy(x), free);
}

TEST(HeldBend, OneRowOrOneCornerIsAHinge) {
  const mesh::Grid grid = testing::kGrid;
  const mesh::Mesh crossed = testing::kMeshings[1].make(kHeldSize, 8);
  const Positions x = testing::crumpled(grid, 0.005, 4);
  for (const bool corner : {true, false}) {
    std::vector<char> held;
    for (int j = 0; j < grid.nv; ++j)
      for (int i = 0; i < grid.nu; ++i) held.push_back(i == 0 && (j == 0 || !corner));
    Bend quads(grid, 0, {kRigidity, 0});
    const double free = quads.energy(x);
    quads.set_held(held);
    EXPECT_EQ(quads.energy(x), free);

    std::vector<char> of_crossed;
    for (const Vec2& uv : crossed.uv) of_crossed.push_back(uv.x() < 1e-9 && (uv.y() < 1e-9 || !corner));
    const mesh::Sheet sheet = mesh::make_sheet_from_mesh(crossed);
    const Positions noise = testing::random_vectors(sheet.rest.size(), 0.004, 11);
    EXPECT_EQ(TriangleBend(sheet, 0, {kRigidity, 0}, of_crossed).energy(noise),
              TriangleBend(sheet, 0, {kRigidity, 0}).energy(noise));
  }
}

TEST(HeldBend, CurvedRestShapeHasNoForceWhereItIsClamped) {
  mesh::Mesh mesh = testing::delaunay_sheet(testing::grid_of_squares(kHeldSize, 5), 0.3, 5);
  for (std::size_t k = 0; k < mesh.uv.size(); ++k) {
    const double angle = kCurvature * mesh.uv[k].x();
    mesh.positions[k] = {std::sin(angle) / kCurvature, mesh.uv[k].y(), (1 - std::cos(angle)) / kCurvature};
  }
  const mesh::Sheet sheet = mesh::make_sheet_from_mesh(mesh);
  TriangleBend bend(sheet, 0, {kRigidity, 0}, held_up_to(mesh.uv, 0.05));
  for (const bool let_go : {false, true}) {
    if (let_go) bend.set_held(std::vector<char>(sheet.rest.size()));
    // Tolerance: coordinates below 1 m have rounding errors of 1e-16 m, which the force multiplies by B / l² = 1 N/m;
    // the weights of the stencils add errors of the same size.
    EXPECT_LT(testing::largest(testing::force_of(bend, sheet.rest, testing::zeros(sheet.rest))), 1e-13);
  }
}

}  // namespace
}  // namespace weft::forces
