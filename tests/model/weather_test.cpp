// Gravity and air with keys, and the jet of a fan.
#include "physics/model/weather.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "film/environment/environment.hpp"
#include "support/scene_runs.hpp"

namespace weft::model {
namespace {

Weather weather_of(const std::string& text) {
  return Weather(environment::Environment(support::scene_of_text(text + "\n[[cloth]]\nname = \"sheet\"\n")).model);
}

TEST(Weather, OfASceneThatNamesNothingIsItsGravityAndWindEverywhere) {
  const Weather weather = weather_of("[physics]\ngravity = [1, 2, 3]\nwind = [4, 5, 6]");
  EXPECT_FALSE(weather.differs_from_wind());
  EXPECT_EQ(weather.gravity(7), Vec3(1, 2, 3));
  EXPECT_EQ(weather.air({8, 9, 10}, 7), Vec3(4, 5, 6));
  EXPECT_TRUE(weather.is_constant_between(0, 7));
}

TEST(Weather, GoesByItsKeysAndKeepsWhatTheyLeaveOut) {
  const Weather weather = weather_of(
      "[physics]\nwind = [2, 0, 0]\ninterpolation = \"linear\"\nkeys = [{ time = 1, gravity = [0, 0, -4] }, "
      "{ time = 2, wind = [6, 0, 0] }, { time = 3, gravity = [0, 0, 0] }]");
  EXPECT_EQ(weather.gravity(0), Vec3(0, 0, -4));
  EXPECT_EQ(weather.gravity(2), Vec3(0, 0, -4));
  EXPECT_EQ(weather.gravity(2.5), Vec3(0, 0, -2));
  EXPECT_EQ(weather.air(Vec3::Zero(), 1.5), Vec3(4, 0, 0));
  EXPECT_EQ(weather.air(Vec3::Zero(), 9), Vec3(6, 0, 0));
  EXPECT_TRUE(weather.is_constant_between(3, 4));
  EXPECT_FALSE(weather.is_constant_between(2, 2.1));
}

// Wind of keys carries gusts as a constant wind of the same velocity does; if it changes, by its integral over time.
TEST(Weather, OfKeysCarriesTheGusts) {
  const std::string gusts = "[physics.gusts]\nspeed = 2\n";
  const Weather calm = weather_of(gusts), windy = weather_of("[physics]\nwind = [6, 1, 0]\n" + gusts),
                keyed = weather_of("[physics]\nkeys = [{ time = 0.5, wind = [6, 1, 0] }]\n" + gusts);
  const Vec3 x(1, 2, 3), wind(6, 1, 0);
  EXPECT_GT((calm.air(x, 0.7) + wind - windy.air(x, 0.7)).norm(), 0.1);
  EXPECT_LT((keyed.air(x, 0.7) - windy.air(x, 0.7)).norm(), 1e-12);
  const Weather rising = weather_of(
      "[physics]\ninterpolation = \"linear\"\nkeys = [{ time = 0, wind = [0, 0, 0] }, { time = 1, wind = [6, 0, 0] "
      "}]\n" +
      gusts);
  EXPECT_LT((rising.air(x + Vec3(0.75, 0, 0), 0.5) - Vec3(3, 0, 0) - calm.air(x, 0.5)).norm(), 1e-12);
  EXPECT_LT((rising.air(x + Vec3(9, 0, 0), 2) - Vec3(6, 0, 0) - calm.air(x, 2)).norm(), 1e-12);
}

// The keys of another wind begin with the gusts where those before have carried them.
TEST(Weather, KeepsThePlaceOfItsGustsIfItsKeysAreReplaced) {
  const std::string gusts = "[physics.gusts]\nspeed = 2\n";
  const Weather before = weather_of("[physics]\nkeys = [{ time = 0, wind = [6, 0, 0] }]\n" + gusts);
  Weather after = weather_of("[physics]\nkeys = [{ time = 0, wind = [-4, 0, 0] }]\n" + gusts);
  const auto jump = [&] { return (after.air({1, 2, 3}, 2) - before.air({1, 2, 3}, 2) + Vec3(10, 0, 0)).norm(); };
  EXPECT_GT(jump(), 0.1);
  after.set_gust_displacement(2, before.gust_displacement(2));
  EXPECT_LT(jump(), 1e-12);
}

constexpr const char* kFan =
    "[physics]\nwind = [0, 0, 1]\n[[fan]]\nname = \"fan\"\nposition = [1, 0, 0]\ndirection = [0, 2, 0]\nspeed = 6\n"
    "radius = 0.2\nangle = 24\n";

TEST(Weather, OfAFanIsAJetInItsConeAndNothingElsewhere) {
  const Weather weather = weather_of(kFan);
  const double slope = std::tan(12 * std::numbers::pi / 180), apex = 0.2 / slope;
  const auto jet = [&](const Vec3& x) { return Vec3(weather.air(x, 0) - Vec3(0, 0, 1)); };
  EXPECT_LT((jet({1, 0, 0}) - Vec3(0, 6, 0)).norm(), 1e-12);                      // at the disc
  EXPECT_LT((jet({1, 3, 0}) - Vec3(0, 6 * apex / (apex + 3), 0)).norm(), 1e-12);  // decays as 1 / distance
  const double halfway = 0.5 * slope * (apex + 3);                                // half of the cone's radius
  EXPECT_NEAR(jet({1 + halfway, 3, 0}).norm(), 6 * apex / (apex + 3) * 0.5625, 1e-12);
  EXPECT_NEAR(jet({1 + halfway, 3, 0}).x() / jet({1 + halfway, 3, 0}).y(), 0.5 * slope, 1e-12);  // away from the apex
  EXPECT_EQ(jet({1 + 2.01 * halfway, 3, 0}), Vec3(0, 0, 0));                                     // beside the cone
  EXPECT_EQ(jet({1, -0.01, 0}), Vec3(0, 0, 0));                                                  // behind the disc
}

TEST(Weather, OfAFreeJetKeepsItsMomentum) {
  const Weather weather = weather_of(kFan);
  // Momentum flux per density, ∫ u_y² dA, through a plane across the axis at distance s from the apex of the cone.
  const double slope = std::tan(12 * std::numbers::pi / 180), apex = 0.2 / slope;
  const auto momentum = [&](double s) {
    constexpr int kRings = 2000;
    double sum = 0;
    for (int k = 0; k < kRings; ++k) {
      const double r = (k + 0.5) / kRings * slope * s;
      const Vec3 u = weather.air({1 + r, s - apex, 0}, 0) - Vec3(0, 0, 1);
      sum += u.y() * u.y() * 2 * std::numbers::pi * r * slope * s / kRings;
    }
    return sum;
  };
  EXPECT_NEAR(momentum(apex + 4) / momentum(apex + 0.5), 1, 1e-9);
}

TEST(Weather, OfAFanWithKeysTurnsAndStopsWithThem) {
  const Weather weather = weather_of(
      "[[fan]]\nname = \"fan\"\nfalloff = 0\nangle = 90\ninterpolation = \"linear\"\nkeys = [{ time = 0, position = "
      "[0, 0, "
      "0], direction = [1, 0, 0], speed = 4 }, { time = 1, direction = [0, 1, 0] }, { time = 2, speed = 0 }]");
  EXPECT_LT((weather.air({2, 0, 0}, 0) - Vec3(4, 0, 0)).norm(), 1e-12);
  EXPECT_LT((weather.air({0, 2, 0}, 1) - Vec3(0, 4, 0)).norm(), 1e-12);
  EXPECT_LT((weather.air({1, 1, 0}, 0.5).normalized() - Vec3(1, 1, 0).normalized()).norm(), 1e-12);
  EXPECT_LT((weather.air({0, 2, 0}, 1.5) - Vec3(0, 2, 0)).norm(), 1e-12);
  EXPECT_EQ(weather.air({0, 2, 0}, 3), Vec3(0, 0, 0));
}

TEST(Weather, BlowsOnNothingWithoutAirOrDrag) {
  const environment::Environment environment(
      support::scene_of_text(std::string(kFan) + "[[cloth]]\nname = \"sheet\"\nmaterial.drag = 0\n"));
  EXPECT_FALSE(Weather(environment.model).differs_from_wind());
}

}  // namespace
}  // namespace weft::model
