#include "film/environment/environment.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "core/error.hpp"
#include "motion/rotation.hpp"
#include "physics/mesh/geometry.hpp"
#include "support/mesh_measures.hpp"
#include "support/scene_runs.hpp"

namespace weft::environment {
namespace {

namespace fs = std::filesystem;

// Tolerance [m]: a few rounding errors of coordinates of some metres.
constexpr double kRounding = 1e-13;

scene::Scene scene_with(const scene::Shape& shape, scene::UpAxis up = scene::UpAxis::z) {
  scene::Scene scene;
  scene.file = "scenes/a.toml";
  scene.up = up;
  scene.obstacles.emplace_back();
  scene.obstacles[0].name = "thing";
  scene.obstacles[0].shape = shape;
  return scene;
}

/// Positions of the vertices of a body at time t.
std::vector<Vec3> placed(const Environment& environment, double t = 0, std::size_t body = 0) {
  std::vector<Vec3> positions(environment.model.bodies[body].mesh.positions.size());
  environment.model.place(body, t, positions);
  return positions;
}

Box3 bounds_of(const Environment& environment, double t = 0, std::size_t body = 0) {
  return mesh::bounding_box(placed(environment, t, body));
}

TEST(Cloth, IsGradedAsTheSceneSaysWithFractionsToMatch) {
  scene::Scene scene;
  scene.cloths.emplace_back();
  scene::Cloth& cloth = scene.cloths[0];
  cloth.name = "sheet";
  cloth.size = {3, 2};
  cloth.particles_weft = cloth.particles_warp = 3;
  cloth.grading = {2, 0.25};  // cells of 1 and 2 m along weft, 1.6 and 0.4 m along warp
  for (const auto shape : {scene::ClothShape::quads, scene::ClothShape::aligned_triangles}) {
    cloth.shape = shape;
    const Environment environment(scene);
    const model::Cloth& object = environment.model.cloths[0];
    EXPECT_LT((object.mesh.positions[4] - Vec3(-0.5, 0.6, 0)).norm(), kRounding);
    EXPECT_LT((environment.cloths[0].fractions[4] - Vec2(1.0 / 3, 0.8)).norm(), kRounding);
    const bool quads = shape == scene::ClothShape::quads;
    EXPECT_NEAR(object.spacing, quads ? 0.4 : std::sqrt(2) * 0.4 / std::hypot(1, 0.4), kRounding);
  }
}

TEST(Cloth, LiesInThePlaneOfItsPoseWithWeftAlongXAndWarpAlongY) {
  scene::Scene scene;
  scene.cloths.emplace_back();
  scene::Cloth& cloth = scene.cloths[0];
  cloth.name = "sheet";
  cloth.size = {2, 3};
  cloth.particles_weft = 5;
  cloth.particles_warp = 7;
  cloth.pose = {{10, 20, 30}, motion::about({1, 0, 0}, 90 * kDegree)};  // y is turned upward
  cloth.velocity = {1, 2, 3};
  // Only the pose orients cloth; the up axis does not.
  for (const auto up : {scene::UpAxis::z, scene::UpAxis::y}) {
    scene.up = up;
    const Environment environment(scene);
    const model::Cloth& object = environment.model.cloths.at(0);
    EXPECT_EQ(object.name, "sheet");
    EXPECT_EQ(object.grid.lu, 0.5);
    EXPECT_EQ(object.grid.lv, 0.5);
    ASSERT_EQ(object.mesh.positions.size(), 35u);
    ASSERT_EQ(object.mesh.topology.quads.size(), 24u);
    ASSERT_EQ(object.mesh.topology.triangles.size(), 48u);
    for (int j = 0; j < 7; ++j) {
      for (int i = 0; i < 5; ++i) {
        const auto k = static_cast<std::size_t>(object.grid.index(i, j));
        const Vec3 expected(10 - 1 + 0.5 * i, 20, 30 - 1.5 + 0.5 * j);
        EXPECT_LT((object.mesh.positions[k] - expected).norm(), kRounding);
        EXPECT_EQ(object.mesh.uv[k], Vec2(0.5 * i, 0.5 * j));
        EXPECT_EQ(object.start[k], object.mesh.positions[k]);
      }
    }
    EXPECT_EQ(object.velocity, Vec3(1, 2, 3));
  }
}

TEST(Shapes, TurnTheirAxisUpWhereYIsUp) {
  const scene::Cone cone{.radius = 0.5, .height = 3};
  const Environment z_up(scene_with(cone)), y_up(scene_with(cone, scene::UpAxis::y));
  EXPECT_LT((bounds_of(z_up).sizes() - Vec3(1, 1, 3)).norm(), kRounding);
  EXPECT_LT((bounds_of(y_up).sizes() - Vec3(1, 3, 1)).norm(), kRounding);
  // The tip is the only vertex at the top.
  const auto& body = y_up.model.bodies[0].mesh.positions;
  EXPECT_EQ(std::count_if(body.begin(), body.end(), [](const Vec3& x) { return x.y() > 1.499; }), 1);
  EXPECT_GT(support::enclosed_volume(y_up.model.bodies[0].mesh.topology.triangles, body), 0);
}

TEST(Shapes, AreMadeAsTheSceneSaysInTheSameOrder) {
  struct Case {
    scene::Shape shape;
    Vec3 z_up, y_up;  // sizes of the bounding box
  };
  const std::vector<Case> cases{
      {scene::Sphere{.radius = 0.5}, {1, 1, 1}, {1, 1, 1}},
      {scene::BoxShape{.size = {1, 2, 3}, .bevel = 0.1}, {1, 2, 3}, {1, 2, 3}},  // sizes along the axes of the scene
      {scene::Cylinder{.radius = 1, .height = 5}, {2, 2, 5}, {2, 5, 2}},
      {scene::Torus{.radius = 1, .tube_radius = 0.25}, {2.5, 2.5, 0.5}, {2.5, 0.5, 2.5}},
      {scene::HalfPipe{.radius = 1, .length = 4, .thickness = 0.5}, {4, 3, 1.5}, {4, 1.5, 3}},
      {scene::Plane{.size = {6, 8}}, {6, 8, 0}, {6, 0, 8}}};
  for (const auto up : {scene::UpAxis::z, scene::UpAxis::y}) {
    scene::Scene scene;
    scene.up = up;
    for (const Case& c : cases) {
      scene.obstacles.emplace_back();
      scene.obstacles.back().shape = c.shape;
      scene.obstacles.back().segments = 16;
    }
    const Environment environment(scene);
    ASSERT_EQ(environment.model.bodies.size(), cases.size());
    for (std::size_t k = 0; k < cases.size(); ++k) {
      const Vec3& expected = up == scene::UpAxis::z ? cases[k].z_up : cases[k].y_up;
      EXPECT_LT((bounds_of(environment, 0, k).sizes() - expected).norm(), kRounding) << k;
      EXPECT_EQ(environment.model.bodies[k].infinite_floor, k == 5);
    }
  }
}

TEST(HalfPipe, OpensAgainstGravityWhicheverAxisIsUp) {
  const scene::HalfPipe pipe{.radius = 1, .length = 4, .thickness = 0.5};
  EXPECT_NEAR(bounds_of(Environment(scene_with(pipe))).max().z(), 0, kRounding);
  EXPECT_NEAR(bounds_of(Environment(scene_with(pipe, scene::UpAxis::y))).max().y(), 0, kRounding);
}

TEST(Plane, FacesUpAndIsNoFloorToTheHorizonIfFinite) {
  for (const auto up : {scene::UpAxis::z, scene::UpAxis::y}) {
    const Environment environment(scene_with(scene::Plane{.size = {2, 2}, .infinite = false}, up));
    const model::Body& plane = environment.model.bodies[0];
    EXPECT_FALSE(plane.infinite_floor);
    const Vec3 normal = up == scene::UpAxis::z ? Vec3(0, 0, 1) : Vec3(0, 1, 0);
    for (const auto& t : plane.mesh.topology.triangles)
      EXPECT_LT((mesh::area_vector(t, placed(environment)) - 2 * normal).norm(), kRounding);
  }
}

TEST(Obstacle, AtRestStandsAtItsPoseForAllTimes) {
  scene::Scene scene = scene_with(scene::BoxShape{.size = {2, 4, 6}, .bevel = 0});
  scene.obstacles[0].pose = {{1, 2, 3}, motion::about({0, 0, 1}, 90 * kDegree)};
  scene.obstacles[0].collide = false;
  const Environment environment(scene);
  EXPECT_FALSE(environment.model.bodies[0].may_move);
  EXPECT_FALSE(environment.model.bodies[0].collide);
  for (const double t : {0.0, 5.0}) {
    EXPECT_LT((bounds_of(environment, t).min() - Vec3(-1, 1, 0)).norm(), kRounding);
    EXPECT_LT((bounds_of(environment, t).max() - Vec3(3, 3, 6)).norm(), kRounding);
  }
  EXPECT_EQ(placed(environment, 0), placed(environment, 5));
}

TEST(Body, IsPassedThroughWhereAPartIsLeftOut) {
  const auto man_with = [](const std::string& more) {
    return Environment(
        support::scene_of_text("[[character]]\nname = 'man'\nsource = 'mannequin'\nedge_length = 0.05\n" + more));
  };
  EXPECT_TRUE(man_with("").bodies[0].passed_through.empty());
  const Environment with_man = man_with("part = [{ name = 'hands', collide = false }]\n");
  const model::Body& man = with_man.model.bodies[0];
  const BodyDetails& details = with_man.bodies[0];
  const auto& triangles = man.mesh.topology.triangles;
  ASSERT_EQ(details.passed_through.size(), triangles.size());
  std::size_t colliding_on_hand = 0;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto& hand = details.parts[0].vertices;
    const bool of_a_hand = hand[triangles[t][0]] + hand[triangles[t][1]] + hand[triangles[t][2]] >= 2;
    EXPECT_EQ(details.passed_through[t] != 0, of_a_hand);
    if (of_a_hand) continue;
    ASSERT_LT(colliding_on_hand, man.colliding.size());
    EXPECT_EQ(man.colliding[colliding_on_hand++], triangles[t]);
  }
  EXPECT_LT(colliding_on_hand, triangles.size());
  EXPECT_GT(man.colliding.size(), colliding_on_hand) << "the cuts are closed";
}

scene::Scene scene_with_tumbling_torus() {
  scene::Scene scene = scene_with(scene::Torus{});
  scene.obstacles[0].segments = 12;
  scene.obstacles[0].motion.keys = {{0, {{0, 0, 1}, Quat::Identity()}},
                                    {0.5, {{1, 0, 2}, motion::about({1, 1, 0}, 1.5)}},
                                    {2, {{1, 3, 0}, motion::about({0, 1, 1}, -1)}}};
  return scene;
}

TEST(Obstacle, InMotionIsElsewhereAtAnotherTimeAndKeepsItsShapeAndFollowsItsPose) {
  const Environment environment(scene_with_tumbling_torus());
  ASSERT_TRUE(environment.model.bodies[0].may_move);
  EXPECT_NE(placed(environment, 1), placed(environment, 0));
  const std::vector<Vec3>& torus = environment.model.bodies[0].mesh.positions;
  for (const double t : {0.2, 0.5, 1.7, 9.0}) {
    const std::vector<Vec3> x = placed(environment, t);
    const motion::PoseSample pose = environment.model.pose(0, t);
    for (std::size_t i = 0; i < x.size(); ++i)
      EXPECT_LT((x[i] - (pose.position + pose.rotation * torus[i])).norm(), kRounding);
  }
}

TEST(Obstacle, InMotionHasTheVelocityAndAccelerationOfEachVertex) {
  const Environment environment(scene_with_tumbling_torus());
  const double h = 1e-4;
  for (const double t : {0.25, 1.1}) {
    const std::vector<Vec3> before = placed(environment, t - h), now = placed(environment, t),
                            after = placed(environment, t + h);
    const motion::PoseSample pose = environment.model.pose(0, t);
    for (std::size_t i = 0; i < before.size(); ++i) {
      const Vec3 arm = now[i] - pose.position;
      const Vec3 velocity = (after[i] - before[i]) / (2 * h);
      const Vec3 acceleration = (after[i] - 2 * now[i] + before[i]) / (h * h);
      // Tolerance: errors of the differences are h²/6 and h²/12 times derivatives below 500. The second difference adds
      // rounding of 4e-16 / h².
      EXPECT_LT((pose.velocity_at(arm) - velocity).norm(), 1e-6);
      EXPECT_LT((pose.acceleration_at(arm) - acceleration).norm(), 1e-6);
    }
  }
}

TEST(MeshFile, IsLoadedScaledAndTakenAsItLiesWhicheverAxisIsUp) {
  const fs::path file = fs::path(testing::TempDir()) / ("weft_environment_" + std::to_string(::getpid()) + ".obj");
  std::ofstream(file) << "v 0 0 0\nv 1 0 0\nv 0 2 0\nf 1 2 3\n";
  const Environment environment(scene_with(scene::MeshFile{.path = file, .scale = 0.5}, scene::UpAxis::y));
  fs::remove(file);
  EXPECT_EQ(placed(environment), (std::vector<Vec3>{{0, 0, 0}, {0.5, 0, 0}, {0, 1, 0}}));
}

TEST(MeshFile, ThatIsMissingIsNamedWithTheSceneLine) {
  scene::Scene scene = scene_with(scene::MeshFile{.path = "/nowhere/chair.obj"});
  scene.obstacles[0].line = 12;
  scene.obstacles[0].column = 3;
  try {
    const Environment environment(scene);
    FAIL() << "loaded";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::asset_unreadable);
    EXPECT_STREQ(error.what(),
                 "scenes/a.toml:12:3: obstacle.thing: mesh file /nowhere/chair.obj: expected a readable "
                 "file, got none at this path");
  }
}

}  // namespace
}  // namespace weft::environment
