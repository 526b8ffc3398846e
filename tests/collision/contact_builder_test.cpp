// Tests of ContactBuilder: compares stiffness, activation distance and friction of contacts with their formulas.
#include "physics/collision/contact_builder.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace weft::collision {
namespace {

constexpr double kBuilderStep = 0.01;  // [s]

/// Two cloths of one triangle each, at the heights 0 and 1 mm, and an obstacle of one triangle at the height −1 mm.
struct Scene {
  Bodies bodies;
  std::vector<double> masses{1e-3, 2e-3, 3e-3, 4e-3, 5e-3, 6e-3};  // [kg]
  std::vector<Vec3> x_t0, x_t1;
  PinchedPairs pinched;

  Scene() {
    const std::vector<Triangle> one{{0, 1, 2}};
    bodies.add(one, 3, {.deformable = true, .thickness = 0.002, .friction = 0.2});
    bodies.add(one, 3, {.deformable = true, .thickness = 0.003, .friction = 0.8});
    bodies.add(one, 3, {.friction = 0.45});
    for (double z : {0.0, 0.001, -0.001})
      for (const Vec3& corner : {Vec3(0, 0, z), Vec3(0.1, 0, z), Vec3(0, 0.1, z)}) x_t0.push_back(corner);
    x_t1 = x_t0;
    for (std::size_t v = 6; v < 9; ++v) x_t1[v].z() += 0.0004;  // the obstacle rises by 0.4 mm
    pinched = PinchedPairs(6, bodies.body_of_vertices(), bodies.limb_of_vertices());
  }

  StepMotion motion() const { return {x_t0, x_t0, x_t1, kBuilderStep}; }

  std::vector<Contact> contacts_of(const std::vector<Proximity>& proximities, const ContactParameters& parameters) {
    ContactBuilder builder(bodies, parameters, masses);
    ContactResponse response(ResponseForm::springs, masses);
    response.begin_step(kBuilderStep);
    builder.begin_step();
    builder.add(proximities, pinched, motion(), response);
    return {response.springs().begin(), response.springs().end()};
  }
};

/// Near pair of vertex `v` and `face`, 1 mm apart along z.
Proximity vertex_face(Index v, const Triangle& face) {
  return {{{v, face[0], face[1], face[2]}, {1, -0.5, -0.3, -0.2}, Vec3::UnitZ(), 0.001, ProximityKind::vertex_face},
          {0, 0}};
}

/// Near pair of edge a (vertices 0, 1) and edge b (vertices 3, 4). `outside_a`, `outside_b`: Proximity::outside_wedge.
/// `along_a`: position of the closest point on edge a, from 0 at vertex 0 to 1 at vertex 1.
Proximity edges(double outside_a, double outside_b, double along_a) {
  return {{{0, 1, 3, 4}, {1 - along_a, along_a, -0.5, -0.5}, Vec3::UnitZ(), 0.001, ProximityKind::edge_edge},
          {outside_a, outside_b}};
}

// For 0.2 and 0.8, the geometric mean is 0.4. It differs from the arithmetic mean (0.5), the harmonic mean (0.32) and
// the extremes.
TEST(ContactBuilder, FrictionOfAPairIsTheGeometricMean) {
  const Scene scene;
  const ContactBuilder builder(scene.bodies, {}, scene.masses);
  EXPECT_DOUBLE_EQ(builder.friction_of(0, 1).sliding, 0.4);
  EXPECT_DOUBLE_EQ(builder.friction_of(1, 0).static_friction, 0.4);
  EXPECT_DOUBLE_EQ(builder.friction_of(0, 2).sliding, std::sqrt(0.2 * 0.45));
  EXPECT_DOUBLE_EQ(builder.friction_of(1, 1).sliding, 0.8);
}

TEST(ContactBuilder, APairMayHaveFrictionOfItsOwnInEitherOrder) {
  const Scene scene;
  const ContactBuilder builder(scene.bodies, {.friction = {{2, 0, {0.1, 0.3}}}}, scene.masses);
  for (const auto& [a, b] : {std::pair(0, 2), std::pair(2, 0)}) {
    EXPECT_EQ(builder.friction_of(a, b).sliding, 0.1);
    EXPECT_EQ(builder.friction_of(a, b).static_friction, 0.3);
  }
  EXPECT_DOUBLE_EQ(builder.friction_of(0, 1).sliding, 0.4);
}

// Vertices 1 and 2 of the obstacle form a patch with its own thickness and friction. Friction of a pair of bodies takes
// precedence over that of patches.
TEST(ContactBuilder, APatchHasThicknessAndFrictionOfItsOwn) {
  Scene scene;
  const std::vector<Triangle> one{{0, 1, 2}};
  const std::vector<std::uint8_t> patch{0, 1, 1};
  scene.bodies = {};
  scene.bodies.add(one, 3, {.deformable = true, .thickness = 0.002, .friction = 0.2});
  scene.bodies.add(one, 3, {.deformable = true, .thickness = 0.003, .friction = 0.8});
  scene.bodies.add(one, 3, {.friction = 0.45}, std::vector<Patch>{{patch, 0.01, 0.9}});
  const auto at = [](Index obstacle_vertex) {
    Proximity p = vertex_face(0, {6, 7, 8});
    for (std::size_t k = 1; k < 4; ++k) p.weights[k] = p.vertices[k] == obstacle_vertex ? -1 : 0;
    return p;
  };
  const auto contacts = scene.contacts_of({at(6), at(7)}, {});
  ASSERT_EQ(contacts.size(), 2u);
  EXPECT_DOUBLE_EQ(contacts[0].range, 0.001);
  EXPECT_DOUBLE_EQ(contacts[0].friction, std::sqrt(0.2 * 0.45));
  EXPECT_DOUBLE_EQ(contacts[1].range, 0.5 * (0.002 + 0.01));
  EXPECT_DOUBLE_EQ(contacts[1].friction, std::sqrt(0.2 * 0.9));
  const ContactBuilder builder(scene.bodies, {.friction = {{2, 0, {0.1, 0.3}}}}, scene.masses);
  EXPECT_EQ(builder.friction_of(3, 0).sliding, 0.1);
  EXPECT_EQ(builder.friction_of(2, 0).sliding, 0.1);
}

TEST(ContactBuilder, FrictionReachesTheContact) {
  Scene scene;
  const auto contacts =
      scene.contacts_of({vertex_face(0, {3, 4, 5}), vertex_face(1, {6, 7, 8})}, {.friction = {{0, 2, {0.1, 0.3}}}});
  ASSERT_EQ(contacts.size(), 2U);
  EXPECT_DOUBLE_EQ(contacts[0].friction, 0.4);
  EXPECT_DOUBLE_EQ(contacts[1].friction, 0.1);
  EXPECT_DOUBLE_EQ(contacts[1].static_friction, 0.3);
}

// The fraction is 1 if the contact direction is inside the wedges. For edge pairs, the surfaces must also be folded at
// the edges, and the closest points be away from the ends. Otherwise, the fraction falls linearly to 0.
TEST(StiffnessShare, FadesTowardsTheFlatTheOutsideOfAWedgeAndTheEnds) {
  EXPECT_EQ(stiffness_fraction(vertex_face(0, {3, 4, 5})), 1);
  Proximity beside_border = vertex_face(0, {3, 4, 5});
  beside_border.outside_wedge[0] = 0.05;
  EXPECT_NEAR(stiffness_fraction(beside_border), 0.5, 1e-12);
  beside_border.outside_wedge[0] = 0.1;
  EXPECT_EQ(stiffness_fraction(beside_border), 0);
  EXPECT_EQ(stiffness_fraction(edges(-0.5, -0.5, 0.5)), 1);
  // Nearly flat surfaces: as the sum of both sines inside the wedges grows from 0.05 to 0.2, the fraction grows from 0
  // to 1.
  EXPECT_EQ(stiffness_fraction(edges(-0.025, -0.025, 0.5)), 0);
  EXPECT_NEAR(stiffness_fraction(edges(0, -0.125, 0.5)), 0.5, 1e-12);
  EXPECT_NEAR(stiffness_fraction(edges(-0.1, -0.1, 0.5)), 1, 1e-12);
  // Outside the wedge of either edge, the fraction falls from 1 to 0 as the sine grows from 0 to 0.1.
  EXPECT_EQ(stiffness_fraction(edges(0, -0.5, 0.5)), 1);
  EXPECT_NEAR(stiffness_fraction(edges(0.05, -0.5, 0.5)), 0.5, 1e-12);
  EXPECT_NEAR(stiffness_fraction(edges(-0.5, 0.05, 0.5)), 0.5, 1e-12);
  EXPECT_EQ(stiffness_fraction(edges(-0.5, 0.1, 0.5)), 0);
  // Outside a wedge of a nearly flat surface, both factors apply.
  EXPECT_NEAR(stiffness_fraction(edges(0.05, -0.175, 0.5)), 0.5 * 0.5, 1e-12);
  // On the last tenth of an edge, the fraction falls to 0 at the end.
  EXPECT_NEAR(stiffness_fraction(edges(-0.5, -0.5, 0.05)), 0.5, 1e-12);
  EXPECT_NEAR(stiffness_fraction(edges(-0.5, -0.5, 0.975)), 0.25, 1e-12);
  EXPECT_EQ(stiffness_fraction(edges(-0.5, -0.5, 0.1)), 1);
  EXPECT_EQ(stiffness_fraction(edges(-0.5, -0.5, 0)), 0);
}

// Rims of stacked blocks may cross at flat faces and at the ends of edges. So without cloth, only a direction outside
// of a wedge reduces the stiffness.
TEST(StiffnessShare, OfBlocksFadesOutsideOfAWedgeOnly) {
  EXPECT_EQ(stiffness_fraction(edges(0, 0, 0.01), false), 1);
  EXPECT_EQ(stiffness_fraction(edges(-0.5, -0.5, 0), false), 1);
  EXPECT_NEAR(stiffness_fraction(edges(0.05, -0.5, 0.5), false), 0.5, 1e-12);
  EXPECT_EQ(stiffness_fraction(edges(0.1, 0, 0.5), false), 0);
}

TEST(ContactBuilder, TheShareScalesTheStiffnessAndNoneMakesNoContact) {
  Scene scene;
  const auto contacts =
      scene.contacts_of({edges(-0.5, -0.5, 0.5), edges(-0.5, -0.5, 0.05), edges(-0.5, -0.5, 0)}, {.stiffness = 1e9});
  ASSERT_EQ(contacts.size(), 2U);
  EXPECT_DOUBLE_EQ(contacts[0].stiffness, 1e9);
  EXPECT_NEAR(contacts[1].stiffness, 0.5e9, 1);
}

// The stiffness [N/m] is 100 M/h², with the weighted mean mass M of the particles, and at least the scene's value.
TEST(ContactBuilder, StiffnessFollowsTheMassOfWhatIsPushed) {
  Scene scene;
  constexpr double kSceneStep = 3 * kBuilderStep;  // the stiffness depends on the scene's step, not on the actual step
  const auto contacts =
      scene.contacts_of({vertex_face(0, {3, 4, 5}), vertex_face(1, {6, 7, 8})}, {.stiffness = 10, .step = kSceneStep});
  const double mass = (1e-3 + 0.5 * 4e-3 + 0.3 * 5e-3 + 0.2 * 6e-3) / 2;
  EXPECT_NEAR(contacts[0].stiffness, 100 * mass / (kSceneStep * kSceneStep), 1e-9);
  EXPECT_NEAR(contacts[1].stiffness, 100 * 2e-3 / (kSceneStep * kSceneStep), 1e-9);  // the obstacle adds no mass
  EXPECT_EQ(scene.contacts_of({vertex_face(1, {6, 7, 8})}, {.stiffness = 1e6})[0].stiffness, 1e6);
}

TEST(ContactBuilder, TheRangeIsHalfOfBothThicknesses) {
  Scene scene;
  const auto contacts = scene.contacts_of({vertex_face(0, {3, 4, 5}), vertex_face(1, {6, 7, 8})}, {});
  EXPECT_DOUBLE_EQ(contacts[0].range, 0.0025);
  EXPECT_DOUBLE_EQ(contacts[1].range, 0.001);
  EXPECT_EQ(contacts[1].range, contacts[1].full_range);
}

TEST(ContactBuilder, AnObstacleActsByWhereItIsAtBothEndsOfTheStep) {
  Scene scene;
  const auto contacts = scene.contacts_of({vertex_face(1, {6, 7, 8}), vertex_face(0, {3, 4, 5})}, {});
  const Vec3 point_t0(0.03, 0.02, -0.001);  // of the obstacle, with weights 0.5, 0.3, 0.2
  EXPECT_TRUE(contacts[0].against_obstacle);
  EXPECT_LT((contacts[0].obstacle_start + point_t0).norm(), 1e-15);
  EXPECT_LT((contacts[0].obstacle_end + point_t0 + Vec3(0, 0, 0.0004)).norm(), 1e-15);
  EXPECT_LT((contacts[0].relative_start - (scene.x_t0[1] - point_t0)).norm(), 1e-15);
  EXPECT_EQ(contacts[0].weights, (std::array<double, 4>{1, 0, 0, 0}));
  EXPECT_FALSE(contacts[1].against_obstacle);
  EXPECT_TRUE(contacts[1].obstacle_end.isZero());
}

TEST(ContactBuilder, PinchedClothAndItsObstacleAreLeftOut) {
  Scene scene;
  scene.pinched.add({{0, 1, 2}, {6, 7, 8}});
  scene.pinched.note_origins(BroadPhase(scene.bodies.surfaces(), scene.x_t0), scene.x_t0);
  const auto contacts = scene.contacts_of({vertex_face(0, {6, 7, 8}), vertex_face(3, {6, 7, 8})}, {});
  ASSERT_EQ(contacts.size(), 1U);
  EXPECT_EQ(contacts[0].particles[0], 3);
}

// A pinched particle at a depth of 2 mm is pushed out at 0.2 m/s. If the exit is blocked, the stiffness is a twentieth.
TEST(ContactBuilder, PinchedClothIsPushedBackSlowlyAndWithoutRoomSoftly) {
  const Scene scene;
  const ContactBuilder builder(scene.bodies, {.stiffness = 1e6}, scene.masses);
  ContactResponse response(ResponseForm::springs, scene.masses);
  response.begin_step(kBuilderStep);
  for (const bool has_room : {false, true})
    builder.add_pinched({{{0, 6, 7, 8}, {1, -0.5, -0.3, -0.2}, -Vec3::UnitZ(), -0.002}, has_room}, scene.motion(),
                        response);
  ASSERT_EQ(response.springs().size(), 2U);
  for (const auto& spring : response.springs()) {
    EXPECT_DOUBLE_EQ(spring.range, -0.002 + 0.2 * kBuilderStep);
    EXPECT_EQ(spring.friction, 0);
    EXPECT_EQ(spring.static_friction, 0);
  }
  EXPECT_DOUBLE_EQ(response.springs()[0].stiffness, 0.05e6);
  EXPECT_DOUBLE_EQ(response.springs()[1].stiffness, 1e6);
}

TEST(ContactBuilder, WhatWouldMeetBecomesAContactOnceAtTheDistanceThatItHas) {
  Scene scene;
  ContactBuilder builder(scene.bodies, {}, scene.masses);
  ContactResponse response(ResponseForm::springs, scene.masses);
  response.begin_step(kBuilderStep);
  builder.begin_step();
  builder.add({}, scene.pinched, scene.motion(), response);
  const CornerPair pair{{3, 4, 5}, {0, 1, 2}};
  EXPECT_TRUE(builder.add_failing(pair, closest_features(pair, scene.x_t0), scene.motion(), response));
  EXPECT_FALSE(builder.add_failing(pair, closest_features(pair, scene.x_t0), scene.motion(), response));
  ASSERT_EQ(response.springs().size(), 1U);
  const Contact& contact = response.springs()[0];
  EXPECT_DOUBLE_EQ(contact.range, 0.001);  // limited to the present distance [m]
  EXPECT_DOUBLE_EQ(contact.full_range, 0.0025);
  EXPECT_NEAR((contact.normal - Vec3::UnitZ()).norm(), 0, 1e-12);
}

TEST(ContactBuilder, WhatIsInContactAlreadyIsNoNewContact) {
  Scene scene;
  ContactBuilder builder(scene.bodies, {}, scene.masses);
  ContactResponse response(ResponseForm::springs, scene.masses);
  response.begin_step(kBuilderStep);
  builder.begin_step();
  // The closest features are vertex 3 and the face below it, or a pair at the same distance.
  const CornerPair pair{{3, 4, 5}, {0, 1, 2}};
  Proximity known;
  known.vertices = closest_features(pair, scene.x_t0).vertices;
  known.weights = closest_features(pair, scene.x_t0).points.weights;
  builder.add(std::vector{known}, scene.pinched, scene.motion(), response);
  EXPECT_FALSE(builder.add_failing(pair, closest_features(pair, scene.x_t0), scene.motion(), response));
  EXPECT_EQ(response.springs().size(), 1U);
}

// In a continued step, each end of a failing edge gets a contact. An edge is a triangle that repeats its second end.
TEST(ContactBuilder, EachEndOfAnEdgeGetsOneContact) {
  Scene scene;
  ContactBuilder builder(scene.bodies, {}, scene.masses);
  ContactResponse response(ResponseForm::springs, scene.masses);
  response.begin_step(kBuilderStep);
  builder.begin_step();
  std::vector<Vec3> x = scene.x_t0;
  x[3] = {0.03, 0.03, 0.001}, x[4] = {0.02, 0.02, 0.0015};
  const CornerPair pair{{3, 4, 4}, {6, 7, 8}};
  builder.add_failing(pair, closest_features(pair, x), {scene.x_t0, x, x, kBuilderStep}, response);
  std::vector<Index> ends;
  for (const Contact& contact : response.springs())
    for (std::size_t k = 0; k < 4; ++k)
      if (contact.weights[k] != 0) ends.push_back(contact.particles[k]);
  EXPECT_EQ(ends, (std::vector<Index>{3, 4})) << "the closest end, and the other one";
}

// With velocity constraints, every corner of the cloth triangle stays above the obstacle's plane.
TEST(ContactBuilder, EachCornerThatWouldMeetAnObstacleGetsAWall) {
  Scene scene;
  for (std::size_t v = 0; v < 3; ++v) scene.x_t1[v].z() -= 0.01;
  for (const CornerPair& pair : {CornerPair{{0, 1, 2}, {6, 7, 8}}, CornerPair{{6, 7, 8}, {0, 1, 2}}}) {
    ContactBuilder builder(scene.bodies, {}, scene.masses);
    ContactResponse response(ResponseForm::velocity_constraints, scene.masses);
    response.begin_step(kBuilderStep);
    builder.begin_step();
    EXPECT_TRUE(builder.add_failing(pair, closest_features(pair, scene.x_t0), scene.motion(), response));
    response.prepare(scene.x_t0, scene.x_t1);
    EXPECT_TRUE(response.springs().empty());
    ASSERT_EQ(response.prescribed().size(), 3U);
    for (const PrescribedParticle& held : response.prescribed()) {
      // The corner starts 1 mm above the obstacle, at its activation distance, and must follow the obstacle, which
      // rises by 0.4 mm.
      EXPECT_NEAR(held.x_end.z(), 0.0004, 1e-9) << held.constraint.particle;
    }
  }
}

}  // namespace
}  // namespace weft::collision
