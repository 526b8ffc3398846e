// Patterns that are sewn to one mesh around the wearer: topology, dimensions and start shape.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "film/garment/garment.hpp"
#include "support/intersections.hpp"
#include "support/test_folder.hpp"

namespace weft::garment {
namespace {

std::filesystem::path shipped(const std::string& name) {
  return std::string(WEFT_SOURCE_DIR) + "/scenes/patterns/" + name + ".toml";
}

Garment sewn(const std::string& name, double spacing) {
  return sew(load_pattern(shipped(name), "a test"), spacing, "a test");
}

long euler_characteristic(const mesh::Sheet& sheet) {
  return static_cast<long>(sheet.rest.size()) - static_cast<long>(mesh::collect_edges(sheet.triangles).edges.size()) +
         static_cast<long>(sheet.triangles.size());
}

double area_of_panels(const mesh::Sheet& sheet) {
  double area = 0;
  for (std::size_t t = 0; t < sheet.triangles.size(); ++t) area += mesh::rest_area(sheet, t);
  return area;
}

std::size_t intersecting_pairs(const mesh::Sheet& sheet) {
  const support::TestedObject object{"garment", true, sheet.rest, sheet.triangles};
  return support::find_intersections(std::span(&object, 1)).pairs.size();
}

// Counts openings: closed chains of border edges.
std::size_t openings(const mesh::Sheet& sheet) {
  const auto border = mesh::inspect(sheet.triangles, sheet.rest.size()).border;
  std::vector<Index> group(sheet.rest.size());
  for (std::size_t v = 0; v < group.size(); ++v) group[v] = static_cast<Index>(v);
  for (bool changed = true; changed;) {
    changed = false;
    for (const auto& [a, b] : border) {
      Index &p = group[a], &q = group[b];
      changed |= p != q;
      p = q = std::min(p, q);
    }
  }
  std::set<Index> rims;
  for (const auto& [a, b] : border) rims.insert(group[a]);
  return rims.size();
}

// Each garment has the expected number k of openings: a sphere with k holes has the Euler characteristic 2 − k.
TEST(Garments, AreSurfacesWithTheOpeningsOfWhatTheyAre) {
  for (double spacing : {0.03, 0.02}) {
    for (const auto& [name, count] : {std::pair("dress", 4L), {"tshirt", 4L}, {"skirt", 2L}}) {
      const Garment garment = sewn(name, spacing);
      EXPECT_TRUE(mesh::inspect(garment.sheet.triangles, garment.sheet.rest.size()).manifold()) << name;
      EXPECT_EQ(static_cast<long>(openings(garment.sheet)), count) << name;
      EXPECT_EQ(euler_characteristic(garment.sheet), 2 - count) << name;
    }
  }
}

TEST(Garments, KeepAreaAndMeasuresOfTheirPanels) {
  const Pattern pattern = load_pattern(shipped("skirt"), "a test");
  const Garment garment = sew(pattern, 0.01, "a test");
  const double area = area_of_panels(garment.sheet);
  for (std::size_t t = 0; t < garment.sheet.triangles.size(); ++t) EXPECT_GT(mesh::rest_area(garment.sheet, t), 0);
  // Expected: two quarter rings, 0.45 m wide. Tolerance: the middle of a chord of c = 10 mm is up to c² / (8 R) inside
  // its arc, so the ring is narrower at the hem and wider at the waist, by less than 1e-4. The curves deviate from
  // their arcs by at most 2.7e-4 of a radius.
  const double inner = 0.72 / std::numbers::pi, outer = inner + 0.45;
  EXPECT_NEAR(area, 0.5 * std::numbers::pi * (outer * outer - inner * inner), 3e-4 * area);
  ASSERT_EQ(garment.seams.size(), 2U);
  for (const SewnSeam& seam : garment.seams) {
    EXPECT_NEAR(seam.length_a, 0.45, 1e-4);
    EXPECT_NEAR(seam.length_b, 0.45, 1e-4);
    EXPECT_EQ(seam.vertices.size(), 46U);
  }
}

TEST(Garments, StartWithoutIntersectionsWithFrontsOutside) {
  for (const char* name : {"dress", "tshirt", "skirt"})
    for (double spacing : {0.04, 0.025, 0.0128}) {
      const Garment garment = sewn(name, spacing);
      const support::TestedObject object{name, true, garment.sheet.rest, garment.sheet.triangles};
      const support::Intersections intersections = support::find_intersections(std::span(&object, 1));
      EXPECT_TRUE(intersections.pairs.empty()) << name << " at " << spacing << ": " << intersections.pairs.size();
      EXPECT_TRUE(intersections.degenerate.empty()) << name;
      // Each triangle faces away from the plane y = 0, which separates front from back.
      std::size_t outside = 0;
      for (const mesh::Triangle& t : garment.sheet.triangles) {
        const auto x = [&](std::size_t k) -> const Vec3& { return garment.sheet.rest[t[k]]; };
        const Vec3 normal = (x(1) - x(0)).cross(x(2) - x(0));
        outside += normal.y() * (x(0) + x(1) + x(2)).y() > 0;
      }
      EXPECT_EQ(outside, garment.sheet.triangles.size()) << name;
    }
}

TEST(Garments, AreTheSameInEveryRun) {
  const Garment a = sewn("dress", 0.02), b = sewn("dress", 0.02);
  EXPECT_EQ(a.sheet.triangles, b.sheet.triangles);
  EXPECT_EQ(a.sheet.rest, b.sheet.rest);
}

// A hand-written pattern: a panel with a dart, and a long edge that is sewn to a shorter one (eased in).
const std::string kDart = R"(
[[panel]]
name = "front"
path = "M -0.2 0 L -0.02 0 L 0 0.15 L 0.02 0 L 0.2 0 L 0.2 0.3 L -0.2 0.3 Z"
edges = "low_l leg_l leg_r low_r right top left"
[[panel]]
name = "back"
side = "back"
path = "M -0.2 0 L 0.2 0 L 0.2 0.38 L -0.2 0.3 Z"
edges = "low right top left"
grain = 90
)";
const std::string kDartSeams = R"(
[[seam]]
a = "front.leg_l"
b = "front.leg_r"
[[seam]]
a = "front.left"
b = "back.left"
[[seam]]
a = "back.right"
b = "front.right"
)";

class SewingText : public support::TestFolder {
 protected:
  Garment sew_text(const std::string& text, double spacing = 0.02) {
    support::write_bytes(folder_ / "p.toml", text);
    return sew(load_pattern(folder_ / "p.toml", "scene:1:1: cloth.c"), spacing, "scene:1:1: cloth.c");
  }
  void expect_mistake(const std::string& text, const std::string& words) {
    support::expect_error(ExitCode::scene_invalid, words, [&] { sew_text(text); });
  }
};

TEST_F(SewingText, ADartClosesAndALongerSideIsEasedIn) {
  const Garment garment = sew_text(kDart + kDartSeams);
  EXPECT_EQ(euler_characteristic(garment.sheet), 0);  // a tube
  EXPECT_EQ(openings(garment.sheet), 2U);
  EXPECT_EQ(garment.seams[0].vertices.size(), 9U);  // 0.1513 / 0.02 = 7.6 segments, rounded
  EXPECT_NEAR(garment.seams[0].length_a, std::hypot(0.02, 0.15), 1e-9);
  EXPECT_NEAR(garment.seams[2].length_a, 0.38, 1e-9);
  EXPECT_NEAR(garment.seams[2].length_b, 0.30, 1e-9);
  EXPECT_EQ(garment.seams[2].vertices.size(), 18U);  // (0.38 + 0.30) / 2 / 0.02 = 17 segments
  EXPECT_NEAR(area_of_panels(garment.sheet), 0.4 * 0.3 - 0.02 * 0.15 + 0.4 * 0.34, 1e-12);
}

// The warp of the back runs across the panel.
TEST_F(SewingText, TheGrainTurnsTheWarp) {
  const Garment garment = sew_text(kDart + kDartSeams);
  for (std::size_t t = 0; t < garment.sheet.triangles.size(); ++t) {
    const auto& m = garment.sheet.material[t];
    const double high = std::max({m[0].y(), m[1].y(), m[2].y()}), low = std::min({m[0].y(), m[1].y(), m[2].y()});
    EXPECT_LE(high, garment.panel_of[t] == 0 ? 0.3 + 1e-12 : 0.2 + 1e-12);
    EXPECT_GE(low, garment.panel_of[t] == 0 ? -1e-12 : -0.2 - 1e-12);
  }
}

TEST_F(SewingText, BandsFollowTheirEdges) {
  const Garment garment =
      sew_text(kDart + kDartSeams + "[[elastic]]\nedge = 'front.top'\nratio = 0.8\n[[hem]]\nedge = 'back.low'\n");
  ASSERT_EQ(garment.sheet.bands.size(), 5U);  // the allowances of three seams, the elastic and the hem
  EXPECT_NEAR(garment.sheet.bands[2].lengths[0], 0.34 / 17, 1e-12);
  EXPECT_EQ(garment.sheet.bands[2].allowance, 0.02);
  const mesh::Band& band = garment.sheet.bands[3];
  EXPECT_EQ(band.vertices.size(), 21U);
  double length = 0;
  for (double l : band.lengths) length += l;
  EXPECT_NEAR(length, 0.4, 1e-12);
  EXPECT_EQ(band.ratio, 0.8);
  EXPECT_GT(garment.sheet.bands[4].mass, 0);
}

// Two rectangles, one on the other, sewn along three or all four sides: many users try this pattern first.
TEST_F(SewingText, APillowIsClosedAndAPillowcaseHasOneOpening) {
  const std::string path = "path = 'M -0.25 -0.2 L 0.25 -0.2 L 0.25 0.2 L -0.25 0.2 Z'\nedges = 'low right top left'\n";
  const std::string panels =
      "[[panel]]\nname = 'front'\nside = 'front'\n" + path + "[[panel]]\nname = 'back'\nside = 'back'\n" + path;
  std::string seams;
  for (const std::string side : {"low", "right", "top", "left"})
    seams += "[[seam]]\na = 'front." + side + "'\nb = 'back." + side + "'\n";
  const std::string three = seams.substr(0, seams.rfind("[[seam]]"));
  for (const double spacing : {0.05, 0.03, 0.02, 0.013}) {
    const Garment pillow = sew_text(panels + seams, spacing);
    EXPECT_TRUE(mesh::inspect(pillow.sheet.triangles, pillow.sheet.rest.size()).manifold()) << spacing;
    EXPECT_EQ(openings(pillow.sheet), 0U) << spacing;
    EXPECT_EQ(euler_characteristic(pillow.sheet), 2) << "a sphere, at " << spacing;
    EXPECT_NEAR(area_of_panels(pillow.sheet), 2 * 0.5 * 0.4, 1e-12) << spacing;
    for (std::size_t t = 0; t < pillow.sheet.triangles.size(); ++t)
      EXPECT_GT(mesh::rest_area(pillow.sheet, t), 0.02 * spacing * spacing) << "no needles, at " << spacing;
    EXPECT_EQ(intersecting_pairs(pillow.sheet), 0U) << spacing;
    const Garment open = sew_text(panels + three, spacing);
    EXPECT_EQ(openings(open.sheet), 1U) << spacing;
    EXPECT_EQ(euler_characteristic(open.sheet), 1) << "a disk, at " << spacing;
  }
  // Buttons of a cushion cover: none is at the ends of its opening, which are sewn.
  const mesh::Sheet cover = sew_text(panels + seams + "buttons = 3\n", 0.02).sheet;
  ASSERT_EQ(cover.ties.size(), 3U);
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_NEAR(std::abs(cover.rest[cover.ties[k].a].z()), k == 1 ? 0 : 0.1, 1e-3) << "quarters of 0.4 m";
  // A round pillow has one seam, along edges without ends. A zip there ties corresponding places of both edges.
  std::string round = panels + "[[seam]]\na = 'front.rim'\nb = 'back.rim'\n";
  for (std::size_t at = round.find(path); at != std::string::npos; at = round.find(path))
    round.replace(at, path.size(),
                  "path = 'M -0.2 0 A 0.2 0.2 0 0 1 0.2 0 A 0.2 0.2 0 0 1 -0.2 0 Z'\nedges = 'rim rim'\n");
  EXPECT_EQ(euler_characteristic(sew_text(round, 0.03).sheet), 2) << "a sphere";
  const mesh::Sheet zipped = sew_text(round + "open = 1\n", 0.03).sheet;
  EXPECT_GT(zipped.ties.size(), 30U);
  for (const mesh::Tie& tie : zipped.ties) {
    EXPECT_NEAR(zipped.rest[tie.a].x(), zipped.rest[tie.b].x(), 1e-6);
    EXPECT_NEAR(zipped.rest[tie.a].z(), zipped.rest[tie.b].z(), 1e-6);
  }
  // The edge has no end at which a second tie could be.
  std::set<Index> tied;
  for (const mesh::Tie& tie : zipped.ties) EXPECT_TRUE(tied.insert(tie.a).second) << tie.a;
  const mesh::Sheet buttoned = sew_text(round + "buttons = 2\n", 0.03).sheet;
  ASSERT_EQ(buttoned.ties.size(), 2U);
  EXPECT_GT((buttoned.rest[buttoned.ties[0].a] - buttoned.rest[buttoned.ties[1].a]).norm(), 0.35) << "opposite";
  std::string both_before = panels + seams;
  both_before.replace(both_before.find("'back'\n" + path), 6, "'front'");
  expect_mistake(both_before, "panels that lie one on the other need side = \"front\" and side = \"back\"");
}

// A wrap skirt: two fronts overlap. Each of them is sewn to one side of the back.
TEST_F(SewingText, LayersOfFlatPanelsStartApart) {
  const std::string seams =
      "[[seam]]\na = 'under.side'\nb = 'back.left'\n[[seam]]\na = 'over.side'\nb = 'back.right'\n";
  const std::string panels =
      "depth = 0.04\n[[panel]]\nname = 'back'\nside = 'back'\nedges = 'low right top left'\n"
      "path = 'M -0.26 0 L 0.26 0 L 0.2 0.5 L -0.2 0.5 Z'\n[[panel]]\nname = 'under'\nedges = 'low free top side'\n"
      "path = 'M -0.26 0 L 0.12 0 L 0.12 0.5 L -0.2 0.5 Z'\n[[panel]]\nname = 'over'\nmirror_of = 'under'\nlayer = 1\n";
  for (const double spacing : {0.03, 0.02}) {
    const Garment garment = sew_text(panels + seams, spacing);
    const std::vector<Vec3>& x = garment.sheet.rest;
    EXPECT_EQ(intersecting_pairs(garment.sheet), 0U) << spacing;
    for (const Index v : garment.edges.at("under.free")) EXPECT_NEAR(x[v].y(), -0.04, 1e-12);
    for (const Index v : garment.edges.at("over.free")) EXPECT_NEAR(x[v].y(), -0.05, 1e-12);
  }
}

// A seam that tears holds its load at each of its places, whether none, one or both of its ends are sewn to others.
TEST_F(SewingText, SeamsThatTearHoldTheirLoadBesideSewnEnds) {
  const double load = 300, length = 0.5;
  const std::string path = "path = 'M -0.25 -0.2 L 0.25 -0.2 L 0.25 0.2 L -0.25 0.2 Z'\nedges = 'low right top left'\n";
  const std::string seam = "[[seam]]\na = 'front.low'\nb = 'back.low'\ntearing_load = 300\n";
  for (const std::vector<std::string>& sewn : {std::vector<std::string>{"top"}, {"top", "left"}, {"left", "right"}}) {
    std::string text;
    for (const std::string side : {"front", "back"})
      text += "[[panel]]\nname = '" + side + "'\nside = '" + side + "'\n" + path;
    for (const std::string& side : sewn) text += "[[seam]]\na = 'front." + side + "'\nb = 'back." + side + "'\n";
    const double ends = static_cast<double>(sewn.size() - (sewn[0] == "top" ? 1 : 0));  // number of sewn ends
    for (const double spacing : {0.05, 0.02}) {
      const std::vector<mesh::Tie> zip = sew_text(text + seam, spacing).sheet.ties;
      const double segments = std::round(length / spacing);
      ASSERT_EQ(static_cast<double>(zip.size()), segments + 1 - ends) << ends;
      // Both sewn ends together hold the length of one tie.
      for (const mesh::Tie& tie : zip)
        EXPECT_NEAR(tie.strength, load * length / (segments + 1 - 0.5 * ends), 1e-9) << ends << " " << spacing;
    }
    const std::vector<mesh::Tie> button = sew_text(text + seam + "buttons = 1\n").sheet.ties;
    ASSERT_EQ(button.size(), 1U);
    EXPECT_NEAR(button[0].strength, load * length / (1 + 0.5 * ends), 1e-9) << ends;
  }
}

// In a sharp corner, triangles of both layers connect the same vertices, and no flip separates them.
TEST_F(SewingText, TwoLayersAreSewnAroundSharpCorners) {
  const auto sewn_layers = [&](const std::string& path, int seams, double spacing) {
    std::string text;
    for (const std::string side : {"front", "back"})
      text += fmt::format("[[panel]]\nname = '{0}'\nside = '{0}'\npath = '{1}'\n", side, path);
    for (int k = 1; k <= seams; ++k) text += fmt::format("[[seam]]\na = 'front.{0}'\nb = 'back.{0}'\n", k);
    return sew_text(text, spacing).sheet;
  };
  std::string star;
  for (int k = 0; k < 10; ++k) {
    const double angle = (0.5 + 0.2 * k) * std::numbers::pi, radius = k % 2 == 0 ? 0.3 : 0.115;
    star += fmt::format("{} {} {} ", k == 0 ? "M" : "L", radius * std::cos(angle), radius * std::sin(angle));
  }
  for (const double spacing : {0.03, 0.02}) {
    const mesh::Sheet cushion = sewn_layers(star + "Z", 10, spacing);
    EXPECT_EQ(euler_characteristic(cushion), 2) << "a sphere, at " << spacing;
    EXPECT_EQ(openings(cushion), 0U) << spacing;
    const mesh::Sheet pennant = sewn_layers("M 0 0 L 0.5 0.09 L 0 0.18 Z", 2, spacing);
    EXPECT_EQ(euler_characteristic(pennant), 1) << "a disk, at " << spacing;
    EXPECT_EQ(openings(pennant), 1U) << spacing;
    EXPECT_NEAR(area_of_panels(pennant), 0.5 * 0.18, 1e-12) << spacing;
  }
}

// The drawn half is that on the wearer's left. Its fold line is oblique, so that the reflection must do more than
// change the sign of x.
TEST_F(SewingText, AHalfCutOnTheFoldIsAWholePanel) {
  const auto panel = [&](const std::string& text) {
    support::write_bytes(folder_ / "p.toml", "[[panel]]\nname = 'p'\n" + text);
    return load_pattern(folder_ / "p.toml", "a test").panels.at(0);
  };
  const std::string half = "path = 'M 0 0 L 0.2 -0.15 C 0.3 0.1 0.3 0.3 0.4 0.35 L 0.3 0.4 Z'\n";
  const Panel whole = panel(half + "edges = 'hem side_l neck fold'\nfold = 'fold'\n");
  std::vector<std::string> names;
  double hem = 0;
  for (const PanelEdge& edge : whole.edges) {
    names.push_back(edge.name);
    if (edge.name == "hem") hem = Arclength(edge.curves).length();
  }
  std::ranges::sort(names);
  EXPECT_EQ(names, (std::vector<std::string>{"hem", "neck", "side_l", "side_r"}));
  EXPECT_NEAR(hem, 2 * std::hypot(0.2, 0.15), 1e-12) << "goes on beyond the fold";
  // The fold line passes through the origin along (3, 4) / 5: reflected points keep their distance from the origin.
  const auto end_of = [&](const std::string& name, bool end) {
    const std::vector<Curve>& curves = std::ranges::find(whole.edges, name, &PanelEdge::name)->curves;
    return end ? curves.back().end() : curves.front().start();
  };
  EXPECT_LT((end_of("side_l", false) - Vec2(0.2, -0.15)).norm(), 1e-12);
  EXPECT_LT((end_of("side_r", true) - Vec2(-0.2, 0.15)).norm(), 1e-12) << "at a right angle to the fold";
  const Vec2 shoulder(0.4, 0.35), along(0.6, 0.8);
  EXPECT_LT((end_of("side_r", false) - (2 * shoulder.dot(along) * along - shoulder)).norm(), 1e-12);
  expect_mistake("[[panel]]\nname = 'p'\n" + half + "edges = 'hem side_l neck fold'\nfold = 'side_l'\n",
                 "p.toml:5:8: panel.p.fold: expected a straight edge, got one that is 0.0");
  expect_mistake("[[panel]]\nname = 'p'\n" + half + "edges = 'hem side_l neck fold'\nfold = 'folt'\n",
                 "panel.p.fold: expected the name of an edge, got \"folt\"");
}

// Programs such as Valentina draw each curve as many straight pieces.
TEST_F(SewingText, DrawnCurvesOfManyPiecesHaveOneNameFromCornerToCorner) {
  std::string path = "M0,0 L300,0";  // a hem, a side, and an armhole of 20 pieces from (300, 400) to (0, 400)
  for (int k = 0; k <= 20; ++k)
    path += fmt::format(" L{},{}", 300 - 15 * k, 400 - 60 * std::sin(k * std::numbers::pi / 20));
  support::write_bytes(folder_ / "d.svg",
                       "<svg width='1000mm' viewBox='0 0 1000 1000'><path d='" + path + "Z'/></svg>");
  const std::string drawn = "[[panel]]\nname = 'p'\nfile = 'd.svg'\nid = 'path:1'\n";
  const auto names = [&](const std::string& more) {
    support::write_bytes(folder_ / "p.toml", drawn + more);
    const Pattern pattern = load_pattern(folder_ / "p.toml", "a test");
    std::vector<std::string> found;
    for (const PanelEdge& edge : pattern.panels.at(0).edges) found.push_back(edge.name);
    std::ranges::sort(found);
    return found;
  };
  EXPECT_EQ(names("edges = 'hem side_l armhole side_r'\n"),
            (std::vector<std::string>{"armhole", "hem", "side_l", "side_r"}));
  EXPECT_EQ(names("").size(), 23U);
  EXPECT_EQ(names("edges = 'a b c c c c c c c c c c c c c c c c c c c c d'\n"),
            (std::vector<std::string>{"a", "b", "c", "d"}));
  expect_mistake(drawn + "edges = 'hem side'\n",
                 "expected 23 names, one for each curve, or 4, one for each edge from corner to corner, got 2");
}

TEST_F(SewingText, MistakesAreAllNamedWithTheirPlaces) {
  expect_mistake(kDart + "[[seam]]\na = 'front.lft'\nb = 'back.left'\n",
                 "p.toml:13:5: seam.0.a: expected an edge such as "
                 "front.low_l, got \"front.lft\"; did you mean front.left?");
  expect_mistake(kDart + kDartSeams + "[[seam]]\na = 'front.left'\nb = 'back.top'\n", "in one seam");
  expect_mistake("depth = 0.1\n", "at least one [[panel]]");
  expect_mistake("[[panel]]\nname = 'a'\n", "panel.a: expected an outline");
  expect_mistake("[[panel]]\nname = 'a'\npath = 'M0 0L1 0L0 1Z'\nedges = 'x y'\n", "expected 3 names");
  expect_mistake("[[panel]]\nname = 'a'\npath = 'M0 0L1 0L0 1L 1 1Z'\n", "does not cross itself");
  // The arc is one edge, though it is read as two curves.
  expect_mistake("[[panel]]\nname = 'a'\npath = 'M0 0L1 0A.5 .5 0 0 1 1 1L.5 -.5Z'\n", "of the edges 1 and 3");
  expect_mistake("[[panel]]\nname = 'a'\npath = 'M0 0L1 0L1 1L0.5 1.2L0 1Z'\nedges = 'a b a b c'\n", "side by side");
  expect_mistake("[[panel]]\nname = 'a'\npath = 'M0 0 L 900 0 L 0 900 Z'\n", "at most 100 m");
  expect_mistake("[[panel]]\nname = 'a'\npth = 'M0 0'\n", "did you mean path?");
  expect_mistake("[[panel]\n", "not TOML");
}

TEST_F(SewingText, WhatCannotBeSewnIsRefused) {
  // Three panels meet at one edge.
  std::string three = kDart + kDartSeams;
  three += "[[panel]]\nname = 'third'\npath = 'M0 0L0.4 0L0.4 0.3L0 0.3Z'\n";
  three += "[[seam]]\na = 'third.2'\nb = 'third.3'\n[[seam]]\na = 'third.1'\nb = 'third.4'\n";
  EXPECT_ANY_THROW(sew_text(three));
  // A panel is upside down: its seams would join the front of the cloth to the back.
  std::string turned = kDart + kDartSeams;
  turned.replace(turned.find("grain = 90"), 10, "rotation = 180");
  expect_mistake(turned, "whose triangles face both ways");
  // A quarter of a ring, sewn along its straight sides: the sides can meet only if the rest of the panel folds over.
  // Eleven twelfths of a ring are accepted, since the gap closes like a dart.
  const std::string ring =
      "[[seam]]\na = 'hat.a'\nb = 'hat.b'\n[[panel]]\nname = 'hat'\nedges = 'a low b top'\npath = ";
  expect_mistake(ring + "'M 0.1 0 L 0.3 0 A 0.3 0.3 0 0 1 0 0.3 L 0 0.1 A 0.1 0.1 0 0 0 0.1 0 Z'\n",
                 "panel hat: expected a position, rotation and scale at which its seams close without folding it, "
                 "got a fold near (");
  const Garment hat =
      sew_text(ring + "'M 0.1 0 L 0.3 0 A 0.3 0.3 0 1 1 0.26 -0.15 L 0.0867 -0.05 A 0.1 0.1 0 1 0 0.1 0 Z'\n");
  EXPECT_EQ(euler_characteristic(hat.sheet), 0);
  support::expect_error(ExitCode::scene_invalid, "expected an edge_length of at least",
                        [&] { sew_text(kDart + kDartSeams, 1e-4); });
  // The area of round panels counts: 19.2 m² in two curves.
  support::expect_error(ExitCode::scene_invalid, "expected an edge_length of at least 0.0044 m", [&] {
    sew_text("[[panel]]\nname = 'round'\npath = 'M 0 0 C 0 4 4 4 4 0 C 4 -4 0 -4 0 0 Z'\n" + kDart + kDartSeams, 1e-4);
  });
}

}  // namespace
}  // namespace weft::garment
