// A pattern that is drawn for one body, on another body: measurements, and the resulting scale.
#include "film/garment/fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "support/test_folder.hpp"

namespace weft::garment {
namespace {

// Radii of a rotationally symmetric body of 1.7 m [m], at the heights of knees, hips, waist, chest, shoulders and neck.
double radius(double z) {
  const std::vector<std::pair<double, double>> places{{0, 0.08},    {0.5, 0.09}, {0.9, 0.16}, {1.1, 0.11}, {1.28, 0.15},
                                                      {1.34, 0.15}, {1.42, 0.2}, {1.5, 0.06}, {1.7, 0.06}};
  for (std::size_t k = 1; k < places.size(); ++k)
    if (z <= places[k].first)
      return std::lerp(places[k - 1].second, places[k].second,
                       (z - places[k - 1].first) / (places[k].first - places[k - 1].first));
  return 0.06;
}

Wearer round_wearer() {
  constexpr int kAround = 96, kUp = 171;
  Wearer wearer;
  for (int j = 0; j < kUp; ++j)
    for (int i = 0; i < kAround; ++i) {
      const double angle = 2 * std::numbers::pi * i / kAround, z = 0.01 * j;
      wearer.skin.emplace_back(radius(z) * std::cos(angle), radius(z) * std::sin(angle), z);
    }
  for (int j = 0; j + 1 < kUp; ++j)
    for (int i = 0; i < kAround; ++i) {
      const int a = j * kAround + i, b = j * kAround + (i + 1) % kAround;
      wearer.triangles.push_back({a, b, a + kAround});
      wearer.triangles.push_back({b, b + kAround, a + kAround});
    }
  wearer.regions.assign(wearer.skin.size(), Region::trunk);
  wearer.neck = 1.46;
  wearer.left_leg = Limb{Vec3(0.08, 0, 0.9), Vec3(0.08, 0, 0.5), Vec3(0.08, 0, 0.1)};
  wearer.right_leg = Limb{Vec3(-0.08, 0, 0.9), Vec3(-0.08, 0, 0.5), Vec3(-0.08, 0, 0.1)};
  return wearer;
}

// The shoulders are wider than the chest, and must not count as chest. Tolerances: sections are 10 mm apart, so the
// girth is off by up to 19 mm where the radius has a slope of 0.3; polygons of 96 corners are shorter than circles by
// 0.02 %.
TEST(Fit, MeasuresGirthsOfHipsWaistAndChestAndTheHeight) {
  const Measures measures = measure(round_wearer());
  EXPECT_NEAR(*measures.hip, 2 * std::numbers::pi * 0.16, 0.02);
  EXPECT_NEAR(*measures.waist, 2 * std::numbers::pi * 0.11, 0.02);
  EXPECT_NEAR(*measures.chest, 2 * std::numbers::pi * 0.15, 0.03);
  EXPECT_NEAR(*measures.height, 1.7, 0.011);
}

// A puppet has a ball between chest and hips. At the bottom of the ball, its sections shrink to a point, which is no
// waist.
TEST(Fit, TakesNoTipOfAPartForTheWaist) {
  constexpr double kBall = 0.13, kBottom = 1.02;
  Wearer wearer = round_wearer();
  for (Vec3& x : wearer.skin) {
    if (x.z() < kBottom || x.z() > 1.1) continue;
    const double above = std::min(x.z() - kBottom, kBall);
    const double ball = std::sqrt(above * (2 * kBall - above)) + 1e-4;
    x.head<2>() *= ball / x.head<2>().norm();
  }
  const double waist = *measure(wearer).waist;
  EXPECT_GT(waist, 2 * std::numbers::pi * 0.085);
  EXPECT_LT(waist, 2 * std::numbers::pi * 0.14);
}

TEST(Fit, TakesTheLargestRatioOfTheGirthsAndThatOfTheNecks) {
  const Wearer wearer = round_wearer();
  const Measures own = measure(wearer);
  Pattern pattern;
  pattern.measures = {*own.chest / 1.1, *own.waist / 1.3, *own.hip / 0.9, {}, {}};
  EXPECT_LT((fit(pattern, wearer, "cloth.c").factors - Vec2(1.3, 1)).norm(), 1e-12);
  // Heights are compared at the neck, so the size of the head does not move the garment.
  const double height = wearer.neck / kNeckHeightRatio / 1.2;
  pattern.measures = {{}, {}, *own.hip / 0.9, {}, height};
  EXPECT_LT((fit(pattern, wearer, "cloth.c").factors - Vec2(0.9, 1.2)).norm(), 1e-12);
  pattern.measures = {{}, {}, {}, {}, height};
  EXPECT_LT((fit(pattern, wearer, "cloth.c").factors - Vec2(1.2, 1.2)).norm(), 1e-12);
  pattern.measures = {};
  support::expect_error(ExitCode::scene_invalid, "cloth.c.fit: expected a pattern that names the measures",
                        [&] { fit(pattern, wearer, "cloth.c"); });
}

// Arms are tubes, 0.3 m around near the chest: as thick as the arms of a figure with a short trunk.
TEST(Fit, GivesWayToThickArmsAndKeepsTheNeckInItsPlace) {
  constexpr double kGirth = 0.3, kLength = 0.6;
  constexpr int kAround = 64, kAlong = 61;
  Wearer wearer = round_wearer();
  for (const double side : {1.0, -1.0}) {
    const auto first = static_cast<Index>(wearer.skin.size());
    for (int j = 0; j < kAlong; ++j)
      for (int i = 0; i < kAround; ++i) {
        const double angle = 2 * std::numbers::pi * i / kAround, radius = kGirth / (2 * std::numbers::pi);
        wearer.skin.emplace_back(side * (0.2 + kLength * j / (kAlong - 1)), radius * std::cos(angle),
                                 1.4 + radius * std::sin(angle));
      }
    for (int j = 0; j + 1 < kAlong; ++j)
      for (int i = 0; i < kAround; ++i) {
        const Index a = first + j * kAround + i, b = first + j * kAround + (i + 1) % kAround;
        wearer.triangles.push_back({a, b, a + kAround});
        wearer.triangles.push_back({b, b + kAround, a + kAround});
      }
    wearer.regions.resize(wearer.skin.size(), side > 0 ? Region::left_arm : Region::right_arm);
    (side > 0 ? wearer.left_arm : wearer.right_arm) =
        Limb{Vec3(side * 0.2, 0, 1.4), Vec3(side * 0.45, 0, 1.4), Vec3(side * 0.7, 0, 1.4)};
  }
  EXPECT_NEAR(*measure(wearer).arm, kGirth, 1e-3 * kGirth);  // a polygon of 64 corners is shorter by 0.04 %
  Pattern pattern;
  pattern.measures = {*measure(wearer).chest, {}, {}, *measure(wearer).arm / 1.5, 1.7};
  const Fit thick = fit(pattern, wearer, "cloth.c");
  EXPECT_LT((thick.factors - Vec2(1.5, 1.5)).norm(), 1e-12);
  EXPECT_NEAR(kNeckHeightRatio * 1.7 * thick.factors.y() + thick.rise, wearer.neck, 1e-12);
  pattern.measures.arm = 1;
  EXPECT_NEAR(fit(pattern, wearer, "cloth.c").factors.x(), 1, 1e-12);
  EXPECT_NEAR(fit(pattern, wearer, "cloth.c").rise, 0, 1e-12);
}

// A flat figure: each arm is one rectangle, whose sections are lines.
TEST(Fit, MeasuresNoFlatArms) {
  Wearer wearer = round_wearer();
  for (const double side : {1.0, -1.0}) {
    const auto first = static_cast<Index>(wearer.skin.size());
    for (const double along : {0.2, 0.8})
      for (const double up : {1.37, 1.43}) wearer.skin.emplace_back(side * along, 0, up);
    wearer.triangles.push_back({first, first + 2, first + 1});
    wearer.triangles.push_back({first + 1, first + 2, first + 3});
    wearer.regions.resize(wearer.skin.size(), side > 0 ? Region::left_arm : Region::right_arm);
    (side > 0 ? wearer.left_arm : wearer.right_arm) =
        Limb{Vec3(side * 0.2, 0, 1.4), Vec3(side * 0.45, 0, 1.4), Vec3(side * 0.7, 0, 1.4)};
  }
  EXPECT_FALSE(measure(wearer).arm.has_value());
  EXPECT_EQ(*measure(wearer).chest, *measure(round_wearer()).chest);
}

// The outline of a panel can be drawn at the height at which it is worn. The panel then has no position.
TEST(Fit, RaisesFlatPanelsWithoutAPositionToo) {
  Pattern pattern;
  pattern.panels.resize(2);
  pattern.panels[1].position = Vec2(0.1, 1);
  pattern.scale_by(Vec2(2, 1.5), -0.5);
  ASSERT_TRUE(pattern.panels[0].position.has_value());
  EXPECT_LT((*pattern.panels[0].position - Vec2(0, -0.5)).norm(), 1e-12);
  EXPECT_LT((*pattern.panels[1].position - Vec2(0.2, 1)).norm(), 1e-12);
  // Seams place bent panels that state no position.
  pattern.panels[0].position.reset();
  pattern.panels[1].around = Around::torso;
  pattern.scale_by(Vec2(2, 1.5), -0.5);
  EXPECT_FALSE(pattern.panels[0].position.has_value());
}

// A panel that lies on its side in the drawing is worn upright: its horizontal direction is vertical on the wearer.
TEST(Fit, ScalesPanelsThatTurnAsTheyAreWorn) {
  Pattern pattern;
  Panel& panel = pattern.panels.emplace_back();
  panel.rotation = 90;
  panel.edges.push_back({"side", {straight(Vec2(0, 0), Vec2(1, 2))}});
  pattern.scale_by(Vec2(2, 3));
  EXPECT_LT((pattern.panels[0].edges[0].curves[0].end() - Vec2(3, 4)).norm(), 1e-12);
  pattern.scale_by(Vec2(2, 2));
  EXPECT_LT((pattern.panels[0].edges[0].curves[0].end() - Vec2(6, 8)).norm(), 1e-12);
}

// The waist of the round body is at 1.1 m. A skirt hangs there, independently of the height of the neck.
TEST(Fit, TakesTheRatioOfTheWaistsForWhatHangsFromThem) {
  Wearer wearer = round_wearer();
  wearer.neck = 1.40;
  Pattern pattern;
  pattern.measures = {{}, 0.68, {}, {}, 1.75};
  const Fit high = fit(pattern, wearer, "cloth.c");
  wearer.neck = 1.46;
  const Fit low = fit(pattern, wearer, "cloth.c");
  EXPECT_NEAR(high.factors.y(), low.factors.y(), 0.011 / 1.1);  // sections are 10 mm apart
  EXPECT_NEAR(low.factors.y(), 1.1 / (0.63 * 1.75), 0.02);
  EXPECT_EQ(low.rise, 0);
}

// A specification of GarmentCode states all girths, also for skirts. The drawn waist is at 1.08 m, the neck at 1.43 m.
TEST(Fit, HangsWhatEndsAtTheWaistFromItWhateverMeasuresAreStated) {
  const Wearer wearer = round_wearer();
  const Measures own = measure(wearer);
  Pattern pattern;
  pattern.measures = {*own.chest / 2, *own.waist / 1.2, *own.hip / 1.1, {}, 1.72};
  Panel& panel = pattern.panels.emplace_back();
  panel.around = Around::torso;
  panel.position = Vec2(0, 0.5);
  panel.edges.push_back({"side", {straight(Vec2(0, 0), Vec2(0, 0.58))}});
  EXPECT_LT((fit(pattern, wearer, "cloth.c").factors - Vec2(1.2, 1.1 / (0.63 * 1.72))).norm(), 0.02);
  EXPECT_EQ(fit(pattern, wearer, "cloth.c").rise, 0);
  EXPECT_NE(warn_if_hips_do_not_hold(pattern, Vec2(2, 1), wearer), "");
  panel.position = Vec2(0, 0.84);  // now its top is at the shoulders
  EXPECT_LT((fit(pattern, wearer, "cloth.c").factors - Vec2(2, 1.46 / (0.83 * 1.72))).norm(), 1e-12);
  EXPECT_EQ(warn_if_hips_do_not_hold(pattern, Vec2(2, 1), wearer), "");
}

// The hip joints of the round body are at 0.9 m.
TEST(Fit, RefusesAWearerThatDoesNotStand) {
  Wearer wearer = round_wearer();
  wearer.neck = 0.85;
  Pattern pattern;
  pattern.measures.chest = 0.88;
  support::expect_error(ExitCode::scene_invalid,
                        "cloth.c.fit: expected a wearer that stands upright, got one with its neck 0.85 m and its hips "
                        "0.90 m",
                        [&] { fit(pattern, wearer, "cloth.c"); });
}

// Thighs of a wearer that sits are in the sections of its hips. Its chest can be measured all the same.
TEST(Fit, RefusesAWearerThatSitsIfItsHipsOrHeightsCount) {
  Wearer wearer = round_wearer();
  wearer.left_leg = Limb{Vec3(0.08, 0, 0.9), Vec3(0.08, -0.4, 0.8), Vec3(0.08, -0.4, 0.4)};
  Pattern pattern;
  pattern.measures.chest = 0.88;
  EXPECT_GT(fit(pattern, wearer, "cloth.c").factors.x(), 0);
  pattern.measures.height = 1.75;
  support::expect_error(ExitCode::scene_invalid, "cloth.c.fit: expected a wearer that stands, got one with a thigh",
                        [&] { fit(pattern, wearer, "cloth.c"); });
}

// Sections are 10 mm apart: a body of 1.7 km would have 170,000.
TEST(Fit, RefusesABodyInMillimetres) {
  Wearer wearer = round_wearer();
  for (Vec3& x : wearer.skin) x *= 1000;
  wearer.neck *= 1000;
  Pattern pattern;
  pattern.measures.chest = 0.88;
  support::expect_error(ExitCode::scene_invalid,
                        "cloth.c.fit: expected at most 100 m along torso of the wearer, got 1700 m; scale",
                        [&] { fit(pattern, wearer, "cloth.c"); });
}

// If hips are hardly wider than the waist of a garment, the garment slips to the feet, unless it hangs from the
// shoulders too.
TEST(Fit, TellsOfHipsThatHoldNothingUp) {
  const Wearer wearer = round_wearer();
  const double hip = *measure(wearer).hip;
  Pattern pattern;
  pattern.measures.waist = hip / 1.15;
  EXPECT_EQ(warn_if_hips_do_not_hold(pattern, Vec2(1, 1), wearer), "");
  EXPECT_EQ(warn_if_hips_do_not_hold(pattern, Vec2(1.1, 2), wearer).substr(0, 50),
            "its waist is 0.96 m around and the hips of its wea");
  pattern.measures.chest = 1;
  EXPECT_EQ(warn_if_hips_do_not_hold(pattern, Vec2(1.1, 2), wearer), "");
}

}  // namespace
}  // namespace weft::garment
