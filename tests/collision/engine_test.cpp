// Tests of Engine, which joins all parts of collision handling, with a square of cloth above a floor.
#include "physics/collision/engine.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "collision/hierarchy/test_meshes.hpp"
#include "core/archive.hpp"

namespace weft::collision {
namespace {

constexpr double kEngineStep = 0.01;  // [s]
constexpr double kThickness = 0.002;  // of the cloth [m]; contacts with the floor act below 1 mm, and the detection
                                      // distance is 3 mm
struct Sheet {
  int n;
  std::vector<double> planes{0};  // heights of the floor and the ceiling [m]
  std::vector<Vec3> x;
  std::vector<double> masses;

  Sheet(int squares, double height, std::optional<double> ceiling = std::nullopt) : n(squares) {
    if (ceiling) planes.push_back(*ceiling);
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) x.emplace_back(0.02 * i, 0.02 * j, height);
    masses.assign(x.size(), 1e-4);
    for (double z : planes)
      for (const Vec3& corner : {Vec3(-1, -1, z), Vec3(2, -1, z), Vec3(2, 2, z), Vec3(-1, 2, z)}) x.push_back(corner);
  }

  std::size_t particles() const { return masses.size(); }
  std::vector<std::uint8_t> movable() const {
    std::vector<std::uint8_t> movable(x.size(), kFixed);
    std::fill_n(movable.begin(), particles(), std::uint8_t{kFree});
    return movable;
  }
  std::vector<Vec3> falling(double by) const {
    std::vector<Vec3> end = x;
    for (std::size_t i = 0; i < particles(); ++i) end[i].z() -= by;
    return end;
  }
  Bodies bodies() const {
    Bodies made;
    made.add(testing::grid_triangles(n + 1), static_cast<Index>(particles()),
             {.deformable = true, .thickness = kThickness, .friction = 0.3});
    for (std::size_t p = 0; p < planes.size(); ++p)
      made.add(std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}, 4, {.friction = 0.3, .may_move = false});
    return made;
  }
  Engine engine(const EngineParameters& parameters = {}) const { return {bodies(), parameters, x, masses}; }
};

// Begins a step without correcting its expected end `to`.
void begin_step(Engine& engine, const std::vector<Vec3>& from, std::vector<Vec3> to) {
  engine.begin_step(from, to, {}, kEngineStep);
}

TEST(Engine, EachParticleNearAFloorIsAProximityAndAContact) {
  Sheet near(3, 0.0029), far(3, 0.0031);
  Engine of_near = near.engine(), of_far = far.engine();
  begin_step(of_near, near.x, near.x);
  begin_step(of_far, far.x, far.x);
  EXPECT_EQ(of_near.proximities(), 16);
  EXPECT_NEAR(of_near.min_distance(), 0.0029, 1e-15);
  EXPECT_EQ(of_near.response().springs().size(), 16U);
  EXPECT_EQ(of_far.proximities(), 0);
  EXPECT_TRUE(std::isinf(of_far.min_distance()));
}

// Candidate pairs stay valid while no particle moves farther than the Verlet margin of 1.5 mm. The sheet sinks by
// 1.45 mm, to 2.95 mm above the floor, which is below the detection distance.
TEST(Engine, FindsNearPairsAfterMotionWithinTheVerletMargin) {
  Sheet sheet(3, 0.0044);
  Engine engine = sheet.engine();
  begin_step(engine, sheet.x, sheet.x);
  EXPECT_EQ(engine.proximities(), 0);
  const std::vector<Vec3> lower = sheet.falling(0.00145);
  begin_step(engine, lower, lower);
  EXPECT_EQ(engine.proximities(), 16);
}

// With `coherence`, the engine reuses closest points. Nothing moves, so it reuses all of them, and a new search must
// find as many.
TEST(Engine, KeptClosestPointsAreThoseOfTheSearch) {
  Sheet sheet(3, 0.0029);
  EngineParameters parameters;
  parameters.search.coherence = true;
  Engine engine = sheet.engine(parameters);
  for (int step = 0; step < 3; ++step) {
    begin_step(engine, sheet.x, sheet.x);
    EXPECT_EQ(engine.proximities(), 16);
    EXPECT_EQ(engine.response().springs().size(), 16U);
    EXPECT_TRUE(engine.is_separated(sheet.x, sheet.falling(0.0028)));
    EXPECT_FALSE(engine.is_separated(sheet.x, sheet.falling(0.0030)));
  }
  engine.forget();
  begin_step(engine, sheet.x, sheet.x);
  EXPECT_EQ(engine.proximities(), 16);
}

TEST(Engine, DetectsCollisionsUpToTheEndOfTheTrajectory) {
  Sheet sheet(3, 0.05);
  Engine engine = sheet.engine();
  begin_step(engine, sheet.x, sheet.x);
  EXPECT_TRUE(engine.is_separated(sheet.x, sheet.falling(0.0499)));
  EXPECT_FALSE(engine.is_separated(sheet.x, sheet.falling(0.0501)));
  // At this end, the sheet does not intersect the floor, but it has passed through the floor.
  EXPECT_FALSE(engine.is_separated(sheet.x, sheet.falling(0.1)));
}

TEST(Engine, FailingPairsBecomeContactsOnce) {
  Sheet sheet(3, 0.05);
  Engine engine = sheet.engine();
  const std::vector<Vec3> end = sheet.falling(0.06);
  begin_step(engine, sheet.x, sheet.x);
  EXPECT_TRUE(engine.response().springs().empty());
  ASSERT_FALSE(engine.is_separated(sheet.x, end));
  const int fresh = engine.add_failing_contacts(sheet.x, end);
  EXPECT_GT(fresh, 0);
  EXPECT_EQ(static_cast<int>(engine.response().springs().size()), fresh);
  EXPECT_EQ(engine.add_failing_contacts(sheet.x, end), 0);
}

TEST(Engine, APredictedEndBelowTheFloorIsPushedUp) {
  Sheet sheet(3, 0.05);
  Engine engine = sheet.engine();
  const std::vector<std::uint8_t> movable = sheet.movable();
  const std::vector<Vec3> through = sheet.falling(0.06), above = sheet.falling(0.04);
  std::vector<Vec3> guess = through, kept = above;
  EXPECT_TRUE(engine.begin_step(sheet.x, guess, movable, kEngineStep));
  EXPECT_NE(guess, through);
  EXPECT_TRUE(engine.is_separated(sheet.x, guess));
  EXPECT_FALSE(engine.begin_step(sheet.x, kept, movable, kEngineStep));
  EXPECT_EQ(kept, above);
}

// The sheet falls to 0.4 mm below the floor, and is pushed up. The ceiling sinks to 2.8 mm, so that its distance to the
// sheet is below the detection distance (3 mm) only after the push.
TEST(Engine, FindsPairsThatAreNearOnlyAfterThePredictedEndIsPushed) {
  Sheet sheet(3, 0.001, 0.0042);
  const std::vector<std::uint8_t> movable = sheet.movable();
  for (const bool reuse : {true, false}) {
    EngineParameters parameters;
    parameters.search.reuse = reuse;
    Engine engine = sheet.engine(parameters);
    std::vector<Vec3> guess = sheet.falling(0.0014);
    for (std::size_t v = guess.size() - 4; v < guess.size(); ++v) guess[v].z() = 0.0028;
    EXPECT_TRUE(engine.begin_step(sheet.x, guess, movable, kEngineStep));
    EXPECT_EQ(engine.proximities(), 32) << (reuse ? "with reuse" : "without reuse");
  }
}

TEST(Engine, APredictedEndBelowTheFloorGivesContactsBeforeTheFirstSolve) {
  Sheet sheet(3, 0.05);
  Engine engine = sheet.engine();
  begin_step(engine, sheet.x, sheet.falling(0.06));
  EXPECT_FALSE(engine.response().springs().empty());
}

TEST(Engine, PushingApartSeparatesTheTrajectories) {
  Sheet sheet(3, 0.05);
  Engine engine = sheet.engine();
  std::vector<Vec3> end = sheet.falling(0.06);
  const std::vector<std::uint8_t> movable = sheet.movable();
  begin_step(engine, sheet.x, sheet.x);
  ASSERT_FALSE(engine.is_separated(sheet.x, end));
  EXPECT_TRUE(engine.push_apart(sheet.x, end, movable).separated);
  EXPECT_TRUE(engine.failing().empty());
  EXPECT_TRUE(engine.is_separated(sheet.x, end));
  for (std::size_t i = 0; i < sheet.particles(); ++i) EXPECT_GT(end[i].z(), 0);
}

// Particle 0 passes through the floor (`corner`), then the whole sheet does (`all`).
TEST(Engine, PairsFailAnewOnlyUntilTheyWerePushedApart) {
  Sheet sheet(3, 0.05);
  Engine engine = sheet.engine();
  const std::vector<std::uint8_t> movable = sheet.movable();
  std::vector<Vec3> corner = sheet.x, all = sheet.falling(0.06);
  corner[0] = all[0];
  const auto fails_anew = [&](std::span<const Vec3> end) {
    EXPECT_FALSE(engine.is_separated(sheet.x, end));
    return engine.fails_anew();
  };
  begin_step(engine, sheet.x, sheet.x);
  EXPECT_TRUE(fails_anew(corner));
  std::vector<Vec3> pushed = corner;
  ASSERT_TRUE(engine.push_apart(sheet.x, pushed, movable).separated);
  EXPECT_FALSE(fails_anew(corner));
  EXPECT_TRUE(fails_anew(all));
  begin_step(engine, sheet.x, sheet.x);
  EXPECT_TRUE(fails_anew(corner));
}

// A step that continues from an intermediate state (`bend`) has new contacts, one of them for each pair that was pushed
// apart. Slip is measured from the start of the step. Further contacts, without friction, keep corners on their side of
// a plane.
TEST(Engine, ARestartedStepUsesTheContactsOfItsIntermediateState) {
  Sheet sheet(3, 0.05);
  Engine engine = sheet.engine();
  std::vector<Vec3> bend = sheet.falling(0.06);
  const std::vector<std::uint8_t> movable = sheet.movable();
  begin_step(engine, sheet.x, sheet.x);
  ASSERT_FALSE(engine.is_separated(sheet.x, bend));
  ASSERT_TRUE(engine.push_apart(sheet.x, bend, movable).separated);
  engine.continue_from(bend);

  const auto contacts = engine.response().springs();
  ASSERT_FALSE(contacts.empty());
  int smooth = 0;
  for (const Contact& contact : contacts) {
    Vec3 start = contact.obstacle_start, end = contact.obstacle_end;
    for (std::size_t k = 0; k < 4; ++k) {
      start += contact.weights[k] * sheet.x[contact.particles[k]];
      end += contact.weights[k] * bend[contact.particles[k]];
    }
    EXPECT_LT((contact.relative_start - start).norm(), 1e-15);
    EXPECT_NEAR(contact.depth, contact.range - contact.normal.dot(end), 1e-15);
    smooth += contact.friction == 0;
    if (contact.friction == 0) {
      EXPECT_LT(contact.depth, 1e-15);  // no force at `bend`
    }
  }
  EXPECT_GT(smooth, 0);
  EXPECT_LT(smooth, static_cast<int>(contacts.size()));

  // From the intermediate state, an end beyond the floor is refused, as from the start; an end above the floor is
  // accepted.
  std::vector<Vec3> through = bend, up = bend;
  for (std::size_t i = 0; i < sheet.particles(); ++i) through[i].z() -= 0.01, up[i].z() += 1;
  EXPECT_FALSE(engine.is_separated(bend, through));
  EXPECT_TRUE(engine.is_separated(bend, up));
}

// A ceiling comes down to 0.1 mm below the floor. With `may_pinch`, the cloth between them is exempt; otherwise the
// step is refused.
TEST(Engine, ClothWithoutRoomIsPinchedWhereThatIsAllowed) {
  Sheet sheet(2, 0.005, 0.01);
  std::vector<Vec3> end = sheet.x;
  for (std::size_t v = end.size() - 4; v < end.size(); ++v) end[v].z() = -0.0001;
  const std::vector<std::uint8_t> movable = sheet.movable();

  Engine engine = sheet.engine();
  begin_step(engine, sheet.x, end);
  std::vector<Vec3> refused = end, pinched = end;
  EXPECT_FALSE(engine.push_apart(sheet.x, refused, movable, false).separated);
  EXPECT_EQ(engine.pinched_pairs(), 0);
  EXPECT_TRUE(engine.push_apart(sheet.x, pinched, movable, true).separated);
  EXPECT_GT(engine.pinched_pairs(), 0);
  EXPECT_TRUE(engine.is_separated(sheet.x, pinched));  // is_separated() skips pinched pairs
}

// The ceiling passes through the cloth, which is then above the ceiling. Contacts between them would keep the cloth on
// this wrong side.
TEST(Engine, PinchedClothGetsNoContactsWithWhatPinchesIt) {
  Sheet sheet(2, 0.005, 0.01);
  std::vector<Vec3> end = sheet.x;
  for (std::size_t v = end.size() - 4; v < end.size(); ++v) end[v].z() = -0.0001;
  const std::vector<std::uint8_t> movable = sheet.movable();
  Engine engine = sheet.engine();
  begin_step(engine, sheet.x, end);
  ASSERT_FALSE(engine.is_separated(sheet.x, end));
  ASSERT_TRUE(engine.push_apart(sheet.x, end, movable, true).separated);
  ASSERT_GT(engine.pinched_pairs(), 0);
  engine.continue_from(end);
  EXPECT_TRUE(engine.response().springs().empty());
}

// The ceiling has passed through the cloth, which is pushed down out of it. A pyramid far below, which cannot meet the
// cloth, has moved by 1 m since candidate pairs were collected. It is on the way out, but far beyond its end.
TEST(Engine, AnObstacleFarAwayDoesNotBlockTheWayOutOfPinchedCloth) {
  Sheet sheet(2, 0.005, 0.01);
  std::vector<Vec3> x = sheet.x;
  for (const Vec3& corner : {Vec3(-1, -1, -3), Vec3(1, -1, -3), Vec3(1, 1, -3), Vec3(-1, 1, -3), Vec3(0, 0, -2)})
    x.push_back(corner + Vec3(0.52, 0.02, 0));
  Bodies bodies = sheet.bodies();
  bodies.add(std::vector<Triangle>{{0, 2, 1}, {0, 3, 2}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}, 5, {});
  std::vector<std::uint8_t> movable = sheet.movable();
  movable.resize(x.size(), kFixed);
  std::vector<Vec3> pinched = x;
  for (std::size_t v = sheet.particles() + 4; v < sheet.particles() + 8; ++v) pinched[v].z() = -0.0001;
  Engine engine(std::move(bodies), {}, x, sheet.masses);
  begin_step(engine, x, pinched);
  ASSERT_FALSE(engine.is_separated(x, pinched));
  ASSERT_TRUE(engine.push_apart(x, pinched, movable, true).separated);
  begin_step(engine, pinched, pinched);
  std::vector<Vec3> moved = pinched;
  for (std::size_t v = moved.size() - 5; v < moved.size(); ++v) moved[v].x() -= 1;
  begin_step(engine, moved, moved);
  ASSERT_FALSE(engine.response().springs().empty());
  const double full = numerics.contact.inertial_stiffness * sheet.masses[0] / (kEngineStep * kEngineStep);
  for (const Contact& contact : engine.response().springs()) EXPECT_NEAR(contact.stiffness, full, 1e-9 * full);
}

// A tilted ceiling pinches the cloth on one side. When the predicted end of the next step is corrected, no further
// pairs may be exempted.
TEST(Engine, APredictedEndExemptsNoPairs) {
  Sheet sheet(6, 0.005, 0.01);
  const std::vector<std::uint8_t> movable = sheet.movable();
  std::vector<int> exempted;
  for (const bool separates_guess : {false, true}) {
    Engine engine = sheet.engine();
    std::vector<Vec3> tilted = sheet.x;
    for (std::size_t v = tilted.size() - 4; v < tilted.size(); ++v) tilted[v].z() = 0.5 * (tilted[v].x() - 0.03);
    begin_step(engine, sheet.x, tilted);
    ASSERT_TRUE(engine.push_apart(sheet.x, tilted, movable, true).separated);
    std::vector<Vec3> down = tilted;
    for (std::size_t v = down.size() - 4; v < down.size(); ++v) down[v].z() = -0.05;
    std::vector<Vec3> guess = down;
    engine.begin_step(tilted, guess, separates_guess ? std::span(movable) : std::span<std::uint8_t>(), kEngineStep);
    exempted.push_back(engine.pinched_pairs());
    EXPECT_TRUE(engine.push_apart(tilted, down, movable, true).separated);
    EXPECT_GT(engine.pinched_pairs(), exempted[0]);
  }
  EXPECT_EQ(exempted[1], exempted[0]);
}

TEST(Engine, ASheetThroughTheFloorMeetsItAtTheStart) {
  Sheet apart(2, 0.001), through(2, 0.001);
  through.x[4].z() = -0.001;
  Engine of_apart = apart.engine(), of_through = through.engine();
  EXPECT_TRUE(of_apart.find_intersections(apart.x).empty());
  const auto meetings = of_through.find_intersections(through.x);
  ASSERT_FALSE(meetings.empty());
  for (const CornerPair& pair : meetings) {
    EXPECT_EQ(of_through.bodies().body_of(pair.a[0]), 0U);
    EXPECT_EQ(of_through.bodies().body_of(pair.b[0]), 1U);
  }
}

// The state is saved within a step and restored into a new engine. The sheet is folded and crumpled, so that some of
// the planes found at the start do not separate during the step and are replaced.
TEST(Engine, ARestoredEngineGoesOnAsTheSavedOne) {
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> number(-1, 1);
  const auto shaken = [&](const Sheet& of, double by) {
    std::vector<Vec3> x = of.x;
    for (std::size_t i = 0; i < of.particles(); ++i)
      x[i] += by * Vec3(number(generator), number(generator), number(generator));
    return x;
  };
  Sheet sheet(12, 0.004);
  for (int j = 0; j <= 12; ++j)
    for (int i = 7; i <= 12; ++i) sheet.x[i + 13 * j] = sheet.x[12 - i + 13 * j] + Vec3(0.003, 0.002, 0.0036);
  sheet.x = shaken(sheet, 0.0008);
  Engine saved = sheet.engine(), restored = sheet.engine(), fresh = sheet.engine();
  const std::vector<Vec3> lower = shaken(sheet, 0.0008);
  begin_step(saved, sheet.x, lower);
  ASSERT_TRUE(saved.is_separated(sheet.x, lower));
  begin_step(fresh, sheet.x, sheet.x);
  ByteWriter writer;
  saved.serialize(writer, lower);
  ByteReader reader{writer.bytes};
  restored.serialize(reader, lower);
  EXPECT_TRUE(reader.bytes.empty());
  ByteWriter of_fresh;
  fresh.serialize(of_fresh, lower);
  EXPECT_GT(writer.bytes.size(), of_fresh.bytes.size());  // with the replaced planes

  for (Engine* engine : {&saved, &restored}) begin_step(*engine, lower, lower);
  ASSERT_EQ(saved.response().springs().size(), restored.response().springs().size());
  for (std::size_t c = 0; c < saved.response().springs().size(); ++c) {
    EXPECT_EQ(saved.response().springs()[c].particles, restored.response().springs()[c].particles);
    EXPECT_EQ(saved.response().springs()[c].stiffness, restored.response().springs()[c].stiffness);
  }
  ByteWriter again, of_restored;
  saved.serialize(again, lower);
  restored.serialize(of_restored, lower);
  EXPECT_EQ(again.bytes, of_restored.bytes);
}

}  // namespace
}  // namespace weft::collision
