// Tests of triangle cloth in scenes.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include "film/production/scene_simulation.hpp"
#include "simulation/scenes.hpp"
#include "support/test_folder.hpp"

namespace weft::simulation {
namespace {

/// Drop of the end of a strip of 8 cm by 2 cm that overhangs its clamp, at rest [m].
double drop_of_cantilever(scene::ClothShape shape) {
  scene::Scene scene = testing::sheet_alone(0.08, 17, 0);
  scene.solver.newton_tolerance = 1e-5;
  scene.solver.linear_tolerance = 1e-3;
  scene.time.step = 0.01;
  scene::Cloth& cloth = scene.cloths[0];
  cloth.shape = shape;
  cloth.size = {0.08, 0.02};
  cloth.particles_warp = 5;
  cloth.material.bend_friction = 0;
  scene::Pin clamp;
  clamp.high = {3.0 / 16, 1};
  cloth.pins.push_back(clamp);
  production::SceneSimulation simulation(scene);
  FrameReport report;
  for (int k = 0; k < 60; ++k) report = simulation.advance();
  EXPECT_LT(report.kinetic_energy, 1e-10);
  return -testing::lowest(testing::sheet_of(simulation.snapshot()));
}

TEST(TriangleCloth, CantileverHangsAsDeepAsThatOfQuads) {
  const double quads = drop_of_cantilever(scene::ClothShape::quads);
  EXPECT_GT(quads, 0.01);
  // Tolerance: the clamp acts up to half a cell (2.5 mm) from the last held column, with an overhang of 65 mm.
  EXPECT_NEAR(drop_of_cantilever(scene::ClothShape::aligned_triangles), quads, 0.03 * quads);
  EXPECT_NEAR(drop_of_cantilever(scene::ClothShape::crossed_triangles), quads, 0.03 * quads);
}

TEST(TriangleCloth, CrossedSheetIsPinnedByPlaceAndWeighsAsMuchAsQuads) {
  scene::Scene scene = testing::sheet_alone(1, 5, 2);
  scene.cloths[0].shape = scene::ClothShape::crossed_triangles;
  scene::Pin edge;
  edge.high = {1, 0.1};
  scene.cloths[0].pins.push_back(edge);
  production::SceneSimulation simulation(scene);
  EXPECT_EQ(simulation.particles(), 25u + 16u);
  EXPECT_NEAR(simulation.initial_report().potential_energy, 0.2 * 9.81 * 2, 1e-12);
  for (int k = 0; k < 5; ++k) simulation.advance();
  const auto& x = testing::sheet_of(simulation.snapshot());
  for (std::size_t i = 0; i < x.size(); ++i) {
    const bool held = i < 5;
    EXPECT_EQ(x[i].z() == 2, held) << i;
  }
}

using TriangleClothOfFile = support::TestFolder;

/// Writes a half pipe with a radius of 8 cm. `sign`: 1 if it is open upward, −1 if downward.
void write_half_pipe(const std::filesystem::path& file, double sign) {
  constexpr int kAround = 24, kAlong = 6;
  std::ofstream out(file);
  out.precision(9);
  for (int j = 0; j <= kAlong; ++j)
    for (int i = 0; i <= kAround; ++i) {
      const double angle = std::numbers::pi * (double(i) / kAround - 0.5);
      out << "v " << 0.08 * std::sin(angle) << ' ' << 0.02 * j << ' ' << -sign * 0.08 * std::cos(angle) << '\n';
    }
  const auto vertex = [](int i, int j) { return 1 + i + (kAround + 1) * j; };
  for (int j = 0; j < kAlong; ++j)
    for (int i = 0; i < kAround; ++i) {
      out << "f " << vertex(i, j) << ' ' << vertex(i + 1, j) << ' ' << vertex(i + 1, j + 1) << '\n';
      out << "f " << vertex(i, j) << ' ' << vertex(i + 1, j + 1) << ' ' << vertex(i, j + 1) << '\n';
    }
}

TEST_F(TriangleClothOfFile, CurvedRestShapeIsKeptWhicheverWayItBends) {
  for (double sign : {1.0, -1.0}) {
    write_half_pipe(folder_ / "pipe.obj", sign);
    scene::Scene scene = testing::sheet_alone(1, 2, 0);
    scene.physics.gravity.setZero();
    scene.cloths[0].shape = scene::ClothShape::mesh;
    scene.cloths[0].file = folder_ / "pipe.obj";
    production::SceneSimulation simulation(scene);
    const std::vector<Vec3> start = testing::sheet_of(simulation.snapshot());
    ASSERT_EQ(start.size(), 25u * 7u);
    for (int k = 0; k < 10; ++k) simulation.advance();
    const auto& x = testing::sheet_of(simulation.snapshot());
    for (std::size_t i = 0; i < x.size(); ++i) EXPECT_LT((x[i] - start[i]).norm(), 1e-9) << sign;
  }
}

TEST_F(TriangleClothOfFile, StretchedPipeSpringsBackToItsRestShape) {
  write_half_pipe(folder_ / "pipe.obj", 1);
  scene::Scene scene = testing::sheet_alone(1, 2, 0);
  testing::solve_tightly(scene);
  scene.physics.gravity.setZero();
  scene::Cloth& cloth = scene.cloths[0];
  cloth.shape = scene::ClothShape::mesh;
  cloth.file = folder_ / "pipe.obj";
  cloth.start_scale = {1.05, 1};
  cloth.material.bend_friction = 0;
  cloth.material.bend *= 100;
  production::SceneSimulation simulation(scene);
  FrameReport report = simulation.initial_report();
  EXPECT_GT(report.elastic_energy, 1e-4);
  for (int k = 0; k < 100; ++k) report = simulation.advance();
  EXPECT_LT(report.elastic_energy, 1e-9);
}

TEST_F(TriangleClothOfFile, FilesThatAreNoSheetAreMadeOneAndPinsThatHoldNothingAreRefused) {
  const auto build = [&](const std::string& faces, const Vec2& place) {
    std::ofstream(folder_ / "sheet.obj") << "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\n" << faces;
    scene::Scene scene = testing::sheet_alone(1, 2, 0);
    scene.cloths[0].shape = scene::ClothShape::mesh;
    scene.cloths[0].file = folder_ / "sheet.obj";
    scene::Pin pin;
    pin.low = pin.high = place;
    scene.cloths[0].pins.push_back(pin);
    const production::SceneSimulation simulation(scene);
  };
  EXPECT_NO_THROW(build("f 1 3 4\n", {0, 0}));
  support::expect_error(ExitCode::scene_invalid, "pin.0: expected a part that holds at least one particle", [&] {
    build("f 1 3 4\n", {0.5, 0.5});
  });
  EXPECT_NO_THROW(build("f 1 4 3\n", {0, 0})) << "one of two that faced both ways";
}

}  // namespace
}  // namespace weft::simulation
