// Tests of CarriedStarts, which serve to find separating planes in the frame of a turning obstacle.
#include "physics/collision/response/carried_starts.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>

#include "physics/collision/response/separation.hpp"

namespace weft::collision {
namespace {

constexpr double kGap = 1e-4;  // between cloth and obstacle [m]

/// Vertices 0 to 5 are two parallel triangles of cloth, at y = kGap and y = 3 kGap. Vertices 6 to 8 are an obstacle at
/// y = 0: a blade of 0.6 m along x, which rotates about z and moves along x during the step. Parameter: angle [rad].
class BeforeATurningBlade : public ::testing::TestWithParam<double> {
 protected:
  BeforeATurningBlade() {
    for (const double y : {kGap, 3 * kGap})
      for (const Vec3& x : {Vec3(0.1, 0, 0), Vec3(0.13, 0, 0), Vec3(0.1, 0, 0.03)})
        x_t0_.push_back(x + y * Vec3::UnitY());
    for (const Vec3& x : {Vec3(-0.3, 0, -0.1), Vec3(0.3, 0, -0.1), Vec3(0.3, 0, 0.1)}) x_t0_.push_back(x);
    const double angle = GetParam();
    blade_.rotation = Eigen::AngleAxisd(angle, Vec3::UnitZ()).toRotationMatrix();
    blade_.translation = Vec3(0.02, 0, 0);
    x_t1_ = x_t0_;
    for (int v = 6; v < 9; ++v) x_t1_[v] = blade_.rotation * x_t0_[v] + blade_.translation;
    carried_ = CarriedStarts(6, kBodyOf);
    carried_.begin_step(x_t0_, x_t1_, std::vector<RigidMotion>{{}, {}, blade_});
  }

  static constexpr std::array<std::size_t, 9> kBodyOf{0, 0, 0, 1, 1, 1, 2, 2, 2};
  static constexpr CornerPair kInner{{0, 1, 2}, {6, 7, 8}}, kOuter{{3, 4, 5}, {6, 7, 8}};
  std::vector<Vec3> x_t0_, x_t1_;
  RigidMotion blade_;
  CarriedStarts carried_;
};

TEST_P(BeforeATurningBlade, ClothThatIsCarriedAlongIsApartThroughout) {
  for (int v = 0; v < 6; ++v) x_t1_[v] = blade_.rotation * x_t0_[v] + blade_.translation;
  for (const CornerPair& pair : {kInner, kOuter}) {
    const auto seen = find_separating_plane(pair, carried_.of(pair, x_t0_), x_t1_);
    ASSERT_TRUE(seen);
    EXPECT_NEAR(std::abs(seen->dot(blade_.rotation.col(1))), 1, 1e-6) << "a plane that turns with the blade";
    EXPECT_FALSE(separates(*seen, pair, x_t0_, x_t1_)) << "one that keeps its direction does not";
  }
}

TEST_P(BeforeATurningBlade, OneObstacleAloneLeavesClothRoom) {
  const std::vector<Triangle> triangles{{0, 1, 2}, {3, 4, 5}, {6, 7, 8}};
  Separation separation(triangles, {});
  separation.watch(std::vector<TrianglePair>{{0, 1}, {0, 2}, {1, 2}}, x_t0_);
  const std::vector<Index> limb_of(9, 0);
  PinchedPairs pinched(6, kBodyOf, limb_of);
  const std::vector<std::uint8_t> movable{1, 1, 1, 1, 1, 1, 0, 0, 0};
  ASSERT_FALSE(separation.find_failing(x_t0_, x_t1_, nullptr, &carried_).empty());
  const SeparationReport report = separation.enforce(x_t0_, x_t1_, movable, &pinched, &carried_);
  EXPECT_TRUE(report.separated);
  EXPECT_TRUE(pinched.empty());
  for (const CornerPair& pair : {kInner, kOuter}) EXPECT_GT(gap_along(blade_.rotation.col(1), pair, x_t1_), 0);
}

INSTANTIATE_TEST_SUITE_P(By, BeforeATurningBlade, ::testing::Values(0.05, 0.3, 1.0));

// A press comes down on cloth that is 0.25 mm above a floor. Carried along with the press, the start of the cloth would
// be below the floor.
TEST(CarriedStarts, ClothIsNotCarriedThroughAnObstacleThatStands) {
  std::vector<Vec3> x_t0;
  for (const double z : {0.0, kGap, -2.5 * kGap})  // heights of cloth, press, floor
    for (const Vec3& x : {Vec3(0, 0, z), Vec3(0.1, 0, z), Vec3(0, 0.1, z)}) x_t0.push_back(x);
  std::vector<Vec3> x_t1 = x_t0;
  const RigidMotion down{.translation = Vec3(0, 0, -3 * kGap)};
  for (int v = 3; v < 6; ++v) x_t1[v] += down.translation;
  const std::vector<std::size_t> body_of{0, 0, 0, 1, 1, 1, 2, 2, 2};
  CarriedStarts carried(3, body_of);
  carried.begin_step(x_t0, x_t1, std::vector<RigidMotion>{{}, down, {}});
  const std::vector<Index> limb_of(9, 0);
  PinchedPairs pinched(3, body_of, limb_of);

  const std::vector<Triangle> triangles{{0, 1, 2}, {3, 4, 5}, {6, 7, 8}};
  const CornerPair on_press{{0, 1, 2}, {3, 4, 5}}, on_floor{{0, 1, 2}, {6, 7, 8}};
  Separation separation(triangles, {});
  separation.watch(std::vector<TrianglePair>{{0, 1}, {0, 2}}, x_t0);
  const std::vector<std::uint8_t> movable{1, 1, 1, 0, 0, 0, 0, 0, 0};
  EXPECT_TRUE(separation.enforce(x_t0, x_t1, movable, &pinched, &carried).separated);
  EXPECT_TRUE(pinched.exempts(on_press) != pinched.exempts(on_floor)) << "there is no room between them";
  const CornerPair& kept = pinched.exempts(on_press) ? on_floor : on_press;
  EXPECT_TRUE(find_separating_plane(kept, x_t0, x_t1));
}

TEST(CarriedStarts, AreLookedAtOnlyForWhatTurns) {
  const std::vector<Vec3> x_t0(6, Vec3(1, 2, 3)), x_t1(6, Vec3(1, 2, 4));
  const std::vector<std::size_t> body_of{0, 0, 0, 1, 1, 1};
  CarriedStarts carried(3, body_of);
  const CornerPair pair{{0, 1, 2}, {3, 4, 5}};
  EXPECT_FALSE(carried.carries(1));
  carried.begin_step(x_t0, x_t1, std::vector<RigidMotion>{{}, {.translation = Vec3(0, 0, 1)}});
  EXPECT_TRUE(carried.carries(1));
  EXPECT_EQ(carried.by(1)[0], Vec3(1, 2, 4));
  EXPECT_EQ(carried.of(pair, x_t0).data(), x_t0.data());
  const Mat3 quarter = Eigen::AngleAxisd(1, Vec3::UnitZ()).toRotationMatrix();
  carried.begin_step(x_t0, x_t1, std::vector<RigidMotion>{{}, {.rotation = quarter}});
  EXPECT_EQ(carried.of(pair, x_t0)[0], quarter * x_t0[0]);
  EXPECT_EQ(carried.of(pair, x_t0)[3], x_t1[3]) << "the obstacle is where it ends, to the bit";
  const CornerPair of_cloths{{0, 1, 2}, {0, 1, 2}};
  EXPECT_EQ(carried.of(of_cloths, x_t0).data(), x_t0.data());
}

}  // namespace
}  // namespace weft::collision
