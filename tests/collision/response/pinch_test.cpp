// Tests of PinchedPairs: which pairs are exempt, in which direction pinched cloth is pushed, and what is reported.
#include "physics/collision/response/pinch.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "collision/hierarchy/test_motions.hpp"
#include "core/archive.hpp"
#include "physics/collision/response/pinch_report.hpp"
#include "physics/mesh/shapes.hpp"

namespace weft::collision {
namespace {

/// One triangle of cloth at z = 0.11 m, and three boxes of 0.2 m: body 1 below it (top at 0.1 m), body 2 above it
/// (bottom at 0.14 m), and body 3 far beside it.
class PinchedTriangle : public ::testing::Test {
 protected:
  PinchedTriangle() {
    scene_.add({{{0, 0, 0.11}, {0.02, 0, 0.11}, {0, 0.02, 0.11}}, {{0, 1, 2}}});
    bodies_.add(scene_.triangles, 3, {.deformable = true});
    const mesh::Mesh box = mesh::make_box(Vec3(0.2, 0.2, 0.2), 0, 2);
    for (const Vec3& place : {Vec3(0, 0, 0), Vec3(0, 0, 0.24), Vec3(1, 0, 0)}) {
      testing::TestMesh moved{box.positions, {box.topology.triangles.begin(), box.topology.triangles.end()}};
      for (Vec3& p : moved.x) p += place;
      scene_.add(moved);
      bodies_.add(moved.triangles, static_cast<Index>(moved.x.size()), {.rigid = true});
      x_.insert(x_.end(), moved.x.begin(), moved.x.end());
    }
    x_.insert(x_.begin(), {Vec3(0, 0, 0.11), Vec3(0.02, 0, 0.11), Vec3(0, 0.02, 0.11)});
    surfaces_ = scene_.surfaces();
    broad_phase_ = BroadPhase(surfaces_, x_);
    for (std::size_t b = 0; b < surfaces_.size(); ++b) body_of_.insert(body_of_.end(), surfaces_[b].vertex_count, b);
    limb_of_.assign(body_of_.size(), 0);
    pinched_ = PinchedPairs(3, body_of_, limb_of_);
  }

  /// The cloth triangle paired with the nearest face of a box.
  CornerPair with(std::size_t body) const {
    return {scene_.triangles[0], nearest_point(x_[0], surfaces_[body].triangles, x_).face};
  }
  void move_cloth_to(double z) {
    for (int v = 0; v < 3; ++v) x_[v][2] = z;
    for (std::size_t b = 0; b < surfaces_.size(); ++b) broad_phase_.refit(b, {x_, x_}, 0.001);
  }

  testing::MovingScene scene_;
  std::vector<Vec3> x_;
  std::vector<Surface> surfaces_;
  Bodies bodies_;
  BroadPhase broad_phase_;
  std::vector<std::size_t> body_of_;
  std::vector<Index> limb_of_;
  PinchedPairs pinched_;
};

TEST_F(PinchedTriangle, IsPushedBackToTheSideThatItCameFrom) {
  pinched_.add(with(1));
  pinched_.note_origins(broad_phase_, x_);
  EXPECT_TRUE(pinched_.exempts(with(1)));
  EXPECT_FALSE(pinched_.exempts(with(2)));
  // The cloth is nearer to the bottom than to the top, through which it entered the box.
  move_cloth_to(-0.07);
  const std::vector<PinchedPairs::Push> pushes = pinched_.find_pushes(broad_phase_, x_, 0.003);
  ASSERT_EQ(pushes.size(), 3U);
  for (const auto& [push, has_room] : pushes) {
    EXPECT_TRUE(has_room);
    EXPECT_LT((push.normal - Vec3::UnitZ()).norm(), 1e-12);
    EXPECT_NEAR(push.distance, -0.17, 1e-12);
    Vec3 difference = Vec3::Zero();
    for (int k = 0; k < 4; ++k) difference += push.weights[k] * x_[push.vertices[k]];
    EXPECT_LT((difference - push.distance * push.normal).norm(), 1e-12);
  }
}

// The obstacle has rotated by 90 degrees since it pinched the cloth, so that other faces are nearest now.
TEST_F(PinchedTriangle, IsPushedThroughThePinchingFaceAlsoAfterItHasRotated) {
  pinched_.add(with(1));
  pinched_.note_origins(broad_phase_, x_);
  for (Index v = surfaces_[1].first_vertex; v < surfaces_[1].first_vertex + surfaces_[1].vertex_count; ++v)
    x_[v] = Vec3(x_[v].z(), x_[v].y(), -x_[v].x());
  move_cloth_to(0.09);
  const std::vector<PinchedPairs::Push> pushes = pinched_.find_pushes(broad_phase_, x_, 0.003);
  ASSERT_EQ(pushes.size(), 3U);
  for (const auto& [push, has_room] : pushes) EXPECT_LT((push.normal - Vec3::UnitX()).norm(), 1e-12);
}

// The upper box comes down into the lower one. If the cloth were pushed up out of the lower box, it would enter the
// upper one.
TEST_F(PinchedTriangle, HasNoRoomWhereTheWayBackLeadsIntoAnotherObstacle) {
  pinched_.add(with(1));
  pinched_.note_origins(broad_phase_, x_);
  for (Index v = surfaces_[2].first_vertex; v < surfaces_[2].first_vertex + surfaces_[2].vertex_count; ++v)
    x_[v].z() -= 0.06;
  move_cloth_to(0.09);
  const std::vector<PinchedPairs::Push> pushes = pinched_.find_pushes(broad_phase_, x_, 0.003);
  ASSERT_EQ(pushes.size(), 3U);
  for (const auto& [push, has_room] : pushes) EXPECT_FALSE(has_room);
}

// The cloth comes from inside the lower box and is now above it, so it is pushed down. Only the upper box can block
// this way.
TEST_F(PinchedTriangle, HasRoomInTheContainerFromWhichItCame) {
  move_cloth_to(0.09);
  pinched_.add(with(1));
  pinched_.note_origins(broad_phase_, x_);
  move_cloth_to(0.11);
  for (const bool is_blocked : {false, true}) {
    const std::vector<PinchedPairs::Push> pushes = pinched_.find_pushes(broad_phase_, x_, 0.003);
    ASSERT_EQ(pushes.size(), 3U);
    for (const auto& [push, has_room] : pushes) {
      EXPECT_LT((push.normal + Vec3::UnitZ()).norm(), 1e-12);
      EXPECT_EQ(has_room, !is_blocked);
    }
    // The upper box comes down into the lower one.
    for (Index v = surfaces_[2].first_vertex; v < surfaces_[2].first_vertex + surfaces_[2].vertex_count; ++v)
      x_[v].z() -= 0.06;
    move_cloth_to(0.11);
  }
}

TEST_F(PinchedTriangle, IsLetGoOnlyWhereItIsApartAndOnItsSide) {
  pinched_.add(with(1));
  pinched_.note_origins(broad_phase_, x_);
  for (const double z : {0.0, 0.1}) {  // inside the box, on its top
    move_cloth_to(z);
    pinched_.update_exempted(scene_.triangles, broad_phase_, x_);
    EXPECT_EQ(pinched_.size(), 1U) << z;
  }
  // Corner 0 is outside again; corners 1 and 2 are inside.
  move_cloth_to(0.11);
  x_[1][2] = x_[2][2] = 0.05;
  pinched_.update_exempted(scene_.triangles, broad_phase_, x_);
  EXPECT_EQ(pinched_.size(), 1U);
  move_cloth_to(0.102);
  pinched_.update_exempted(scene_.triangles, broad_phase_, x_);
  EXPECT_TRUE(pinched_.empty());
}

// The second cloth triangle is a neighbour, here with the same corners. If a triangle passes through a limb, its
// neighbours have no separating plane from this limb either, so they are exempt, too.
TEST_F(PinchedTriangle, ExemptsItsNeighboursFromTheSameLimb) {
  pinched_.add(with(1));
  const std::vector<Triangle> cloth{{0, 1, 2}, {0, 2, 1}};
  CornerPair beside = with(1);
  beside.a = cloth[1];
  EXPECT_TRUE(pinched_.exempts(beside));
  beside.b = with(2).b;
  EXPECT_FALSE(pinched_.exempts(beside));
  pinched_.note_origins(broad_phase_, x_);
  for (const auto& [z, pinched] : {std::pair(0.0, 2U), std::pair(0.11, 0U)}) {  // inside the box, outside again
    move_cloth_to(z);
    pinched_.update_exempted(cloth, broad_phase_, x_);
    EXPECT_EQ(pinched_.size(), pinched) << z;
  }
}

// Two corners of the cloth are in the lower box, one is outside. Triangles that share only the outer corner are not
// exempt; otherwise cloth under tension would be pulled into the box, one ring of triangles after another.
TEST_F(PinchedTriangle, ExemptsNoNeighboursAtACornerOutsideTheLimb) {
  pinched_.add(with(1));
  pinched_.note_origins(broad_phase_, x_);
  const Triangle face = with(1).b;
  for (const Index corner : {0, 1, 2}) EXPECT_TRUE(pinched_.exempts({{corner, corner, corner}, face})) << corner;
  move_cloth_to(0.09);
  x_[0].z() = 0.11;
  pinched_.update_exempted(scene_.triangles, broad_phase_, x_);
  EXPECT_TRUE(pinched_.exempts({scene_.triangles[0], face}));
  EXPECT_FALSE(pinched_.exempts({{0, 0, 0}, face}));
  for (const Index corner : {1, 2}) EXPECT_TRUE(pinched_.exempts({{corner, corner, corner}, face})) << corner;
  pinched_.update_exempted(scene_.triangles, broad_phase_, x_, true);  // after a rejected step
  EXPECT_TRUE(pinched_.exempts({{0, 0, 0}, face}));
  pinched_.update_exempted(scene_.triangles, broad_phase_, x_);
  EXPECT_FALSE(pinched_.exempts({{0, 0, 0}, face}));
  pinched_.add(with(1));  // the pair is exempted again
  EXPECT_TRUE(pinched_.exempts({{0, 0, 0}, face}));
}

// A ball with a radius of 0.1 m has pinched the first cloth triangle at its top. The second triangle crosses the
// surface of the ball 40 degrees from the top, and must be pushed out there.
TEST(PinchedOnABall, ReturnsWhereEachTriangleWasReached) {
  const auto at = [](double degrees, double radius, double y) {
    const double angle = degrees * std::numbers::pi / 180;
    return Vec3(radius * std::sin(angle), y, radius * std::cos(angle));
  };
  testing::MovingScene scene;
  std::vector<Vec3> x{at(-5, 0.09, 0), at(5, 0.09, 0.01), at(30, 0.09, 0), at(50, 0.11, 0.01)};
  const std::vector<Triangle> cloth{{0, 1, 2}, {1, 2, 3}};
  scene.add({x, cloth});
  const mesh::Mesh ball = mesh::make_sphere(0.1, 48);
  scene.add({ball.positions, {ball.topology.triangles.begin(), ball.topology.triangles.end()}});
  x.insert(x.end(), ball.positions.begin(), ball.positions.end());
  const std::vector<Surface> surfaces = scene.surfaces();
  const BroadPhase broad_phase(surfaces, x);
  std::vector<std::size_t> body_of(4, 0);
  body_of.resize(x.size(), 1);
  const std::vector<Index> limb_of(x.size(), 0);
  PinchedPairs pinched(4, body_of, limb_of);
  const Triangle top = nearest_point(Vec3(0, 0, 0.1), surfaces[1].triangles, x).face;
  pinched.add(PinchedPairs::Key{cloth[0], 1, 0}, {1, {top}});
  pinched.update_exempted(scene.triangles, broad_phase, x);
  ASSERT_EQ(pinched.size(), 2U);
  EXPECT_EQ(pinched.origins().at({cloth[0], 1, 0}).faces, std::vector<Triangle>{top});
  for (const Triangle& face : pinched.origins().at({cloth[1], 1, 0}).faces)
    EXPECT_GT(face_normal(face, x).dot(at(40, 1, 0)), std::cos(0.3));  // at most 0.3 rad from the crossing
}

// The top of a box, at z = 0.1 m, is a limb of its own, and thus an open surface. The cloth is 5 mm lower than the top,
// beside the box or inside it.
TEST(PinchedByAnOpenLimb, IsOnItsSideBeyondTheBorderButNotInTheBody) {
  testing::MovingScene scene;
  const std::vector<Triangle> cloth{{0, 1, 2}};
  std::vector<Vec3> x{{0.11, 0, 0.095}, {0.13, 0, 0.095}, {0.11, 0.02, 0.095}};
  scene.add({x, cloth});
  testing::TestMesh box;
  for (const double z : {-0.1, 0.1, 0.1})  // heights of bottom, upper rim of the sides, top
    for (const Vec3& corner : {Vec3(-0.1, -0.1, z), Vec3(0.1, -0.1, z), Vec3(0.1, 0.1, z), Vec3(-0.1, 0.1, z)})
      box.x.push_back(corner);
  box.triangles = {{0, 2, 1}, {0, 3, 2}, {0, 1, 5}, {0, 5, 4}, {1, 2, 6},  {1, 6, 5},
                   {2, 3, 7}, {2, 7, 6}, {3, 0, 4}, {3, 4, 7}, {8, 9, 10}, {8, 10, 11}};
  scene.add(box);
  x.insert(x.end(), box.x.begin(), box.x.end());
  const std::vector<Surface> surfaces = scene.surfaces();
  BroadPhase broad_phase(surfaces, x);
  std::vector<std::size_t> body_of(3, 0);
  body_of.resize(x.size(), 1);
  std::vector<Index> limb_of(x.size(), 0);
  std::fill(limb_of.begin() + 3, limb_of.begin() + 11, 1);
  PinchedPairs pinched(3, body_of, limb_of);
  const CornerPair pair{cloth[0], surfaces[1].triangles.back()};
  pinched.add(pair);
  pinched.note_origins(broad_phase, x);
  EXPECT_EQ(pinched.origins().at({cloth[0], 1, 0}).side, 1);
  const std::vector<PinchedPairs::Push> beside = pinched.find_pushes(broad_phase, x, 0.05);
  ASSERT_EQ(beside.size(), 3U);
  for (const auto& [push, has_room] : beside) {
    EXPECT_NEAR(push.distance, push.normal.dot(x[push.vertices[0]] - Vec3(0.1, x[push.vertices[0]].y(), 0.1)), 1e-12);
    EXPECT_GT(push.distance, 0.01);
    EXPECT_GT(push.normal.x(), 0.5) << "away from the border";
  }
  for (const auto& [shift, is_pinched] : {std::pair(-0.11, true), std::pair(0.0, false)}) {
    std::vector<Vec3> moved = x;
    for (std::size_t v = 0; v < 3; ++v) moved[v].x() += shift;
    for (std::size_t b = 0; b < 2; ++b) broad_phase.refit(b, {moved, moved}, 0.001);
    pinched.update_exempted(cloth, broad_phase, moved);
    EXPECT_EQ(!pinched.empty(), is_pinched) << shift;
  }
}

// All corners of the cloth are outside the lower box; a vertical edge of the box pierces the cloth.
TEST_F(PinchedTriangle, IsPushedOffACornerThatSticksThroughIt) {
  pinched_.add(with(1));
  pinched_.note_origins(broad_phase_, x_);
  x_[0] = {0.12, 0.06, 0}, x_[1] = {0.06, 0.12, 0}, x_[2] = {0.13, 0.13, 0};
  move_cloth_to(0.095);
  std::size_t crossings = 0;
  for (const auto& [push, has_room] : pinched_.find_pushes(broad_phase_, x_, 0.003)) {
    if (push.weights[3] != -1) continue;  // push of a single particle
    ++crossings;
    EXPECT_EQ(push.distance, 0);
    EXPECT_NEAR(push.normal.cwiseAbs().maxCoeff(), 1, 1e-12) << "the normal of a face of the box";
    EXPECT_NEAR(push.weights[0] + push.weights[1] + push.weights[2], 1, 1e-12);
  }
  EXPECT_GE(crossings, 2U) << "two sides of the box are crossed";
}

// Example: a face in an armpit, with one corner on the arm and two on the trunk.
TEST_F(PinchedTriangle, IsRestoredAlsoIfTheFaceThatMetItJoinsTwoLimbs) {
  const CornerPair pair = with(1);
  limb_of_[pair.b[1]] = 1;
  pinched_.add(pair);
  pinched_.note_origins(broad_phase_, x_);
  ByteWriter writer;
  pinched_.serialize(writer);
  PinchedPairs restored(3, body_of_, limb_of_);
  ByteReader reader{writer.bytes};
  ASSERT_NO_THROW(restored.serialize(reader));
  ASSERT_EQ(restored.size(), 1U);
  EXPECT_EQ(restored.origins().at({pair.a, 1, 0}).faces, std::vector<Triangle>{pair.b});
  EXPECT_TRUE(restored.exempts(pair));
}

TEST_F(PinchedTriangle, IsReportedOnceWithTheObstacleThatIsNearestBesides) {
  pinched_.add(with(1));
  pinched_.note_origins(broad_phase_, x_);
  move_cloth_to(0.09);
  const std::vector<Pinch> pinches = list_pinches(pinched_, bodies_, broad_phase_, x_);
  ASSERT_EQ(pinches.size(), 1U);
  EXPECT_EQ(pinches[0].cloth, 0U);
  EXPECT_EQ(pinches[0].obstacle, 1U);
  EXPECT_EQ(pinches[0].pressing_obstacle, 2U);
  EXPECT_EQ(pinches[0].place, x_[0]);
}

TEST_F(PinchedTriangle, IsFreshForAnObstacleThatDidNotPinchItsClothBefore) {
  const PinchedPairs before = pinched_;
  EXPECT_FALSE(find_new_pinch(pinched_, before));
  const CornerPair met{scene_.triangles[0], surfaces_[2].triangles.back()};
  pinched_.add(met);
  EXPECT_EQ(find_new_pinch(pinched_, before), met);
  EXPECT_FALSE(find_new_pinch(pinched_, pinched_));
}

}  // namespace
}  // namespace weft::collision
