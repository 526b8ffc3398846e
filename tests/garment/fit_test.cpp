// A pattern that is drawn for one body, on another body: measurements, and the resulting scale.
#include "film/garment/fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "support/test_folder.hpp"

namespace weft::garment {
namespace {

// Radius [m] at the height z [m] of a rotationally symmetric body of 1.7 m. The table begins at the feet, and has
// knees, hips, waist, chest, shoulders, neck and the top of the head.
double radius(double z) {
  const std::vector<std::pair<double, double>> places{{0, 0.08},    {0.5, 0.09}, {0.9, 0.16}, {1.1, 0.11}, {1.28, 0.15},
                                                      {1.34, 0.15}, {1.42, 0.2}, {1.5, 0.06}, {1.7, 0.06}};
  for (std::size_t k = 1; k < places.size(); ++k)
    if (z <= places[k].first)
      return std::lerp(places[k - 1].second, places[k].second,
                       (z - places[k - 1].first) / (places[k].first - places[k - 1].first));
  return 0.06;
}

// Adds a tube of `rings` rings of `around` points each. `place`: of a point, from the number of its ring and its angle.
template <class Place>
void add_tube(Wearer& wearer, int rings, int around, Region region, const Place& place) {
  const auto first = static_cast<Index>(wearer.skin.size());
  for (int j = 0; j < rings; ++j)
    for (int i = 0; i < around; ++i) wearer.skin.push_back(place(j, 2 * std::numbers::pi * i / around));
  for (int j = 0; j + 1 < rings; ++j)
    for (int i = 0; i < around; ++i) {
      const Index a = first + j * around + i, b = first + j * around + (i + 1) % around;
      wearer.triangles.push_back({a, b, a + around});
      wearer.triangles.push_back({b, b + around, a + around});
    }
  wearer.regions.resize(wearer.skin.size(), region);
}

Wearer round_wearer() {
  Wearer wearer;
  add_tube(wearer, 171, 96, Region::trunk, [](int ring, double angle) {
    const double z = 0.01 * ring;
    return Vec3(radius(z) * std::cos(angle), radius(z) * std::sin(angle), z);
  });
  wearer.neck = 1.46;
  wearer.left_leg = Limb{Vec3(0.08, 0, 0.9), Vec3(0.08, 0, 0.5), Vec3(0.08, 0, 0.1)};
  wearer.right_leg = Limb{Vec3(-0.08, 0, 0.9), Vec3(-0.08, 0, 0.5), Vec3(-0.08, 0, 0.1)};
  return wearer;
}

// The shoulders are wider than the chest, and must not count as chest. Tolerances [m]: sections are 10 mm apart, so
// where the radius has a slope of 0.3, the girth has an error of up to 19 mm; a polygon of 96 corners is shorter than
// its circle by 0.02 %.
TEST(Fit, MeasuresGirthsOfHipsWaistAndChestAndTheHeight) {
  const Measures measures = measure(round_wearer());
  EXPECT_NEAR(*measures.hip, 2 * std::numbers::pi * 0.16, 0.02);
  EXPECT_NEAR(*measures.waist, 2 * std::numbers::pi * 0.11, 0.02);
  EXPECT_NEAR(*measures.chest, 2 * std::numbers::pi * 0.15, 0.03);
  EXPECT_NEAR(*measures.height, 1.7, 0.011);
}

// The distance of sections is a fraction of the body's height. If a body is scaled by a power of two, each measure is
// thus scaled by exactly this factor. The pattern is for a body of 1.75 m.
TEST(Fit, MeasuresDollsAndGiantsAsPreciselyAsPeople) {
  const Measures own = measure(round_wearer());
  for (const double factor : {0.25, 4.0}) {
    Wearer wearer = round_wearer();
    for (Vec3& x : wearer.skin) x *= factor;
    for (Limb* leg : {&*wearer.left_leg, &*wearer.right_leg})
      for (Vec3& joint : *leg) joint *= factor;
    wearer.neck *= factor;
    const Measures measures = measure(wearer);
    for (const auto girth : {&Measures::chest, &Measures::waist, &Measures::hip, &Measures::height})
      EXPECT_DOUBLE_EQ(*(measures.*girth), factor * *(own.*girth));
    Pattern pattern;
    pattern.measures = {0.88, {}, {}, {}, 1.75};
    EXPECT_EQ(fit(pattern, wearer, "cloth.c").gap, factor);
  }
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
  EXPECT_EQ(fit(pattern, wearer, "cloth.c").gap, 1);
  pattern.measures = {{}, {}, {}, {}, height};
  EXPECT_LT((fit(pattern, wearer, "cloth.c").factors - Vec2(1.2, 1.2)).norm(), 1e-12);
  pattern.measures = {};
  support::expect_error(ExitCode::scene_invalid, "cloth.c.fit: expected a pattern that names the measures",
                        [&] { fit(pattern, wearer, "cloth.c"); });
}

// Girth [m] of the arms, which are tubes. A figure with a short trunk has such thick arms.
constexpr double kThickArm = 0.3;
Wearer wearer_with_thick_arms() {
  constexpr double kLength = 0.6, kRadius = kThickArm / (2 * std::numbers::pi);
  constexpr int kAlong = 61;
  Wearer wearer = round_wearer();
  for (const double side : {1.0, -1.0}) {
    add_tube(wearer, kAlong, 64, side > 0 ? Region::left_arm : Region::right_arm, [&](int ring, double angle) {
      return Vec3(side * (0.2 + kLength * ring / (kAlong - 1)), kRadius * std::cos(angle),
                  1.4 + kRadius * std::sin(angle));
    });
    (side > 0 ? wearer.left_arm : wearer.right_arm) =
        Limb{Vec3(side * 0.2, 0, 1.4), Vec3(side * 0.45, 0, 1.4), Vec3(side * 0.7, 0, 1.4)};
  }
  return wearer;
}

TEST(Fit, GivesWayToThickArmsAndKeepsTheNeckInItsPlace) {
  const Wearer wearer = wearer_with_thick_arms();
  EXPECT_NEAR(*measure(wearer).arm, kThickArm, 1e-3 * kThickArm);  // tolerance: 64 chords are shorter by 0.04 %
  Pattern pattern;
  pattern.measures = {*measure(wearer).chest, {}, {}, *measure(wearer).arm / 1.5, 1.7};
  const Fit thick = fit(pattern, wearer, "cloth.c");
  EXPECT_LT((thick.factors - Vec2(1.5, 1.5)).norm(), 1e-12);
  EXPECT_EQ(thick.below_armholes, 1);  // the pattern has no armholes
  EXPECT_NEAR(kNeckHeightRatio * 1.7 * thick.factors.y() + thick.rise, wearer.neck, 1e-12);
  pattern.measures.arm = 1;
  EXPECT_NEAR(fit(pattern, wearer, "cloth.c").factors.x(), 1, 1e-12);
  EXPECT_NEAR(fit(pattern, wearer, "cloth.c").rise, 0, 1e-12);
}

Pattern shipped_pattern(const std::string& name) {
  return load_pattern(std::string(WEFT_SOURCE_DIR) + "/scenes/patterns/" + name + ".toml", "here");
}

double length_of_edge(const Pattern& pattern, const std::string& edge) {
  const auto [p, e] = pattern.find(edge);
  return Arclength(pattern.panels[p].edges[e].curves).length();
}

// The T-shirt has sleeves cut in one with the body; the shirt has sleeves of their own.
TEST(Fit, GivesThickArmsLongArmholesButNoLongBody) {
  const Wearer wearer = wearer_with_thick_arms();
  const Measures own = measure(wearer);
  for (const std::string name : {"tshirt", "shirt"}) {
    Pattern pattern = shipped_pattern(name);
    pattern.measures = {*own.chest, {}, {}, *own.arm / 1.5, 1.7};
    const Fit thick = fit(pattern, wearer, "cloth.c");
    EXPECT_NEAR(thick.factors.y(), 1.5, 1e-12) << name;
    EXPECT_NEAR(thick.factors.y() * thick.below_armholes, wearer.neck / (kNeckHeightRatio * 1.7), 1e-12) << name;
    pattern.measures.arm = 1;
    EXPECT_EQ(fit(pattern, wearer, "cloth.c").below_armholes, 1) << name;
  }
}

TEST(Fit, ShortensBothSidesOfASeamAlikeBelowTheArmholes) {
  const auto ratio = [](const Pattern& changed, const Pattern& drawn, const std::string& edge) {
    return length_of_edge(changed, edge) / length_of_edge(drawn, edge);
  };
  for (const std::string name : {"tshirt", "shirt"}) {
    const Pattern drawn = shipped_pattern(name);
    Pattern changed = drawn;
    shorten_below_armholes(changed, 0.5);
    for (std::size_t p = 0; p < drawn.panels.size(); ++p)
      EXPECT_EQ(changed.panels[p].position, drawn.panels[p].position) << name;
    for (const Seam& seam : drawn.seams)
      EXPECT_NEAR(length_of_edge(changed, seam.a) - length_of_edge(drawn, seam.a),
                  length_of_edge(changed, seam.b) - length_of_edge(drawn, seam.b), 1e-12)
          << name << ": " << seam.a;
    for (const std::string edge : {"front.side_l", "front.side_r", "back.side_l", "back.side_r"})
      EXPECT_NEAR(ratio(changed, drawn, edge), 0.5, 1e-12) << name << ": " << edge;
    for (const std::string edge : {"front.hem", "front.neck", "front.shoulder_l"})
      EXPECT_NEAR(ratio(changed, drawn, edge), 1, 1e-12) << name << ": " << edge;
  }
  const Pattern tshirt = shipped_pattern("tshirt"), shirt = shipped_pattern("shirt");
  Pattern short_tshirt = tshirt, short_shirt = shirt;
  shorten_below_armholes(short_tshirt, 0.5);
  shorten_below_armholes(short_shirt, 0.5);
  for (const std::string edge : {"front.under_r", "back.cuff_l", "back.sleeve_r"})
    EXPECT_NEAR(ratio(short_tshirt, tshirt, edge), 1, 1e-12) << edge;
  for (const std::string edge : {"front.armhole_l", "back.armhole_r", "sleeve_l.cap_front", "sleeve_r.cap_back"})
    EXPECT_NEAR(ratio(short_shirt, shirt, edge), 1, 1e-12) << edge;
  // The sleeve is 12 cm long below its cap, and 1.5 cm narrower at the cuff, on each side.
  EXPECT_NEAR(length_of_edge(short_shirt, "sleeve_l.under_front"), std::hypot(0.06, 0.015), 1e-12);
}

// A yoke, a sleeve and a skirt panel of a garment whose armhole starts 1.2 m above the floor: 0.2 m above the origin of
// the front. The skirt is drawn upside down.
TEST(Fit, ShortensPanelsWithoutAnArmholeByTheHeightAtWhichTheyStart) {
  const auto rectangle = [](const std::string& name, const Vec2& position) {
    Panel panel;
    panel.name = name;
    panel.around = Around::torso;
    panel.position = position;
    const Vec2 a(0, 0), b(0.4, 0), c(0.4, 0.5), d(0, 0.5);
    panel.edges = {
        {"low", {straight(a, b)}}, {"right", {straight(b, c)}}, {"top", {straight(c, d)}}, {"left", {straight(d, a)}}};
    return panel;
  };
  Pattern pattern;
  pattern.panels = {rectangle("front", Vec2(0, 1)), rectangle("sleeve", Vec2(0, 0)), rectangle("yoke", Vec2(0, 1.3)),
                    rectangle("skirt", Vec2(0, 0.9)), rectangle("collar", Vec2(0, 0))};
  std::vector<PanelEdge>& front = pattern.panels[0].edges;
  front[1].curves = {straight(Vec2(0.4, 0), Vec2(0.4, 0.2))};
  front.insert(front.begin() + 2, PanelEdge{"armhole", {straight(Vec2(0.4, 0.2), Vec2(0.4, 0.5))}});
  pattern.panels[1].around = Around::left_arm, pattern.panels[1].position.reset();
  pattern.panels[3].rotation = 180;
  pattern.panels[4].around = Around::neck, pattern.panels[4].position.reset();
  for (const auto& [a, b] : {std::pair{"front.armhole", "sleeve.top"}, {"front.top", "collar.low"}}) {
    Seam& seam = pattern.seams.emplace_back();
    seam.a = a, seam.b = b;
  }
  shorten_below_armholes(pattern, 0.5);
  EXPECT_NEAR(length_of_edge(pattern, "front.right"), 0.1, 1e-12);
  EXPECT_NEAR(length_of_edge(pattern, "front.armhole"), 0.3, 1e-12);
  EXPECT_NEAR(length_of_edge(pattern, "front.left"), 0.4, 1e-12);  // 0.2 m below the armhole become 0.1 m
  EXPECT_NEAR(length_of_edge(pattern, "sleeve.left"), 0.25, 1e-12);
  EXPECT_NEAR(length_of_edge(pattern, "yoke.left"), 0.5, 1e-12);
  EXPECT_NEAR(length_of_edge(pattern, "collar.left"), 0.5, 1e-12);
  // The skirt starts at heights from 0.4 to 0.9 m as drawn, and from 0.8 to 1.05 m when shortened.
  EXPECT_NEAR(length_of_edge(pattern, "skirt.left"), 0.25, 1e-12);
  const auto [p, low] = pattern.find("skirt.low");
  EXPECT_NEAR(pattern.panels[p].edges[low].curves[0].start().y(), -0.15, 1e-12);
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
  EXPECT_NEAR(high.factors.y(), low.factors.y(), 0.011 / 1.1);  // tolerance: sections are 10 mm apart
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
  panel.scale = Vec2(1, 1.6);  // the top of the panel starts at the shoulders
  EXPECT_EQ(warn_if_hips_do_not_hold(pattern, Vec2(2, 1), wearer), "");
  panel.scale = Vec2(1, 1);
  panel.position = Vec2(0, 0.84);  // its top starts at the shoulders again
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

// Nobody is 1.7 km tall: the file of the body is in another unit.
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
  // Nothing slides down a wearer that lies: one whose neck is below its hip joints.
  Wearer lying = wearer;
  lying.neck = 0.85;
  EXPECT_EQ(warn_if_hips_do_not_hold(pattern, Vec2(1.1, 2), lying), "");
  pattern.measures.chest = 1;
  EXPECT_EQ(warn_if_hips_do_not_hold(pattern, Vec2(1.1, 2), wearer), "");
}

}  // namespace
}  // namespace weft::garment
