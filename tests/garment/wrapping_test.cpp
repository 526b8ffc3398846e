// Panels that start wrapped around limbs of a wearer.
#include "film/garment/wrapping.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "film/environment/environment.hpp"
#include "film/garment/garment.hpp"
#include "film/scene/loader.hpp"
#include "physics/mesh/shapes.hpp"
#include "support/intersections.hpp"
#include "support/test_folder.hpp"

namespace weft::garment {
namespace {

constexpr double kTrunk = 0.15, kArm = 0.05;  // radii [m]

// The trunk is an upright cylinder 1.8 m tall; the left arm is a horizontal cylinder that starts at (0.2, 0, 1.4).
Wearer stick_figure() {
  Wearer wearer;
  const auto add = [&](const mesh::Mesh& mesh, const Eigen::Isometry3d& placed, Region region) {
    const auto first = static_cast<Index>(wearer.skin.size());
    for (const Vec3& x : mesh.positions) wearer.skin.push_back(placed * x);
    for (const auto& t : mesh.topology.triangles)
      wearer.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    wearer.regions.resize(wearer.skin.size(), region);
  };
  Eigen::Isometry3d trunk = Eigen::Isometry3d::Identity(), arm = trunk;
  trunk.translation() = Vec3(0, 0, 0.9);
  add(mesh::make_cylinder(kTrunk, 1.8, 96), trunk, Region::trunk);
  arm.rotate(Eigen::AngleAxisd(0.5 * std::numbers::pi, Vec3::UnitY()));
  arm.translation() = Vec3(0.55, 0, 1.4);
  add(mesh::make_cylinder(kArm, 0.7, 96), arm, Region::left_arm);
  wearer.neck = 1.5;
  wearer.left_arm = Limb{Vec3(0.2, 0, 1.4), Vec3(0.5, 0, 1.4), Vec3(0.8, 0, 1.4)};
  return wearer;
}

// Relative errors: a polygon of 96 chords is shorter than its circle by 1.8e-4, and is up to 5.4e-4 inside of it.
constexpr double kChords = 1e-3;

TEST(Tubes, HaveTheGirthOfWhatTheyAreAround) {
  const Tube torso(stick_figure(), Around::torso), arm(stick_figure(), Around::left_arm);
  EXPECT_NEAR(torso.girth(1, 0), 2 * std::numbers::pi * kTrunk, kChords);
  EXPECT_NEAR(torso.girth(1, 0.02), 2 * std::numbers::pi * (kTrunk + 0.02), kChords);
  EXPECT_NEAR(torso.girth(3, 0), torso.girth(1.7, 0), kChords);  // the tube continues above the head
  EXPECT_NEAR(arm.girth(-0.3, 0.01), 2 * std::numbers::pi * (kArm + 0.01), kChords);
  // The tube around the body includes the arm, also at heights below it. Girths [m].
  EXPECT_GT(Tube(stick_figure(), Around::body).girth(1.4, 0), 2);
  EXPECT_GT(Tube(stick_figure(), Around::body).girth(0.5, 0), 2);
}

TEST(Tubes, HaveTheFrontAtTheAngle0AndTheLeftAt90) {
  const Tube torso(stick_figure(), Around::torso), arm(stick_figure(), Around::left_arm);
  const double quarter = 0.5 * std::numbers::pi;
  EXPECT_LT((torso.at(1, 0, 0, 0.02) - Vec3(0, -kTrunk - 0.02, 1)).norm(), kChords);
  EXPECT_LT((torso.at(1, quarter, 0, 0.02) - Vec3(kTrunk + 0.02, 0, 1)).norm(), kChords);
  EXPECT_LT((torso.at(1, 0, quarter * (kTrunk + 0.02), 0.02) - Vec3(kTrunk + 0.02, 0, 1)).norm(), kChords);
  EXPECT_LT((torso.at(1, 0, -quarter * kTrunk, 0) - Vec3(-kTrunk, 0, 1)).norm(), kChords);
  // The outside of a horizontal arm is its upper side.
  EXPECT_LT((arm.at(-0.3, quarter, 0, 0) - Vec3(0.5, 0, 1.4 + kArm)).norm(), kChords);
  EXPECT_LT((arm.along(-0.3) - Vec3(-1, 0, 0)).norm(), 1e-9);
}

// The ball is 3.4 m tall, twice as tall as a person. A triangle starts 12 cm deep in it; in a person, vertices deeper
// than 8 cm stay where they are.
TEST(Skins, PushOutWhatIsDeepInAGiant) {
  constexpr double kRadius = 1.7;
  const mesh::Mesh ball = mesh::make_sphere(kRadius, 128);
  Wearer giant;
  giant.skin = ball.positions;
  giant.triangles = ball.topology.triangles;
  giant.regions.assign(giant.skin.size(), Region::trunk);
  const double depth = 0.12, side = 0.05;
  std::vector<Vec3> x{Vec3(kRadius - depth, 0, 0), Vec3(kRadius - depth, side, 0), Vec3(kRadius - depth, 0, side)};
  const std::vector<mesh::Triangle> triangles{{0, 1, 2}};
  move_out_of_skin(giant, triangles, 0.01, x);
  for (const Vec3& each : x) EXPECT_GT(each.norm(), kRadius);
}

// A vest of two panels around the trunk, with a hole at the left, and a sleeve.
const std::string kVest = R"(
[[panel]]
name = "front"
around = "torso"
position = [0, 1]
path = "M -0.26 0 L 0.26 0 L 0.26 0.3 L 0.2 0.4 L 0.26 0.5 L -0.26 0.5 Z"
edges = "hem side hole hole top right"
[[panel]]
name = "back"
around = "torso"
side = "back"
position = [0, 1]
path = "M -0.26 0 L 0.26 0 L 0.26 0.3 L 0.2 0.4 L 0.26 0.5 L -0.26 0.5 Z"
edges = "hem side hole hole top right"
[[panel]]
name = "sleeve"
around = "left_arm"
path = "M -0.18 0 L 0.18 0 L 0.18 0.2 L 0 0.3 L -0.18 0.2 Z"
edges = "cuff under_back cap_back cap_front under_front"
[[seam]]
a = "front.side"
b = "back.side"
[[seam]]
a = "front.right"
b = "back.right"
[[seam]]
a = "sleeve.under_front"
b = "sleeve.under_back"
[[seam]]
a = "sleeve.cap_front"
b = "front.hole"
[[seam]]
a = "sleeve.cap_back"
b = "back.hole"
)";

// The vest with more keys of the seam on its right.
std::string vest_with(const std::string& keys) {
  const std::string seam = "[[seam]]\na = \"front.right\"\nb = \"back.right\"\n";
  return std::string(kVest).replace(kVest.find(seam), seam.size(), seam + keys);
}

class Wrapping : public support::TestFolder {
 protected:
  Pattern pattern_of(const std::string& text) {
    support::write_bytes(folder_ / "p.toml", text);
    return load_pattern(folder_ / "p.toml", "scene:1:1: cloth.c");
  }
  Garment sew_text(const std::string& text) {
    const Wearer wearer = stick_figure();
    return sew(pattern_of(text), 0.02, "scene:1:1: cloth.c", &wearer);
  }
};

TEST_F(Wrapping, ASleeveStartsAtItsHoleAroundTheArmWithItsFrontOutside) {
  const Garment garment = sew_text(kVest);
  const std::vector<Vec3>& x = garment.sheet.rest;
  double nearest = 1, farthest = 0;
  for (std::size_t t = 0; t < garment.sheet.triangles.size(); ++t) {
    const auto& corners = garment.sheet.triangles[t];
    const Vec3 normal = (x[corners[1]] - x[corners[0]]).cross(x[corners[2]] - x[corners[0]]);
    const Vec3 middle = (x[corners[0]] + x[corners[1]] + x[corners[2]]) / 3;
    const bool sleeve = garment.panel_of[t] == 2;
    Vec3 out = sleeve ? Vec3(0, middle.y(), middle.z() - 1.4) : Vec3(middle.x(), middle.y(), 0);
    EXPECT_GT(normal.dot(out), 0);
    if (sleeve && middle.x() > 0.32) nearest = std::min(nearest, out.norm()), farthest = std::max(farthest, out.norm());
  }
  // The sleeve has a girth of 0.36 m: a circle of 57 mm radius. Chords and bending change the radius by less than 15
  // mm.
  EXPECT_GT(nearest, kArm);
  EXPECT_LT(farthest, 0.072);
  // The middle of the cuff is above the arm, and 0.3 m from the cap, which is at the trunk.
  const std::vector<Index>& cuff = garment.edges.at("sleeve.cuff");
  EXPECT_GT(x[cuff[cuff.size() / 2]].z(), 1.4 + kArm);
  EXPECT_NEAR(x[cuff[cuff.size() / 2]].x(), kTrunk + 0.3, 0.06);
}

TEST_F(Wrapping, RingsWiderThanTheBodyStandOffIt) {
  std::string wide = kVest;
  for (std::size_t at; (at = wide.find("0.26")) != std::string::npos;) wide.replace(at, 4, "0.40");
  const Garment garment = sew_text(wide);
  const std::vector<Index>& hem = garment.edges.at("front.hem");
  const double radius = garment.sheet.rest[hem[hem.size() / 2]].head<2>().norm();
  EXPECT_NEAR(radius, 4 * 0.40 / (2 * std::numbers::pi), 0.01);
}

// A ring whose hem is wider than its top. Another ring, which lies below it and apart, must not change its start.
TEST_F(Wrapping, RingsThatLieApartHaveTheirOwnWidths) {
  const auto ring = [](const std::string& name, const std::string& position, const std::string& path) {
    std::string text;
    for (const std::string side : {"front", "back"})
      text += "[[panel]]\nname = '" + name + "_" + side + "'\naround = 'torso'\nside = '" + side +
              "'\nposition = " + position + "\npath = '" + path + "'\nedges = 'hem right top left'\n";
    for (const std::string edge : {"left", "right"})
      text += "[[seam]]\na = '" + name + "_front." + edge + "'\nb = '" + name + "_back." + edge + "'\n";
    return text;
  };
  const std::string high = ring("high", "[0, 0.8]", "M -0.40 0 L 0.40 0 L 0.27 0.5 L -0.27 0.5 Z");
  const std::string low = ring("low", "[0, 0.2]", "M -0.26 0 L 0.26 0 L 0.26 0.2 L -0.26 0.2 Z");
  const Garment alone = sew_text(high), both = sew_text(low + high);
  const std::vector<Index>&a = alone.edges.at("high_front.hem"), &b = both.edges.at("high_front.hem");
  EXPECT_LT((alone.sheet.rest[a[a.size() / 2]] - both.sheet.rest[b[b.size() / 2]]).norm(), 1e-6);
  EXPECT_GT(alone.sheet.rest[a[a.size() / 2]].head<2>().norm(), 0.23);
}

// Front and back form a ring wider than the body, 1 cm away from its middle.
TEST_F(Wrapping, SlitsStartOpen) {
  std::string text;
  for (const std::string side : {"front", "back"})
    text += "[[panel]]\nname = '" + side + "'\naround = 'torso'\nside = '" + side +
            "'\nposition = [0.005, 0.5]\npath = 'M -0.3 0 L 0.3 0 L 0.3 0.2 L 0.3 0.5 L -0.3 0.5 Z'\n"
            "edges = 'hem slit side top right'\n";
  for (const std::string edge : {"side", "right"})
    text += "[[seam]]\na = 'front." + edge + "'\nb = 'back." + edge + "'\n";
  const Garment garment = sew_text(text);
  const std::array<support::TestedObject, 1> object{
      support::TestedObject{.name = "skirt", .positions = garment.sheet.rest, .triangles = garment.sheet.triangles}};
  EXPECT_TRUE(support::find_intersections(object).pairs.empty());
}

// The ties of an apron have no position. They go on along the skin from its sides, which are 0.2 m from its middle.
TEST_F(Wrapping, TiesStartAtTheEdgesToWhichTheyAreSewn) {
  const Garment garment = sew_text(
      "[[panel]]\nname = 'apron'\naround = 'torso'\nposition = [0, 0.8]\n"
      "path = 'M -0.2 0 L 0.2 0 L 0.2 0.3 L 0.2 0.34 L 0.2 0.4 L -0.2 0.4 L -0.2 0.34 L -0.2 0.3 Z'\n"
      "edges = 'hem low_l tie_l high_l top high_r tie_r low_r'\n"
      "[[panel]]\nname = 'left'\naround = 'torso'\npath = 'M 0 0 L 0.25 0 L 0.25 0.04 L 0 0.04 Z'\n"
      "edges = 'lower free upper end'\n[[panel]]\nname = 'right'\nmirror_of = 'left'\n"
      "[[seam]]\na = 'apron.tie_l'\nb = 'left.end'\n[[seam]]\na = 'apron.tie_r'\nb = 'right.end'\n");
  const double radius = kTrunk + 0.015, angle = (0.2 + 0.25) / radius;
  for (const auto& [edge, side] : {std::pair("left.free", 1.0), {"right.free", -1.0}}) {
    const std::vector<Index>& free = garment.edges.at(edge);
    const Vec3& middle = garment.sheet.rest[free[free.size() / 2]];
    // Tolerance: the panels are bent along chords of 20 mm, and the tube has 96 sides.
    EXPECT_LT((middle - Vec3(side * radius * std::sin(angle), -radius * std::cos(angle), 1.12)).norm(), 5e-3) << edge;
  }
}

TEST_F(Wrapping, MirrorImagesHaveTheOtherSide) {
  const Pattern pattern = pattern_of(
      "[[panel]]\nname = 'a'\naround = 'left_leg'\nangle = 30\nposition = [0.1, 0.2]\ngrain = 20\n"
      "path = 'M 0 0 L 0.3 0 L 0 0.2 Z'\nedges = 'low slope high'\n"
      "[[panel]]\nname = 'b'\nmirror_of = 'a'\n");
  const Panel& b = pattern.panels[1];
  EXPECT_EQ(b.around, Around::right_leg);
  EXPECT_EQ(b.angle, -30);
  EXPECT_EQ(b.position, Vec2(-0.1, 0.2));
  EXPECT_EQ(b.grain, -20);
  const auto [panel, edge] = pattern.find("b.low");
  EXPECT_EQ(b.edges[edge].curves[0].start(), Vec2(-0.3, 0));
  EXPECT_EQ(panel, 1U);
}

TEST_F(Wrapping, MirrorImagesHaveTheKeysOfTheirOriginalThatAreNotGiven) {
  const std::string original =
      "[[panel]]\nname = 'a'\naround = 'left_leg'\nlayer = 2\ngrain = 20\nrotation = 30\nscale = 0.5\n"
      "fabric = { stretch = 2, bend = 8, density = 1.5 }\npath = 'M 0 0 L 0.3 0 L 0 0.2 Z'\n";
  const Pattern pattern = pattern_of(original +
                                     "[[panel]]\nname = 'b'\nmirror_of = 'a'\n"
                                     "[[panel]]\nname = 'c'\nmirror_of = 'a'\nlayer = 0\ngrain = 0\nrotation = 0\n"
                                     "scale = 1\nfabric = { bend = 1 }\n");
  const Panel &a = pattern.panels[0], &b = pattern.panels[1], &c = pattern.panels[2];
  EXPECT_EQ(b.layer, a.layer);
  EXPECT_EQ(b.rotation, -a.rotation);
  EXPECT_EQ(b.scale, a.scale);
  EXPECT_EQ(b.reinforcement, a.reinforcement);
  EXPECT_EQ(c.layer, 0);
  EXPECT_EQ(c.grain, 0);
  EXPECT_EQ(c.rotation, 0);
  EXPECT_EQ(c.scale, Vec2(1, 1));
  EXPECT_EQ(c.reinforcement, (mesh::Reinforcement{2, 1, 1.5}));
}

TEST_F(Wrapping, ClosuresAreTiesBetweenEdgesThatStayApart) {
  const Garment sewn = sew_text(kVest), closed = sew_text(vest_with("buttons = 3\nopen = 2\n"));
  EXPECT_EQ(closed.sheet.rest.size(), sewn.sheet.rest.size() + 26);  // one side is separate: 0.5 m in 20 mm
  ASSERT_EQ(closed.sheet.ties.size(), 3U);
  EXPECT_TRUE(sewn.sheet.ties.empty());
  for (const mesh::Tie& tie : closed.sheet.ties) {
    EXPECT_EQ(tie.open, 2);
    const Vec3 &a = closed.sheet.rest[tie.a], &b = closed.sheet.rest[tie.b];
    EXPECT_NEAR(a.z(), b.z(), 0.02);  // a tie joins places of the same height
    EXPECT_GT((a - b).norm(), 0.005);
  }
}

// A closure widens a ring by 3 cm, and thus its radius by 4.8 mm. A closure between trunk and sleeve belongs to neither
// ring, whichever of its edges is named first.
TEST_F(Wrapping, ClosuresBetweenTwoPartsWidenNoRing) {
  std::string from_sleeve = kVest, from_trunk = kVest;
  for (const std::string side : {"front", "back"}) {
    const std::string cap = "\"sleeve.cap_" + side + "\"\n", hole = "\"" + side + ".hole\"\n";
    const std::string seam = "a = " + cap + "b = " + hole;
    from_sleeve.replace(from_sleeve.find(seam), seam.size(), seam + "tearing_load = 300\n");
    from_trunk.replace(from_trunk.find(seam), seam.size(), "a = " + hole + "b = " + cap + "tearing_load = 300\n");
  }
  const Garment sleeve_first = sew_text(from_sleeve), trunk_first = sew_text(from_trunk);
  for (const std::string edge : {"front.hem", "sleeve.cuff"}) {
    const std::vector<Index>&a = sleeve_first.edges.at(edge), &b = trunk_first.edges.at(edge);
    EXPECT_LT((sleeve_first.sheet.rest[a[a.size() / 2]] - trunk_first.sheet.rest[b[b.size() / 2]]).norm(), 1e-3)
        << edge;
  }
}

TEST_F(Wrapping, SeamsThatTearAreTiesOfTheirLoadPerLength) {
  // If there are more buttons than particles, the existing ties share the load.
  for (const std::string keys : {"tearing_load = 300\n", "tearing_load = 300\nbuttons = 100\n"}) {
    const mesh::Sheet sheet = sew_text(vest_with(keys)).sheet;
    EXPECT_EQ(sheet.tearing_seams, std::vector<std::string>{"front.right + back.right"});
    double strength = 0;
    for (const mesh::Tie& tie : sheet.ties) {
      EXPECT_EQ(tie.tearing, 0);
      strength += tie.strength;
    }
    EXPECT_NEAR(strength, 300 * 0.5, 1e-9);
  }
}

TEST_F(Wrapping, AZipClosesFromEndToEnd) {
  const Garment garment = sew_text(vest_with("open = 2\n"));
  ASSERT_EQ(garment.closures.size(), 1U);
  const auto& pairs = garment.closures[0];
  ASSERT_EQ(pairs.size(), garment.sheet.ties.size());
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    EXPECT_EQ(pairs[k], (std::array{garment.sheet.ties[k].a, garment.sheet.ties[k].b}));
    EXPECT_EQ(pairs[k][0], garment.edges.at("front.right")[k]);
  }
  EXPECT_TRUE(sew_text(vest_with("buttons = 3\n")).closures.empty());
}

TEST_F(Wrapping, AStifferPanelIsStifferAlone) {
  std::string fused = kVest;
  fused.replace(fused.find("name = \"sleeve\""), 15, "name = \"sleeve\"\nfabric = { stretch = 3, bend = 8 }");
  EXPECT_TRUE(sew_text(kVest).sheet.reinforcements.empty());
  const Garment garment = sew_text(fused);
  for (std::size_t t = 0; t < garment.sheet.triangles.size(); ++t) {
    EXPECT_EQ(garment.sheet.reinforcements[t].stretch, garment.panel_of[t] == 2 ? 3 : 1);
    EXPECT_EQ(garment.sheet.reinforcements[t].density, 1);
  }
}

TEST_F(Wrapping, MistakesSayWhatWouldBeRight) {
  const auto expect = [&](const std::string& text, const std::string& words) {
    support::expect_error(ExitCode::scene_invalid, words, [&] { sew_text(text); });
  };
  const std::string panel = "[[panel]]\nname = 'a'\naround = 'left_arm'\npath = 'M 0 0 L 0.3 0 L 0 0.2 Z'\n";
  expect(panel, "panel a: expected a position, or a seam to a panel that has one, got neither");
  expect("[[panel]]\nname = 'a'\naround = 'arm'\n",
         "p.toml:3:10: panel.a.around: expected torso, body, neck, head, "
         "left_arm, right_arm, left_leg or right_leg, got \"arm\"");
  expect(panel + "[[seam]]\na = 'a.1'\nb = 'a.2'\ntearing_load = 300\nstrength = 2\n",
         "p.toml:9:12: seam.0.strength: expected either strength or tearing_load, got both");
  expect(panel + "side = 'back'\nangle = 90\n", "expected either side or angle, got both");
  expect(panel + "[[panel]]\nname = 'b'\nmirror_of = 'c'\n",
         "panel.b.mirror_of: expected a panel before it that has an outline, got \"c\"");
  expect(panel + "[[panel]]\nname = 'b'\nmirror_of = 'a'\nid = 'c'\n",
         "panel.b.mirror_of: expected an outline of its own or of another panel, got both");
  expect("[[panel]]\nname = 'a'\naround = 'left_leg'\nposition = [0, 0]\npath = 'M 0 0 L 0.3 0 L 0 0.2 Z'\n",
         "p.toml: panel a: expected a wearer with the joints UpperLeg, LowerLeg and Foot for panels around left_leg");
}

// Garments of the gallery. The seams determine on which side a hood lies; on the wrong side, 16 pairs of triangles
// would cross.
TEST(ShippedPatterns, StartOnTheMannequinWithoutIntersections) {
  for (const std::string name : {"jacket", "poncho"}) {
    const auto file = std::filesystem::path(WEFT_SOURCE_DIR) / "scenes/gallery" / (name + ".toml");
    const auto loaded = scene::load(file, {"time.preroll=0", "time.duration=0"});
    ASSERT_TRUE(loaded.ok()) << loaded.describe();
    const environment::Environment environment(loaded.scene);
    std::vector<support::TestedObject> objects;
    const model::Cloth& cloth = environment.model.cloths[0];
    const mesh::Mesh& body = environment.model.bodies.back().mesh;
    objects.push_back({"cloth", true, cloth.start, cloth.sheet.triangles});
    objects.push_back({"body", false, body.positions, body.topology.triangles});
    EXPECT_TRUE(support::find_intersections(objects).pairs.empty()) << name;
  }
}

}  // namespace
}  // namespace weft::garment
