// Patterns of GarmentCode read as garments.
#include "film/garment/specification.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "film/environment/environment.hpp"
#include "film/garment/garment.hpp"
#include "support/scene_runs.hpp"
#include "support/test_folder.hpp"

namespace weft::garment {
namespace {

// A skirt, a trouser leg and a sleeve. As in GarmentCode, fronts are drawn counter-clockwise and backs clockwise. The
// sleeve lies along the x axis of its drawing, with its cap at the left.
const char* const kSpecification = R"({
  "pattern": {
    "panels": {
      "skirt_front": { "translation": [-30, 40, 25], "rotation": [0, 0, 0],
        "vertices": [[0, 0], [60, 0], [60, 50], [0, 50]],
        "edges": [
          { "endpoints": [0, 1], "curvature": { "type": "quadratic", "params": [[0.5, -0.1]] } },
          { "endpoints": [1, 2] },
          { "endpoints": [2, 3], "curvature": { "type": "circle", "params": [60, 0, 0] } },
          { "endpoints": [3, 0] } ] },
      "skirt_back": { "translation": [-30, 40, -20], "rotation": [0, 0, 0],
        "vertices": [[0, 0], [0, 50], [60, 50], [60, 0]],
        "edges": [
          { "endpoints": [0, 1] }, { "endpoints": [1, 2] }, { "endpoints": [2, 3] },
          { "endpoints": [3, 0], "curvature": { "type": "cubic", "params": [[0.3, 0.1], [0.7, 0.1]] } } ] },
      "left_sleeve_f": { "translation": [50, 110, 17], "rotation": [0, 0, -50], "label": "arm",
        "vertices": [[0, 0], [-30, 0], [-24, -20], [0, -20]],
        "edges": [ { "endpoints": [0, 1] }, { "endpoints": [1, 2] }, { "endpoints": [2, 3] },
          { "endpoints": [3, 0] } ] }
    },
    "stitches": [
      [ { "panel": "skirt_front", "edge": 1 }, { "panel": "skirt_back", "edge": 2 } ],
      [ { "panel": "skirt_front", "edge": 3 }, { "panel": "skirt_back", "edge": 0 } ],
      [ { "panel": "left_sleeve_f", "edge": 1 }, { "panel": "skirt_front", "edge": 2 } ]
    ]
  },
  "properties": { "curvature_coords": "relative", "units_in_meter": 100 }
})";

// Trousers: along the inside of a leg, the front is sewn to the back.
const char* const kLegs = R"({ "pattern": { "panels": {
  "a": { "translation": [0, 10, 20], "vertices": [[2, 0], [24, 0], [26, 80], [2, 80]],
    "edges": [ { "endpoints": [0, 1] }, { "endpoints": [1, 2] }, { "endpoints": [2, 3] }, { "endpoints": [3, 0] } ] },
  "b": { "translation": [0, 10, -20], "vertices": [[2, 0], [2, 80], [26, 80], [24, 0]],
    "edges": [ { "endpoints": [0, 1] }, { "endpoints": [1, 2] }, { "endpoints": [2, 3] }, { "endpoints": [3, 0] } ] } },
  "stitches": [
    [ { "panel": "a", "edge": 1 }, { "panel": "b", "edge": 2 } ],
    [ { "panel": "a", "edge": 3 }, { "panel": "b", "edge": 0 } ] ] } })";

double length_of(const Pattern& pattern, const std::string& edge) {
  const auto [p, e] = pattern.find(edge);
  return Arclength(pattern.panels[p].edges[e].curves).length();
}

class Specification : public support::TestFolder {
 protected:
  ReadPattern read(const std::string& text) {
    support::write_bytes(folder_ / "a_specification.json", text);
    return read_pattern(folder_ / "a_specification.json");
  }
  static std::string changed(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
  }
  // The trousers with other translations of front and back, which further keys may follow.
  static std::string legs_at(const std::string& front, const std::string& back) {
    return changed(changed(kLegs, "[0, 10, 20]", front), "[0, 10, -20]", back);
  }
};

TEST_F(Specification, HasOutlinesInMetresSeenFromOutside) {
  const ReadPattern read = this->read(kSpecification);
  ASSERT_TRUE(read.mistakes.empty()) << read.mistakes[0];
  const Pattern& pattern = read.pattern;
  ASSERT_EQ(pattern.panels.size(), 3U);  // sorted by name
  EXPECT_TRUE(pattern.has_bent_panels());
  EXPECT_NEAR(length_of(pattern, "skirt_front.1"), 0.5, 1e-12);
  // A parabola 30 mm deep, measured with 256 chords: s/w = ½√(1+q²) + asinh(q)/(2q), q = 4h/w.
  const double q = 4 * 0.03 / 0.6;
  EXPECT_NEAR(length_of(pattern, "skirt_front.0"), 0.3 * (std::sqrt(1 + q * q) + std::asinh(q) / q), 1e-6);
  // 60° of a circle of 0.6 m; cubic curves approximate arcs to 3e-4 of the radius.
  EXPECT_NEAR(length_of(pattern, "skirt_front.2"), 0.6 * std::numbers::pi / 3, 2e-4);
  // Without "right", the arc is clockwise: the top of the front, drawn from right to left, curves downward.
  const auto& top = pattern.panels[2].edges[pattern.find("skirt_front.2").second].curves[0];
  EXPECT_LT(top.at(0.5).y(), 0.5);
  for (const Seam& seam : pattern.seams) EXPECT_FALSE(seam.is_closure());
  EXPECT_EQ(pattern.seams[0].a, "skirt_front.1");
  EXPECT_EQ(pattern.seams[0].b, "skirt_back.2");
  // Seen from behind, the left of the back lies to the wearer's left.
  const Panel &back = pattern.panels[1], &front = pattern.panels[2];
  EXPECT_EQ(back.angle, 180);
  EXPECT_EQ(front.angle, 0);
  EXPECT_LT((*front.position - Vec2(-0.3, 0.4)).norm(), 1e-12);
  EXPECT_LT((*back.position - Vec2(0.3, 0.4)).norm(), 1e-12);
  double low = 0, high = 0;
  for (const PanelEdge& edge : back.edges)
    for (const Curve& curve : edge.curves)
      low = std::min(low, curve.start().x()), high = std::max(high, curve.start().x());
  EXPECT_NEAR(low, -0.6, 1e-12);
  EXPECT_NEAR(high, 0, 1e-12);
}

TEST_F(Specification, MayHaveAnEndingInCapitals) {
  support::write_bytes(folder_ / "A.JSON", kSpecification);
  const ReadPattern read = read_pattern(folder_ / "A.JSON");
  ASSERT_TRUE(read.mistakes.empty()) << read.mistakes[0];
  EXPECT_EQ(read.pattern.panels.size(), 3U);
}

TEST_F(Specification, LimbsLieAlongTheirAxesWithTheTrunkAbove) {
  const Pattern pattern = read(kSpecification).pattern;
  const Panel& sleeve = pattern.panels[0];
  EXPECT_EQ(sleeve.around, Around::left_arm);
  EXPECT_FALSE(sleeve.position);
  const auto [p, cuff] = pattern.find("left_sleeve_f.3");
  const Curve& wrist = sleeve.edges[cuff].curves[0];
  EXPECT_NEAR(wrist.start().y(), wrist.end().y(), 1e-12);
  EXPECT_NEAR(wrist.start().x() + wrist.end().x(), 0, 1e-12);
  const Curve& cap = sleeve.edges[pattern.find("left_sleeve_f.1").second].curves[0];
  EXPECT_GT(std::min(cap.start().y(), cap.end().y()), wrist.start().y() + 0.2);

  const Pattern legs = read(kLegs).pattern;
  EXPECT_EQ(legs.panels[0].around, Around::left_leg);
  EXPECT_EQ(legs.panels[1].around, Around::left_leg);
  EXPECT_LT((*legs.panels[0].position - Vec2(0, 0.1)).norm(), 1e-12);
  // In a skirt of two halves, such seams join one half to the other.
  const Pattern skirt = read(legs_at("[0, 10, 20]", "[-28, 10, -20]")).pattern;
  EXPECT_EQ(skirt.panels[0].around, Around::torso);
}

// The legs of the jumpsuit are drawn down to 0.1 m below the floor. Its bodice ends at 1.45 m, the height of shoulders.
TEST_F(Specification, JumpsuitsKeepTheirShouldersAndStartWithShorterLegs) {
  const std::string trousers = legs_at("[0, -10, 20]", "[0, -10, -20]");
  const ReadPattern read = this->read(changed(trousers, R"("a": {)", R"("bodice": { "translation": [-20, 70, 20],
    "vertices": [[0, 0], [40, 0], [40, 75], [0, 75]],
    "edges": [ { "endpoints": [0, 1] }, { "endpoints": [1, 2] }, { "endpoints": [2, 3] }, { "endpoints": [3, 0] } ] },
  "a": {)"));
  ASSERT_TRUE(read.mistakes.empty()) << read.mistakes[0];
  ASSERT_EQ(read.pattern.panels.size(), 3U);
  for (const Panel& panel : read.pattern.panels) {
    if (panel.name == "bodice") {
      EXPECT_NEAR(panel.position->y(), 0.7, 1e-12);
      EXPECT_EQ(panel.scale, Vec2(1, 1));
      continue;
    }
    // The outline extends from 0 to 0.8 m up.
    EXPECT_NEAR(panel.position->y(), 0.02, 1e-12) << panel.name;
    EXPECT_NEAR(panel.position->y() + panel.scale.y() * 0.8, 0.7, 1e-12) << panel.name;
    EXPECT_EQ(panel.scale.x(), 1) << panel.name;
  }
  // Trousers alone are raised.
  const Pattern raised = this->read(trousers).pattern;
  EXPECT_NEAR(raised.panels[0].position->y(), 0.02, 1e-12);
  EXPECT_EQ(raised.panels[0].scale, Vec2(1, 1));
}

// Files of the predecessor of GarmentCode have other units, lists for quadratic curves, and heights relative to a point
// of the body 1.12 m above the floor.
TEST_F(Specification, OfTheForerunnerStandsOnTheFloorToo) {
  std::string old = changed(kSpecification, R"({ "type": "quadratic", "params": [[0.5, -0.1]] })", "[0.5, -0.1]");
  old = changed(old, R"("units_in_meter": 100)", R"("units_in_meter": 200)");
  const ReadPattern read = this->read(old);
  ASSERT_TRUE(read.mistakes.empty()) << read.mistakes[0];
  EXPECT_NEAR(length_of(read.pattern, "skirt_front.1"), 0.25, 1e-12);
  EXPECT_NEAR(read.pattern.panels[2].position->y(), 0.2 + 1.12, 1e-12);
  EXPECT_EQ(read.pattern.measures.height, 1.66);
  EXPECT_EQ(this->read(kSpecification).pattern.measures.height, 1.72);
}

// Front and back of a garment of the predecessor, `low` cm wide at the lower end, `high` at the upper end, and `length`
// long. The lower end is `from` cm above the origin, which is 1.12 m above the floor.
std::string two_panels(double low, double high, double length, double from) {
  const auto panel = [&](const std::string& name, int depth, bool clockwise) {
    const std::string a = fmt::format("[{}, 0]", -low / 2), b = fmt::format("[{}, 0]", low / 2),
                      c = fmt::format("[{}, {}]", high / 2, length), d = fmt::format("[{}, {}]", -high / 2, length);
    return fmt::format(
        R"("{}": {{ "translation": [0, {}, {}], "vertices": [{}, {}, {}, {}], "edges": [ {{ "endpoints": [0, 1] }},
          {{ "endpoints": [1, 2] }}, {{ "endpoints": [2, 3] }}, {{ "endpoints": [3, 0] }} ] }})",
        name, from, depth, a, clockwise ? d : b, c, clockwise ? b : d);
  };
  return R"({ "pattern": { "panels": { )" + panel("front", 20, false) + ", " + panel("back", -20, true) +
         R"( }, "stitches": [ [ { "panel": "front", "edge": 1 }, { "panel": "back", "edge": 2 } ],
           [ { "panel": "front", "edge": 3 }, { "panel": "back", "edge": 0 } ] ] } })";
}

// Templates of the predecessor are narrower than the body that they are for: 0.98 m around the chest, 0.81 m around
// the waist and 1.04 m around the hips, whose widest section is at a height of 0.49 * 1.66 m.
TEST_F(Specification, OfTheForerunnerHasTheGirthsOfPanelsThatAreNarrowerThanItsBody) {
  const auto measures_of = [&](double low, double high, double length, double from) {
    const ReadPattern read = this->read(two_panels(low, high, length, from));
    EXPECT_TRUE(read.mistakes.empty()) << read.mistakes[0];
    return read.pattern.measures;
  };
  const Measures tee = measures_of(43, 43, 70, -32);
  EXPECT_NEAR(*tee.chest, 0.86, 1e-9);
  EXPECT_EQ(tee.waist, 0.81);
  EXPECT_NEAR(*tee.hip, 0.86, 1e-9);
  const Measures skirt = measures_of(70, 30, 60, -65);
  EXPECT_EQ(skirt.chest, 0.98);
  EXPECT_NEAR(*skirt.waist, 0.6, 1e-9);
  EXPECT_NEAR(*skirt.hip, 2 * (0.7 - 0.4 * (0.49 * 1.66 - 1.12 + 0.65) / 0.6), 1e-9);
  const Measures wide = measures_of(70, 60, 70, -32);
  EXPECT_EQ(wide.chest, 0.98);
  EXPECT_EQ(wide.hip, 1.04);
  // Panels that are far narrower do not surround the body.
  const Measures apron = measures_of(30, 15, 60, -65);
  EXPECT_EQ(apron.waist, 0.81);
  EXPECT_EQ(apron.hip, 1.04);
}

// The body of a specification may stand with its legs apart.
TEST_F(Specification, LegsApartAreWornAlongTheLegs) {
  const std::string turn = R"(, "rotation": [0, 0, 20])";
  const Pattern pattern = read(legs_at("[30, 10, 20]" + turn, "[30, 10, -20]" + turn)).pattern;
  for (const char* edge : {"a.0", "b.3"}) {
    const auto [p, e] = pattern.find(edge);
    EXPECT_EQ(pattern.panels[p].around, Around::left_leg);
    const Curve& hem = pattern.panels[p].edges[e].curves[0];
    EXPECT_NEAR(hem.start().y(), hem.end().y(), 1e-12);
  }
}

// Turned by 20 degrees, the rise of such a leg crosses the middle of the body by 6 mm.
TEST_F(Specification, LegsMayCrossTheMiddleALittle) {
  std::string crossing =
      changed(kLegs, "[[2, 0], [24, 0], [26, 80], [2, 80]]", "[[2, 0], [44, 0], [46, 80], [-0.6, 80]]");
  crossing = changed(crossing, "[[2, 0], [2, 80], [26, 80], [24, 0]]", "[[2, 0], [-0.6, 80], [46, 80], [44, 0]]");
  const Pattern pattern = read(crossing).pattern;
  EXPECT_EQ(pattern.panels[0].around, Around::left_leg);
  EXPECT_EQ(pattern.panels[1].around, Around::left_leg);
}

TEST_F(Specification, IsSewnAroundTheWearer) {
  support::write_bytes(folder_ / "a_specification.json", kSpecification);
  scene::Scene scene = support::scene_of_text(
      "[[character]]\nname = 'model'\nsource = 'mannequin'\nstance = 'rest'\nblend = 1\nedge_length = 0.05\n"
      "[[cloth]]\nname = 'skirt'\nshape = 'pattern'\nfile = '" +
      (folder_ / "a_specification.json").string() + "'\nedge_length = 0.04\n");
  const std::string cap = R"([ { "panel": "left_sleeve_f", "edge": 1 }, { "panel": "skirt_front", "edge": 2 } ])";
  const std::string closed = R"([ { "panel": "left_sleeve_f", "edge": 0 }, { "panel": "left_sleeve_f", "edge": 2 } ])";
  support::write_bytes(folder_ / "a_specification.json", changed(kSpecification, cap, closed));
  support::expect_error(ExitCode::scene_invalid,
                        "panel left_sleeve_f: expected a position, or a seam to a panel that has one",
                        [&] { environment::Environment made(scene); });

  std::string alone = changed(kSpecification, ",\n      " + cap, "");
  const std::size_t begin = alone.find(",\n      \"left_sleeve_f\""), end = alone.find("\n    },\n    \"stitches\"");
  alone.erase(begin, end - begin);
  support::write_bytes(folder_ / "a_specification.json", alone);
  const auto spans = [&] {
    const environment::Environment made(scene);
    Box3 box;
    for (const Vec3& x : made.model.cloths[0].start) box.extend(x);
    return box;
  };
  // The hem is 40 cm above the floor. Tolerance: it is curved by 3 cm, and sewing moves it a little more.
  const Box3 box = spans();
  EXPECT_NEAR(box.min().z(), 0.40, 0.05);
  EXPECT_NEAR(box.max().z(), 0.90, 0.05);
  EXPECT_LT(box.min().y(), -0.1);  // the skirt is in front of the body and behind it
  EXPECT_GT(box.max().y(), 0.1);
  scene.cloths[0].scale = 1.2;
  EXPECT_NEAR(spans().max().z(), 1.2 * box.max().z(), 0.03);
}

// A flap, 15 cm wide, is drawn lying on its side. A seam joins its right side to the wrong side of the front's top.
TEST_F(Specification, RightToWrongSideFoldsAPanelOver) {
  std::string folded = changed(kSpecification, R"("left_sleeve_f": {)", R"("flap": { "translation": [0, 150, 60],
        "vertices": [[0, 60], [0, 0], [15, 0], [15, 60]],
        "edges": [ { "endpoints": [0, 1] }, { "endpoints": [1, 2] }, { "endpoints": [2, 3] },
          { "endpoints": [3, 0] } ] },
      "left_sleeve_f": {)");
  folded = changed(folded, R"([ { "panel": "left_sleeve_f", "edge": 1 }, { "panel": "skirt_front", "edge": 2 } ])",
                   R"([ { "panel": "flap", "edge": 0 }, { "panel": "skirt_front", "edge": 2 }, "right_wrong" ])");
  folded = changed(folded, R"(, "curvature": { "type": "circle", "params": [60, 0, 0] })", "");
  const std::size_t sleeve = folded.find(",\n      \"left_sleeve_f\""), end = folded.find("\n    },\n    \"stitches\"");
  folded.erase(sleeve, end - sleeve);
  const ReadPattern read = this->read(folded);
  ASSERT_TRUE(read.mistakes.empty()) << read.mistakes[0];
  const Panel& flap = read.pattern.panels[0];
  ASSERT_EQ(flap.name, "flap");
  EXPECT_TRUE(flap.turned);
  EXPECT_EQ(flap.layer, 1);
  for (const std::size_t other : {1, 2}) EXPECT_FALSE(read.pattern.panels[other].turned);
  // The front's top is the line from (0.3, 0.9) to (-0.3, 0.9). The flap hangs down in front of the front.
  const std::vector<Vec2> corners{{0.3, 0.9}, {-0.3, 0.9}, {-0.3, 0.75}, {0.3, 0.75}};
  for (std::size_t e = 0; e < 4; ++e) {
    const Vec2 start = flap.edges[read.pattern.find("flap." + std::to_string(e)).second].curves[0].start();
    const Vec2 worn = *flap.position + Eigen::Rotation2Dd(flap.rotation * std::numbers::pi / 180) * start;
    EXPECT_LT((worn - corners[e]).norm(), 1e-9) << e;
  }
  // The flap is sewn to the front as one surface, lies in front of it, and shows its back there.
  const environment::Environment made(support::scene_of_text(
      "[[character]]\nname = 'model'\nsource = 'mannequin'\nstance = 'rest'\nblend = 1\nedge_length = 0.05\n"
      "[[cloth]]\nname = 'skirt'\nshape = 'pattern'\nfile = '" +
      (folder_ / "a_specification.json").string() + "'\nedge_length = 0.04\n"));
  const model::Cloth& cloth = made.model.cloths[0];
  const std::vector<mesh::Triangle>& triangles = cloth.mesh.topology.triangles;
  double flap_last = -1, front_first = 1;
  Vec3 flap_faces(0, 0, 0), front_faces(0, 0, 0);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    std::array<Vec3, 3> x;
    for (std::size_t k = 0; k < 3; ++k) x[k] = cloth.start[static_cast<std::size_t>(triangles[t][k])];
    const Vec3 middle = (x[0] + x[1] + x[2]) / 3;
    if (std::abs(middle.x()) > 0.1 || middle.z() < 0.77 || middle.z() > 0.85 || middle.y() > 0) continue;
    const std::string& panel = made.cloths[0].panels[static_cast<std::size_t>(made.cloths[0].panel_of[t])];
    (panel == "flap" ? flap_faces : front_faces) += (x[1] - x[0]).cross(x[2] - x[0]);
    if (panel == "flap")
      flap_last = std::max(flap_last, middle.y());
    else
      front_first = std::min(front_first, middle.y());
  }
  EXPECT_LT(flap_last, front_first);
  EXPECT_GT(flap_faces.y(), 0.5 * flap_faces.norm());
  EXPECT_LT(front_faces.y(), -0.5 * front_faces.norm());
}

// The outline has an edge of 2 mm, far shorter than the spacing of the mesh. Narrow triangles at such an edge would be
// very stiff.
TEST_F(Specification, EdgesShorterThanTheMeshBecomePoints) {
  const std::string with_corner = changed(
      changed(changed(kLegs, "[26, 80], [2, 80]]", "[26, 80], [2, 80], [2, 79.8]]"), R"({ "endpoints": [3, 0] } ] },
  "b")",
              R"({ "endpoints": [3, 4] }, { "endpoints": [4, 0] } ] },
  "b")"),
      R"("edge": 3 }, { "panel": "b")", R"("edge": 4 }, { "panel": "b")");
  const ReadPattern read = this->read(with_corner);
  ASSERT_TRUE(read.mistakes.empty()) << read.mistakes[0];
  const FlatMesh sharp = mesh_of(read.pattern.panels[0], {8, 26, 8, 0, 26}, 0.03);
  double shortest = 1;
  for (const mesh::Triangle& t : sharp.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      shortest = std::min(shortest, (sharp.points[static_cast<std::size_t>(t[k])] -
                                     sharp.points[static_cast<std::size_t>(t[(k + 1) % 3])])
                                        .norm());
  EXPECT_GT(shortest, 0.01);
}

TEST_F(Specification, MistakesNameWhatTheyAreAbout) {
  const auto first = [&](const std::string& text) {
    const ReadPattern read = this->read(text);
    const std::string line = read.mistakes.empty() ? "none" : read.mistakes[0];
    const std::size_t at = line.find(".json:");
    return at == std::string::npos ? line : line.substr(at + 6);
  };
  EXPECT_EQ(first("{\n\"pattern\": }"), "2:1: expected valid JSON, found an error near here");
  EXPECT_TRUE(first("{\"pattern\": 1e999}").starts_with("1:1: expected valid JSON: "));
  EXPECT_EQ(first(std::string(200'000, '[')),
            "1:1: expected valid JSON: expected at most 128 levels of lists and objects, got more");
  EXPECT_EQ(first("{}"), "1:1: expected \"pattern\" of a specification of GarmentCode, got none");
  EXPECT_EQ(first(R"({"pattern": {"panels": {}}})"), "1:1: pattern.panels: expected panels by name, got none");
  for (const char* units : {"0", "1e-320", "1e308", "-1", "\"cm\"", "null"})
    EXPECT_TRUE(first(changed(kSpecification, "\"units_in_meter\": 100", std::string("\"units_in_meter\": ") + units))
                    .starts_with("1:1: properties.units_in_meter: expected a number from 0.001 to 1e+06, got "))
        << units;
  // Tries values of the wrong type in every place. Exceptions of the JSON library must not reach the caller.
  for (const char* value : {"\"q\"", "7", "null", "{}", "[]", "[7]", "[[]]", "true"}) {
    const std::string text = std::string("{\"pattern\": {\"panels\": {\"a\": ") + value + "}, \"stitches\": []}}";
    EXPECT_NE(first(text), "none") << text;
    EXPECT_NE(first(std::string("{\"pattern\": ") + value + "}"), "none") << value;
    EXPECT_NE(first(value), "none");
    const std::string stitches =
        changed(kSpecification, "\"stitches\": [", std::string("\"stitches\": ") + value + ", \"x\": [");
    const bool is_list = value[0] == '[' && value[1] == ']';
    EXPECT_EQ(first(stitches) == "none", is_list) << value << ": " << first(stitches);
  }
  EXPECT_EQ(first(changed(kSpecification, "[60, 0]", "[60, \"0\"]")),
            "4:7: pattern.panels.skirt_front.vertices.1: expected 2 numbers below 100000, got [60,\"0\"]");
  EXPECT_EQ(first(changed(kSpecification, "\"endpoints\": [1, 2]", "\"endpoints\": [1, 7]")),
            "4:7: pattern.panels.skirt_front.edges.1.endpoints: expected numbers of vertices below 4, got 7");
  EXPECT_EQ(
      first(changed(kSpecification, "\"endpoints\": [1, 2]", "\"endpoints\": [2, 1]")),
      "4:7: pattern.panels.skirt_front.edges.1.endpoints: expected edges one after the other around the panel, got "
      "a gap before this");
  EXPECT_EQ(first(changed(kSpecification, "quadratic", "spline")),
            "4:7: pattern.panels.skirt_front.edges.0.curvature.type: expected quadratic, cubic or circle, got "
            "\"spline\"");
  EXPECT_EQ(
      first(changed(kSpecification, R"("skirt_back", "edge": 2 } ])", R"("skirt_back", "edge": 2 }, "right_wrong" ])")),
      "1:1: pattern.stitches.1: expected stitches that keep the same side of each panel outside, got a ring of "
      "stitches that "
      "turns it over");
  EXPECT_EQ(first(changed(kSpecification, R"("skirt_back", "edge": 2)", R"("skirt_back", "edge": 4)")),
            "1:1: pattern.stitches.0: expected an edge of a panel, got 4 of \"skirt_back\"");
  EXPECT_EQ(first(changed(kSpecification, R"("skirt_back", "edge": 2)", R"("skirt_back", "edge": 0)")),
            "1:1: pattern.stitches.1.b: expected each edge in one seam, got \"skirt_back.0\" again");
}

}  // namespace
}  // namespace weft::garment
