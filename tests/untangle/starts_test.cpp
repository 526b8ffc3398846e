// Tests of starts with intersections: which are untangled, to which side, and which are refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "film/production/scene_simulation.hpp"
#include "film/scene/ropes.hpp"
#include "support/intersections.hpp"

namespace weft::untangle {
namespace {

using production::SceneSimulation;

scene::Scene empty_scene() {
  scene::Scene scene;
  scene.name = "test";
  scene.time = {.duration = 0.2, .fps = 25};
  return scene;
}

scene::Cloth sheet(const char* name, const Vec3& position, double size = 0.8, int particles = 25) {
  scene::Cloth cloth;
  cloth.name = name;
  cloth.size = {size, size};
  cloth.particles_weft = cloth.particles_warp = particles;
  cloth.pose.position = position;
  cloth.start = scene::ClothStart::untangle;
  return cloth;
}

Quat turned(double degrees, const Vec3& axis) {
  return Quat(Eigen::AngleAxisd(degrees * EIGEN_PI / 180, axis.normalized()));
}

void add_obstacle(scene::Scene& scene, const char* name, scene::Shape shape, const Vec3& position = Vec3::Zero()) {
  scene::Obstacle obstacle;
  obstacle.name = name;
  obstacle.shape = std::move(shape);
  obstacle.pose.position = position;
  scene.obstacles.push_back(obstacle);
}

std::size_t count_intersections(const frame::FrameSnapshot& snapshot) {
  return support::find_intersections(support::objects_of(snapshot)).pairs.size();
}

std::string refusal(const scene::Scene& scene) {
  try {
    const production::SceneSimulation simulation(scene);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::scene_invalid);
    return error.what();
  }
  return "";
}

double max_displacement(const frame::FrameSnapshot& a, const frame::FrameSnapshot& b) {
  double max_distance = 0;
  for (std::size_t s = 0; s < a.states.size(); ++s)
    for (std::size_t i = 0; i < a.states[s].positions.size(); ++i)
      max_distance = std::max(max_distance, (a.states[s].positions[i] - b.states[s].positions[i]).norm());
  return max_distance;
}

/// Expects, by exact predicates, at least `least_before` intersections in the given start, and none in the first frame
/// and the next three. Expects that the scene is refused if no cloth may be untangled. Returns the first frame.
frame::SnapshotPtr expect_untangled(const scene::Scene& scene, std::size_t least_before = 1) {
  const frame::SnapshotPtr given = production::view_start(scene).snapshot;
  EXPECT_GE(count_intersections(*given), least_before);
  scene::Scene as_given = scene;
  for (scene::Cloth& cloth : as_given.cloths) cloth.start = scene::ClothStart::as_given;
  EXPECT_NE(refusal(as_given).find("start = \"untangle\""), std::string::npos);
  production::SceneSimulation simulation(scene);
  const frame::SnapshotPtr first = simulation.snapshot();
  EXPECT_EQ(count_intersections(*first), 0U);
  for (int frame = 0; frame < 3; ++frame) {
    simulation.advance();
    EXPECT_EQ(count_intersections(*simulation.snapshot()), 0U) << "frame " << frame + 1;
  }
  return first;
}

double lowest(const std::vector<Vec3>& x) {
  return std::ranges::min_element(x, {}, [](const Vec3& p) { return p.z(); })->z();
}

TEST(UntangledStart, ASheetThroughABallGoesOverToTheSmallerSide) {
  for (const double height : {0.06, -0.06}) {
    scene::Scene scene = empty_scene();
    scene.cloths.push_back(sheet("sheet", {0, 0, height}));
    add_obstacle(scene, "ball", scene::Sphere{0.2});
    const frame::SnapshotPtr first = expect_untangled(scene, 50);
    // The middle particle is at the top or at the bottom of the ball. Tolerance: the thickness of the cloth.
    const Vec3& middle = first->states[0].positions[12 + 25 * 12];
    EXPECT_NEAR(middle.z(), std::copysign(0.2, height), 0.004);
    EXPECT_LT(max_displacement(*first, *production::view_start(scene).snapshot), 0.2);
  }
}

// The region of cloth inside a body may consist of one particle. The size of the region includes half of the cells
// around it. Otherwise, the region would be a point, and the body would count as passing through the cloth.
TEST(UntangledStart, OneParticleOfACoarseMeshGetsOutOfABall) {
  scene::Scene scene = empty_scene();
  scene.cloths.push_back(sheet("sheet", {0, 0, 0.02}, 0.6, 7));
  add_obstacle(scene, "ball", scene::Sphere{0.04});
  const Vec3 middle = expect_untangled(scene)->states[0].positions[3 + 7 * 3];
  EXPECT_NEAR(middle.z(), 0.04, 0.004);
}

TEST(UntangledStart, ClothBelowTheFloorIsInsideOfIt) {
  scene::Scene scene = empty_scene();
  scene.cloths.push_back(sheet("sheet", {0, 0, 0.01}));
  scene.cloths[0].pose.rotation = turned(20, Vec3::UnitX());
  add_obstacle(scene, "floor", scene::Plane{});
  EXPECT_GT(lowest(expect_untangled(scene)->states[0].positions), 0);
}

TEST(UntangledStart, CrossedSheetsAreOnOneSideOfEachOther) {
  scene::Scene scene = empty_scene();
  scene.cloths = {sheet("a", {0, 0, 0}), sheet("b", {0, 0, 0.2}, 0.6)};
  scene.cloths[1].pose.rotation = turned(80, Vec3(1, 0.2, 0));
  const frame::SnapshotPtr first = expect_untangled(scene);
  EXPECT_LT(max_displacement(*first, *production::view_start(scene).snapshot), 0.25);
}

TEST(UntangledStart, ASheetThatLiesOnAnotherGoesInFrontOfItAlsoWhereItIsPinned) {
  scene::Scene scene = empty_scene();
  scene.cloths = {sheet("a", {0, 0, 1}, 0.4, 9), sheet("b", {0, 0, 1}, 0.4, 9)};
  scene::Pin pin;
  pin.high = {0.13, 1};  // pins two rows of particles
  scene.cloths[1].pins = {pin};
  const frame::SnapshotPtr first = production::SceneSimulation(scene).snapshot();
  const std::vector<Vec3>&a = first->states[0].positions, &b = first->states[1].positions;
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_GT(b[i].z(), a[i].z()) << i;
  EXPECT_LT(max_displacement(*first, *production::view_start(scene).snapshot), scene.cloths[0].material.thickness);
}

TEST(UntangledStart, ASheetThatLiesExactlyOnAnObstacleGoesOntoItsFront) {
  for (const bool is_floor : {true, false}) {
    scene::Scene scene = empty_scene();
    scene.cloths.push_back(sheet("sheet", {0, 0, 0.25}, 0.4, 9));
    if (is_floor)
      add_obstacle(scene, "floor", scene::Plane{}, {0, 0, 0.25});
    else
      add_obstacle(scene, "table", scene::BoxShape{{1, 1, 0.5}});
    const frame::SnapshotPtr first = production::SceneSimulation(scene).snapshot();
    EXPECT_GT(lowest(first->states[0].positions), 0.25);
    EXPECT_LT(max_displacement(*first, *production::view_start(scene).snapshot), scene.cloths[0].material.thickness);
  }
}

TEST(UntangledStart, ASheetOnWhichARopeLiesGoesBack) {
  scene::Scene scene = empty_scene();
  scene.cloths.push_back(sheet("sheet", {0, 0, 1}, 0.4, 9));
  scene::Rope rope;
  rope.name = "rope";
  rope.points = {{-0.3, 0.01, 1}, {0.3, 0.02, 1}};
  scene.cloths.push_back(scene::as_cloth(rope));
  EXPECT_EQ(refusal(scene), "");
}

TEST(UntangledStart, ACrumpledSheetThatCrossesItselfIsSmoothedWhereItDoes) {
  scene::Scene scene = empty_scene();
  scene.cloths.push_back(sheet("sheet", Vec3::Zero(), 0.3));
  scene.cloths[0].start_noise = 0.011;
  expect_untangled(scene, 100);
}

TEST(UntangledStart, WhatMayNotBeMovedIsNot) {
  scene::Scene scene = empty_scene();
  scene.cloths = {sheet("a", {0, 0, 0}), sheet("b", {0, 0, 0.2}, 0.6)};
  scene.cloths[1].pose.rotation = turned(80, Vec3(1, 0.2, 0));
  scene.cloths[0].start = scene::ClothStart::as_given;
  const frame::SnapshotPtr given = production::view_start(scene).snapshot,
                           first = production::SceneSimulation(scene).snapshot();
  EXPECT_EQ(count_intersections(*first), 0U);
  EXPECT_EQ(first->states[0].positions, given->states[0].positions);
  EXPECT_NE(first->states[1].positions, given->states[1].positions);
}

TEST(UntangledStart, ClothInsideABodyMayStayThereIfAnotherClothIsUntangled) {
  scene::Scene scene = empty_scene();
  scene.cloths = {sheet("a", {0, 0, 0}, 0.1, 4), sheet("b", {2, 0, 0}, 0.1, 4)};
  scene.cloths[0].start = scene::ClothStart::as_given;
  add_obstacle(scene, "drum", scene::Sphere{1});
  EXPECT_EQ(refusal(scene), "");
}

TEST(UntangledStart, ASheetThatAPoleGoesThroughIsRefusedWithWhereAndHowFar) {
  scene::Scene scene = empty_scene();
  scene.cloths.push_back(sheet("sheet", Vec3::Zero()));
  add_obstacle(scene, "pole", scene::Cylinder{0.05, 1.2});
  const std::string text = refusal(scene);
  EXPECT_NE(text.find("'sheet' in 'pole' around (0, 0, 0) m"), std::string::npos) << text;
  EXPECT_NE(text.find("by 0.60"), std::string::npos) << text;
}

TEST(UntangledStart, HasTheSameBitsForAnyNumberOfThreads) {
  scene::Scene scene = empty_scene();
  scene.cloths = {sheet("a", {0, 0, 0.05}), sheet("b", {0, 0, 0.2}, 0.6)};
  scene.cloths[1].pose.rotation = turned(80, Vec3(1, 0.2, 0));
  add_obstacle(scene, "ball", scene::Sphere{0.2});
  set_thread_count(1);
  const frame::SnapshotPtr one = production::SceneSimulation(scene).snapshot();
  set_thread_count(4);
  const frame::SnapshotPtr four = production::SceneSimulation(scene).snapshot();
  set_thread_count(0);
  EXPECT_EQ(count_intersections(*one), 0U);
  for (std::size_t s = 0; s < 2; ++s) EXPECT_EQ(one->states[s].positions, four->states[s].positions);
}

// The panels of a pattern are placed by Weft. So the scene cannot prevent that they intersect at the start.
TEST(UntangledStart, IsTheDefaultOfPatterns) {
  scene::Scene scene = empty_scene();
  scene::Cloth pillow = sheet("pillow", {0, 0, 1});
  pillow.start.reset();
  pillow.shape = scene::ClothShape::pattern;
  pillow.file = std::string(WEFT_SOURCE_DIR) + "/scenes/patterns/pillow.toml";
  pillow.edge_length = 0.04;
  scene.cloths.push_back(pillow);
  add_obstacle(scene, "ball", scene::Sphere{0.1}, {0, -0.1, 1.2});
  expect_untangled(scene);
}

TEST(UntangledStart, OfASceneThatIsApartNothingMoves) {
  scene::Scene scene = empty_scene();
  scene.cloths.push_back(sheet("sheet", {0, 0, 0.21}));
  add_obstacle(scene, "ball", scene::Sphere{0.2});
  EXPECT_EQ(max_displacement(*production::SceneSimulation(scene).snapshot(), *production::view_start(scene).snapshot),
            0);
}

}  // namespace
}  // namespace weft::untangle
