// Tests which contacts become prescribed velocities (walls), and which become springs.
#include "physics/collision/response/contact_response.hpp"

#include <gtest/gtest.h>

namespace weft::collision {
namespace {

constexpr double kResponseStep = 0.01;  // [s]

/// Contact of particle 1, `height` [m] above a still obstacle. `side`: 1 if the particle is side a of the contact, −1
/// if it is side b.
Contact over_floor(double height, double side = 1) {
  Contact contact;
  contact.particles = {0, 1, 0, 0};
  contact.weights = {0, side, 0, 0};
  contact.normal = side * Vec3::UnitZ();
  contact.relative_start = side * Vec3(0, 0, height);
  contact.against_obstacle = true;
  contact.range = contact.full_range = 0.001;
  contact.depth = contact.range - height;
  contact.stiffness = 1000;
  return contact;
}

struct Response {
  ContactResponse response;
  std::vector<Vec3> x_t0, x_t1;

  Response(ResponseForm form, double height) : response(form, {0.001, 0.001}), x_t0(2, Vec3(0, 0, height)) {
    x_t1 = x_t0;
    x_t1[1].z() -= 0.1;
    response.begin_step(kResponseStep);
  }
};

TEST(ContactResponse, SpringsHoldNothingAndAreSolvedOnce) {
  Response of(ResponseForm::springs, 0.002);
  of.response.add(over_floor(0.002), of.x_t0);
  of.response.prepare(of.x_t0, of.x_t1);
  EXPECT_EQ(of.response.springs().size(), 1U);
  EXPECT_TRUE(of.response.prescribed().empty());
  EXPECT_EQ(of.response.count_active(of.x_t1), 1);
  EXPECT_EQ(of.response.revise(of.x_t0, of.x_t1, [](Index) { return Vec3(Vec3::Zero()); }), 0);
}

TEST(ContactResponse, AParticleOnAnObstacleGetsAWallWhateverItsSide) {
  for (double side : {1.0, -1.0}) {
    Response of(ResponseForm::velocity_constraints, 0.002);
    of.response.add(over_floor(0.002, side), of.x_t0);
    of.response.prepare(of.x_t0, of.x_t1);
    EXPECT_TRUE(of.response.springs().empty());
    ASSERT_EQ(of.response.prescribed().size(), 1U);
    EXPECT_EQ(of.response.prescribed()[0].constraint.particle, 1);
    EXPECT_NEAR(of.response.prescribed()[0].x_end.z(), 0.001, 1e-12);  // stops at the activation distance
  }
}

// A wall has the motion of its obstacle, here 0.5 mm upward during the step.
TEST(ContactResponse, AWallGoesWithItsObstacle) {
  Response of(ResponseForm::velocity_constraints, 0.002);
  Contact contact = over_floor(0.002);
  contact.obstacle_end = Vec3(0, 0, -0.0005);
  of.response.add(contact, of.x_t0);
  of.response.prepare(of.x_t0, of.x_t1);
  ASSERT_EQ(of.response.prescribed().size(), 1U);
  EXPECT_NEAR(of.response.prescribed()[0].x_end.z(), 0.0015, 1e-12);
  EXPECT_NEAR(of.response.prescribed()[0].v_end.z(), 0.05, 1e-9);
}

TEST(ContactResponse, AllOtherContactsAreSpringsInEitherForm) {
  Response of(ResponseForm::velocity_constraints, 0.002);
  Contact between_cloths = over_floor(0.002);
  between_cloths.against_obstacle = false;
  of.response.add(between_cloths, of.x_t0);
  Contact of_an_edge = over_floor(0.002);
  of_an_edge.weights = {0.4, 0.6, 0, 0};
  of.response.add(of_an_edge, of.x_t0);
  // The particle is pinched: it is 1 mm inside the obstacle, where no wall may hold it.
  std::vector<Vec3> inside = of.x_t0;
  inside[1].z() = -0.001;
  of.response.add(over_floor(-0.001), inside);
  of.response.prepare(of.x_t0, of.x_t1);
  EXPECT_EQ(of.response.springs().size(), 3U);
  EXPECT_TRUE(of.response.prescribed().empty());
}

TEST(ContactResponse, AStepBeginsWithoutContacts) {
  for (ResponseForm form : {ResponseForm::springs, ResponseForm::velocity_constraints}) {
    Response of(form, 0.002);
    of.response.add(over_floor(0.002), of.x_t0);
    of.response.begin_step(kResponseStep);
    of.response.prepare(of.x_t0, of.x_t1);
    EXPECT_TRUE(of.response.springs().empty() && of.response.prescribed().empty());
  }
}

TEST(ContactResponse, SavedWallsDoNotFitSprings) {
  Response walls(ResponseForm::velocity_constraints, 0.002), springs(ResponseForm::springs, 0.002);
  walls.response.add(over_floor(0.002), walls.x_t0);
  walls.response.prepare(walls.x_t0, walls.x_t1);
  walls.response.accept();
  ByteWriter with_walls, without;
  walls.response.serialize(with_walls);
  springs.response.serialize(without);
  ByteReader fits{without.bytes}, does_not{with_walls.bytes};
  EXPECT_NO_THROW(springs.response.serialize(fits));
  EXPECT_TRUE(fits.bytes.empty());
  EXPECT_THROW(springs.response.serialize(does_not), std::runtime_error);
}

}  // namespace
}  // namespace weft::collision
