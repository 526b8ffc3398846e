// Tests of two bodies that leave cloth between them no clearance: the run continues, cloth stays separated from cloth,
// the pinch is reported, and nothing intersects after the bodies have separated.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <ostream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "physics/mesh/shapes.hpp"
#include "support/intersections.hpp"
#include "support/scene_runs.hpp"
#include "support/test_folder.hpp"

namespace weft::simulation {
namespace {

const std::string kHangingSheet = R"(
[time]
duration = 1.6
[[cloth]]
name = "sheet"
size = [0.4, 0.4]
particles = [21, 21]
position = [0, 0, 0.6]
rotation = [90, 0, 0]
pin = [{ low = [0, 1], high = [1, 1] }]
)";
// The left jaw closes and stays; further keys and the end of their list follow.
const std::string kLeftJaw = R"(
[[obstacle]]
name = "left"
shape = "box"
size = [0.2, 0.2, 0.2]
interpolation = "linear"
keys = [
  { time = 0.0, position = [0.02, -0.25, 0.55] },
  { time = 0.4, position = [0.02, -0.095, 0.55] },
  { time = 0.8, position = [0.02, -0.095, 0.55] },
)";
// The right jaw closes, stays and opens.
const std::string kRightJaw = R"(
[[obstacle]]
name = "right"
shape = "box"
size = [0.2, 0.2, 0.2]
interpolation = "linear"
keys = [
  { time = 0.0, position = [-0.02, 0.25, 0.53] },
  { time = 0.4, position = [-0.02, 0.095, 0.53] },
  { time = 0.8, position = [-0.02, 0.095, 0.53] },
  { time = 1.2, position = [-0.02, 0.25, 0.53] },
]
)";
// Two jaws close on a hanging sheet until they overlap by 10 mm, stay, and open.
const std::string kJaws =
    kHangingSheet + kLeftJaw + "  { time = 1.2, position = [0.02, -0.25, 0.55] },\n]\n" + kRightJaw;
// Only the right jaw opens again: the cloth inside the left jaw has to be pushed out.
const std::string kOneJawStays = kHangingSheet + kLeftJaw + "]\n" + kRightJaw;

// A stamp presses two sheets, one on the other, 5 mm into the floor, and rises.
constexpr const char* kStamp = R"(
[time]
duration = 1.6
[[cloth]]
name = "lower"
size = [0.4, 0.4]
particles = [17, 17]
position = [0, 0, 0.002]
[[cloth]]
name = "upper"
size = [0.36, 0.36]
particles = [17, 17]
position = [0.013, 0.007, 0.006]
rotation = [0, 0, 17]
[[obstacle]]
name = "floor"
shape = "plane"
[[obstacle]]
name = "stamp"
shape = "box"
size = [0.15, 0.15, 0.1]
interpolation = "linear"
keys = [
  { time = 0.2, position = [0.01, 0.02, 0.16] },
  { time = 0.5, position = [0.01, 0.02, 0.045] },
  { time = 0.8, position = [0.01, 0.02, 0.045] },
  { time = 1.2, position = [0.01, 0.02, 0.16] },
]
)";

// A narrow jaw turns while it closes: the sheet is rolled, and pinched between an edge of the jaw and a wall.
const std::string kTurningJaw = kHangingSheet + R"(
[[obstacle]]
name = "wall"
shape = "box"
size = [0.6, 0.1, 0.6]
position = [0, -0.06, 0.5]
[[obstacle]]
name = "jaw"
shape = "box"
size = [0.15, 0.2, 0.15]
interpolation = "linear"
keys = [
  { time = 0.0, position = [0, 0.25, 0.55] },
  { time = 0.4, position = [0, 0.085, 0.55], rotation = [40, 0, 15] },
  { time = 0.8, position = [0, 0.085, 0.50], rotation = [60, 0, 15] },
  { time = 1.2, position = [0, 0.25, 0.5], rotation = [0, 0, 0] },
]
)";

// A press 5 mm above a table closes on three layers of cloth at 0.2 s: by 15 mm in 20 ms (kSlidingKeys: overlap 10 mm,
// then it slides sideways) or by 35 mm in 8.75 ms (kFastKeys: overlap 30 mm). It opens after 1.2 s.
constexpr const char* kPress = R"(
[time]
duration = 2.6
[[cloth]]
name = "lower"
size = [0.3, 0.3]
particles = [16, 16]
position = [0, 0, 0.0012]
[[cloth]]
name = "middle"
size = [0.28, 0.28]
particles = [15, 15]
position = [0.013, 0.007, 0.0024]
rotation = [0, 0, 17]
[[cloth]]
name = "upper"
size = [0.26, 0.26]
particles = [14, 14]
position = [-0.01, 0.003, 0.0036]
rotation = [0, 0, 50]
[[obstacle]]
name = "table"
shape = "box"
size = [0.5, 0.5, 0.1]
position = [0, 0, -0.05]
[[obstacle]]
name = "press"
shape = "box"
size = [0.2, 0.2, 0.1]
interpolation = "linear"
)";
constexpr const char* kSlidingKeys = R"(
keys = [
  { time = 0.2, position = [0, 0, 0.055] },
  { time = 0.22, position = [0, 0, 0.04] },
  { time = 0.6, position = [0, 0, 0.04] },
  { time = 1.0, position = [0.05, 0, 0.04] },
  { time = 1.2, position = [0.05, 0, 0.04] },
  { time = 1.4, position = [0.05, 0, 0.155] },
]
)";
constexpr const char* kFastKeys = R"(
keys = [
  { time = 0.2, position = [0, 0, 0.055] },
  { time = 0.20875, position = [0, 0, 0.02] },
  { time = 1.2, position = [0, 0, 0.02] },
  { time = 1.4, position = [0, 0, 0.155] },
]
)";

/// The scene with a limit on stretch (max_stretch), near which the threads stiffen.
std::string locking(std::string scene) {
  const std::string_view before = "pin = ";
  return scene.insert(scene.find(before), "material = { max_stretch = 0.15 }\n");
}

struct Pinch {
  const char* name;
  std::string scene;
  double step;  // [s]
};

std::ostream& operator<<(std::ostream& out, const Pinch& pinch) {
  return out << pinch.name << " at steps of " << pinch.step << " s";
}

class PinchedCloth : public ::testing::TestWithParam<Pinch> {};

std::size_t pairs_of_cloths(const support::Intersections& intersections,
                            const std::vector<support::TestedObject>& objects) {
  return static_cast<std::size_t>(
      std::count_if(intersections.pairs.begin(), intersections.pairs.end(), [&](const support::IntersectingPair& pair) {
        return objects[pair.a.object].is_cloth && objects[pair.b.object].is_cloth;
      }));
}

TEST_P(PinchedCloth, StaysApartFromClothAndIsApartFromAllOnceThereIsRoom) {
  scene::Scene scene = support::scene_of_text(GetParam().scene);
  scene.time.step = GetParam().step;
  production::SceneSimulation simulation(scene);
  int pinched = 0, steps = 0;
  std::vector<std::string> pinches;
  // Long steps also cause warnings about stretch and about residual forces, which do not concern the pinch.
  const auto is_of_pinch = [](const std::string& text) {
    return text.find("max_stretch") == std::string::npos && text.find("solver.newton_tolerance") == std::string::npos;
  };
  for (int k = 1; k < scene.frame_count(); ++k) {
    const FrameReport report = simulation.advance();  // throws if the run fails
    steps += report.steps;
    const auto snapshot = simulation.snapshot();
    const auto objects = support::objects_of(*snapshot);
    const support::Intersections intersections = support::find_intersections(objects);
    EXPECT_EQ(pairs_of_cloths(intersections, objects), 0u) << "frame " << k;
    const bool is_end = k + 1 == scene.frame_count();
    if (report.pinched_pairs == 0 || is_end) {
      EXPECT_EQ(intersections.pairs.size(), 0u) << "frame " << k;
    }
    pinched += report.pinched_pairs > 0 ? 1 : 0;
    std::ranges::copy_if(report.warnings, std::back_inserter(pinches), is_of_pinch);
  }
  EXPECT_GT(pinched, 0);
  // If shorter steps find no clearance, later steps have full length again. Measured: 1.0 to 2.1 times as many steps as
  // without a pinch. Without this rule: 6 times, and with a limit on stretch 470 times.
  const double without = (scene.frame_count() - 1) * std::ceil(1 / scene.time.fps / scene.time.step - 1e-9);
  EXPECT_LT(steps, 3 * without);
  ASSERT_FALSE(pinches.empty());
  for (const std::string& text : pinches) {
    EXPECT_EQ(text.rfind("frame ", 0), 0u) << text;
    EXPECT_NE(text.find("has no room between '"), std::string::npos) << text;
  }
}

std::string name_of_pinch(const ::testing::TestParamInfo<Pinch>& pinch) {
  return std::string(pinch.param.name) + (pinch.param.step > 0.02 ? "_x4" : "_x1");
}

INSTANTIATE_TEST_SUITE_P(By, PinchedCloth,
                         ::testing::Values(Pinch{"jaws", kJaws, 0.01}, Pinch{"jaws", kJaws, 0.04},
                                           Pinch{"one_jaw_stays", kOneJawStays, 0.01}, Pinch{"stamp", kStamp, 0.01},
                                           Pinch{"turning_jaw", kTurningJaw, 0.01},
                                           Pinch{"turning_jaw", kTurningJaw, 0.04},
                                           Pinch{"locking", locking(kTurningJaw), 0.01}),
                         name_of_pinch);
INSTANTIATE_TEST_SUITE_P(SlowBy, PinchedCloth,
                         ::testing::Values(Pinch{"one_jaw_stays", kOneJawStays, 0.04}, Pinch{"stamp", kStamp, 0.04},
                                           Pinch{"locking", locking(kTurningJaw), 0.04},
                                           Pinch{"slide", std::string(kPress) + kSlidingKeys, 0.01},
                                           Pinch{"slide", std::string(kPress) + kSlidingKeys, 0.04},
                                           Pinch{"fast", std::string(kPress) + kFastKeys, 0.01},
                                           Pinch{"fast", std::string(kPress) + kFastKeys, 0.04}),
                         name_of_pinch);

/// A blade of 0.6 m below a falling sheet, with a key every quarter turn. `turn`: rotation [degrees], with {} for the
/// angle.
std::string turning_blade(double turns_a_second, const char* turn, const char* size, double height) {
  std::string keys;
  for (int quarter = 0; quarter <= std::ceil(4 * turns_a_second * 0.4); ++quarter)
    keys += fmt::format("  {{ time = {}, position = [0, 0, 0.5], rotation = {} }},\n", quarter / (4 * turns_a_second),
                        fmt::format(fmt::runtime(turn), 90 * quarter % 360));
  return fmt::format(
      "[time]\nduration = 0.4\n[[cloth]]\nname = 'sheet'\nsize = [1, 1]\nparticles = [15, 15]\n"
      "position = [0.03, 0.02, {}]\n[[obstacle]]\nname = 'blade'\nshape = 'box'\nsize = {}\n"
      "interpolation = 'linear'\nkeys = [\n{}]\n",
      height, size, keys);
}

struct Blade {
  const char* name;
  std::string scene;
  double step;  // [s]
};

std::ostream& operator<<(std::ostream& out, const Blade& blade) {
  return out << blade.name << " at steps of " << blade.step << " s";
}

class TurningBlade : public ::testing::TestWithParam<Blade> {};

// The blade is in free air: cloth that it catches is pressed from one side only.
TEST_P(TurningBlade, NeitherCutsNorPinches) {
  const scene::Scene scene = support::scene_of_text(GetParam().scene, {fmt::format("time.step={}", GetParam().step)});
  bool met = false;
  for (const support::MeasuredFrame& frame : support::run_scene(scene)) {
    EXPECT_EQ(frame.pairs, 0u) << "frame " << frame.report.frame;
    EXPECT_EQ(frame.report.pinched_pairs, 0) << "frame " << frame.report.frame;
    met |= frame.report.proximities > 0;
  }
  EXPECT_TRUE(met);
}

INSTANTIATE_TEST_SUITE_P(
    By, TurningBlade,
    ::testing::Values(Blade{"flat", turning_blade(8, "[0, 0, {}]", "[0.6, 0.05, 0.01]", 0.55), 0.01},
                      Blade{"flat_x4", turning_blade(8, "[0, 0, {}]", "[0.6, 0.05, 0.01]", 0.55), 0.04},
                      Blade{"upright", turning_blade(12, "[0, {}, 0]", "[0.6, 0.05, 0.01]", 0.86), 0.01},
                      Blade{"whole_turn_a_step", turning_blade(25, "[0, {}, 0]", "[0.6, 0.3, 0.01]", 0.86), 0.04}),
    [](const auto& blade) { return std::string(blade.param.name); });

/// OBJ file of two boxes of 0.2 m with a `gap` [m] between them along y.
std::string jaws_file(double gap) {
  std::string vertices, faces;
  for (int jaw = 0; jaw < 2; ++jaw) {
    const mesh::Mesh box = mesh::make_box(Vec3(0.2, 0.2, 0.2), 0, 2);
    const double y = (jaw == 0 ? -1 : 1) * (0.1 + 0.5 * gap);
    for (const Vec3& x : box.positions) vertices += fmt::format("v {} {} {}\n", x.x(), x.y() + y, x.z());
    const auto first = static_cast<Index>(jaw * static_cast<int>(box.positions.size()) + 1);
    for (const auto& [a, b, c] : box.topology.triangles)
      faces += fmt::format("f {} {} {}\n", a + first, b + first, c + first);
  }
  return vertices + faces;
}

class PinchBetweenParts : public support::TestFolder {
 protected:
  /// Warnings of a run in which a sheet hangs between jaws that close until their gap is `least_gap` [m], and open
  /// again.
  std::vector<std::string> reports(double least_gap, const std::string& more) {
    const std::array<double, 9> gaps{0.1, 0.1, 0.05, least_gap, least_gap, least_gap, 0.05, 0.1, 0.1};
    for (std::size_t k = 0; k < gaps.size(); ++k)
      support::write_bytes(folder_ / fmt::format("jaws_{}.obj", k), jaws_file(gaps[k]));
    const scene::Scene scene = support::scene_of_text(
        "[time]\nduration = 0.7\n[[character]]\nname = 'jaws'\nsource = 'sequence'\nfps = 10\nup = 'z'\n"
        "interpolation = 'linear'\nfiles = '" +
        (folder_ / "jaws_*.obj").string() +
        "'\n[[cloth]]\nname = 'sheet'\nsize = [0.3, 0.3]\nparticles = [13, 13]\nposition = [0.004, 0, 0.053]\n"
        "rotation = [90, 0, 0]\npin = [{ low = [0, 1], high = [1, 1] }]\n" +
        more);
    production::SceneSimulation simulation(scene);
    std::vector<std::string> pinches;
    for (int k = 1; k < scene.frame_count(); ++k) {
      const FrameReport report = simulation.advance();
      pinches.insert(pinches.end(), report.warnings.begin(), report.warnings.end());
    }
    return pinches;
  }
};

// The message must name neither the floor nor the board beside the jaws, because the other jaw is nearer.
TEST_F(PinchBetweenParts, IsSaidToBeBetweenPartsOfThatBody) {
  const auto pinches =
      reports(-0.01,
              "[[obstacle]]\nname = 'floor'\nshape = 'plane'\nposition = [0, 0, -0.2]\n"
              "[[obstacle]]\nname = 'board'\nshape = 'box'\nsize = [0.01, 1, 1]\nposition = [0.2, 0, 0]\n");
  ASSERT_FALSE(pinches.empty());
  for (const std::string& text : pinches)
    EXPECT_NE(text.find("'sheet' has no room between parts of 'jaws' near"), std::string::npos) << text;
}

/// OBJ file of a tall ellipsoid, the hip, and a flat one, the hand, which is not connected to it. `place` [m] and
/// `angle` [rad]: of the hand.
std::string hand_on_hip_file(const Vec3& place, double angle) {
  std::string vertices, faces;
  Index first = 1;
  const mesh::Mesh ball = mesh::make_sphere(1, 24);
  const auto add = [&](const Vec3& radii, const Vec3& middle, double turn) {
    for (const Vec3& p : ball.positions) {
      const Vec3 x = middle + Eigen::AngleAxisd(turn, Vec3::UnitZ()) * Vec3(p.cwiseProduct(radii));
      vertices += fmt::format("v {} {} {}\n", x.x(), x.y(), x.z());
    }
    for (const auto& [a, b, c] : ball.topology.triangles)
      faces += fmt::format("f {} {} {}\n", a + first, b + first, c + first);
    first += static_cast<Index>(ball.positions.size());
  };
  add({0.13, 0.13, 0.3}, {0, 0, 1}, 0);
  add({0.09, 0.02, 0.045}, place, angle);
  return vertices + faces;
}

/// A sheet in front of the hip, while the hand presses it 3 cm into the hip and leaves again.
class HandOnHip : public PinchBetweenParts {
 protected:
  struct Course {
    int most_pinched = 0;
    double largest_strain = 0;
    std::size_t pairs_at_end = 0;
  };

  /// `after`: place of the hand at the end [m]. On its way there the hand turns by `angle` [rad].
  Course run(const Vec3& after, double angle) {
    const Vec3 before(0.16, -0.3, 1), in(0.1, -0.105, 1);
    const std::vector<std::pair<Vec3, double>> keys{
        {before, 0},   {0.4 * before + 0.6 * in, 0},          {in, 0},
        {in, 0},       {0.6 * in + 0.4 * after, 0.4 * angle}, {after, angle},
        {after, angle}};
    for (std::size_t k = 0; k < keys.size(); ++k)
      support::write_bytes(folder_ / fmt::format("body_{}.obj", k), hand_on_hip_file(keys[k].first, keys[k].second));
    const scene::Scene scene = support::scene_of_text(
        "[time]\nduration = 1.2\n[[character]]\nname = 'body'\nsource = 'sequence'\nfps = 5\nup = 'z'\nfiles = '" +
        (folder_ / "body_*.obj").string() +
        "'\n[[cloth]]\nname = 'sheet'\nsize = [0.6, 0.5]\nparticles = [25, 21]\nposition = [0, -0.137, 0.95]\n"
        "rotation = [90, 0, 0]\npin = [{ low = [0, 1], high = [1, 1] }]\n");
    production::SceneSimulation simulation(scene);
    Course course;
    for (int k = 1; k < scene.frame_count(); ++k) {
      const FrameReport report = simulation.advance();
      course.most_pinched = std::max(course.most_pinched, report.pinched_pairs);
      course.largest_strain = std::max(course.largest_strain, report.max_strain);
    }
    const auto snapshot = simulation.snapshot();
    course.pairs_at_end = support::find_intersections(support::objects_of(*snapshot)).pairs.size();
    return course;
  }
};

// The hand leaves in another direction, turned by one radian. Pinched cloth is exempt from the hand only. If it were
// exempt from the whole body, it would stay in the hand (measured: 29 triangles).
TEST_F(HandOnHip, LeavesTheClothAsItCame) {
  const Course course = run({0.1, -0.35, 1.05}, -1);
  EXPECT_GT(course.most_pinched, 10);
  EXPECT_EQ(course.pairs_at_end, 0U);
}

// The hand leaves down along the cloth, or up past the held edge. Triangles that share a particle inside the hand must
// be exempt too; otherwise the hand would catch them. Measured: strain 0.08 to 0.10, and no intersecting pairs at the
// end; without the rule 0.37 and 49 pairs. If all triangles beside pinched ones were exempt, the strain would be 0.04,
// but cloth would stay inside bodies. Bound: 1.5 times the measured strain.
TEST_F(HandOnHip, ReleasesClothWhenItLeavesSideways) {
  for (const Vec3& after : {Vec3(0.1, -0.25, 0.8), Vec3(0.1, -0.3, 1.2)}) {
    const Course course = run(after, 0);
    EXPECT_GT(course.most_pinched, 10);
    EXPECT_LT(course.largest_strain, 0.15);
    EXPECT_EQ(course.pairs_at_end, 0U);
  }
}

}  // namespace
}  // namespace weft::simulation
