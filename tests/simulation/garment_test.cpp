// Tests of sewn garments: seams stay closed, measures become those of the pattern, nothing intersects.
#include "film/garment/garment.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "film/environment/environment.hpp"
#include "film/production/scene_simulation.hpp"
#include "physics/simulation/cloth_system.hpp"
#include "simulation/scenes.hpp"
#include "support/scene_runs.hpp"
#include "support/small_character.hpp"
#include "support/test_folder.hpp"

namespace weft::simulation {
namespace {

// A skirt with an elastic band at the top.
const std::string kSkirt = testing::kTube + R"(
[[elastic]]
edge = "front.top"
ratio = 0.85
[[elastic]]
edge = "back.top"
ratio = 0.85
[[hem]]
edge = "front.hem"
)";

class Garments : public support::TestFolder {
 protected:
  scene::Scene dressed(const std::string& more) {
    support::write_bytes(folder_ / "tube.toml", kSkirt);
    return support::scene_of_text("[[cloth]]\nname = 'tube'\nshape = 'pattern'\nfile = '" +
                                  (folder_ / "tube.toml").string() +
                                  "'\nedge_length = 0.03\nsewing = 0.6\nposition = [0, 0, 0.1]\n" + more);
  }
};

const char* const kPost =
    "[time]\nduration = 1.6\n[[obstacle]]\nname = 'post'\nshape = 'cylinder'\nradius = 0.1\n"
    "height = 1.2\nposition = [0, 0, 0.4]\nsegments = 32\n";

struct Measures {
  double area = 0, area_pattern = 0;
  std::vector<double> seams, seams_pattern;
};

Measures measure(const garment::Garment& garment, const std::vector<Vec3>& x) {
  Measures m;
  const auto at = [&](Index i) -> const Vec3& { return x[i]; };
  for (std::size_t t = 0; t < garment.sheet.triangles.size(); ++t) {
    const auto& [a, b, c] = garment.sheet.triangles[t];
    m.area += 0.5 * (at(b) - at(a)).cross(at(c) - at(a)).norm();
    m.area_pattern += mesh::rest_area(garment.sheet, t);
  }
  for (const garment::SewnSeam& seam : garment.seams) {
    double length = 0;
    for (std::size_t k = 1; k < seam.vertices.size(); ++k)
      length += (at(seam.vertices[k]) - at(seam.vertices[k - 1])).norm();
    m.seams.push_back(length);
    m.seams_pattern.push_back(0.5 * (seam.length_a + seam.length_b));
  }
  return m;
}

// Requirements on a garment: once it is sewn, area and seams are within 1 % of the pattern; no frame has intersections.
TEST_F(Garments, ATubeSewnRoundAPostFitsAndNeverIntersects) {
  const scene::Scene scene = dressed(kPost);
  const auto frames = support::run_scene(scene, {.keep_positions = true});
  for (const auto& frame : frames)
    EXPECT_EQ(frame.pairs, 0U) << "frame " << frame.report.frame << ": " << frame.between;
  // At the start, threads have no tension, however much the cloth is stretched relative to the pattern.
  EXPECT_LT(frames[0].report.max_strain, 1e-12);
  EXPECT_LT(frames[0].report.elastic_energy, 0.03);  // of bending, because the pattern is flat [J]

  const garment::Garment garment =
      garment::sew(garment::load_pattern(scene.cloths[0].file, "a test"), scene.cloths[0].edge_length, "a test");
  const Measures start = measure(garment, frames.front().cloths[0]), end = measure(garment, frames.back().cloths[0]);
  EXPECT_GT(start.area, 1.2 * start.area_pattern);
  EXPECT_NEAR(end.area, end.area_pattern, 0.01 * end.area_pattern);
  for (std::size_t s = 0; s < end.seams.size(); ++s)
    EXPECT_NEAR(end.seams[s], end.seams_pattern[s], 0.01 * end.seams_pattern[s]);
  std::printf("area %.5f of %.5f m², seams %.5f and %.5f of %.5f m, largest strain %.4f\n", end.area, end.area_pattern,
              end.seams[0], end.seams[1], end.seams_pattern[0], frames.back().report.max_strain);
  // The elastic band holds the skirt up.
  double lowest = 1e9;
  for (const Vec3& x : frames.back().cloths[0]) lowest = std::min(lowest, x.z());
  EXPECT_GT(lowest, 0);
}

// The garment has no weight during sewing, and falls freely afterwards.
TEST_F(Garments, NothingFallsBeforeItIsSewn) {
  const scene::Scene scene = dressed("[time]\nduration = 1\n[physics]\nair_density = 0\n");
  const auto frames = support::run_scene(scene, {.counts_intersections = false, .keep_positions = true});
  const auto height = [&](std::size_t frame) {
    double sum = 0;
    for (const Vec3& x : frames[frame].cloths[0]) sum += x.z();
    return sum / static_cast<double>(frames[frame].cloths[0].size());
  };
  EXPECT_NEAR(height(15), height(0), 0.02);  // tolerance: the elastic band contracts the upper end
  const double fallen = 0.5 * 9.81 * 0.4 * 0.4;
  // Tolerance: implicit Euler is ahead by half a step of 10 ms, and the mean of the particles is not the centre of mass
  // while the shape changes.
  EXPECT_NEAR(height(15) - height(25), fallen, 0.1 * fallen);
}

// The front's top of 0.33 m has 12 particles at 30 mm; `low` and `high` can select a part of them.
TEST_F(Garments, ArePinnedByEdgesOfTheirPattern) {
  const scene::Scene scene = dressed("pin = [{ edge = 'front.top' }, { edge = 'back.hem', low = [0.5, 0] }]\n");
  const model::Model model = environment::Environment(scene).model;
  const model::Cloth& cloth = model.cloths[0];
  const auto& top = cloth.pins[0].particles;
  EXPECT_EQ(top.size(), 12U);
  for (const auto& [i, fraction, faded] : top) {
    EXPECT_EQ(fraction, 1);
    EXPECT_FALSE(faded);
    EXPECT_NEAR(cloth.start[i].z(), 0.4, 0.01);
    EXPECT_LT(cloth.start[i].y(), 1e-3) << "of the front";
  }
  const auto& hem = cloth.pins[1].particles;
  EXPECT_EQ(hem.size(), 6U);
  for (const auto& [i, fraction, faded] : hem) {
    EXPECT_NEAR(cloth.start[i].z(), 0.1, 0.01);
    EXPECT_GT(cloth.start[i].y(), -1e-3);
    EXPECT_GT(cloth.start[i].x(), 0);
  }
  const scene::Scene misspelt = dressed("pin = [{ edge = 'front.tip' }]\n");
  support::expect_error(
      ExitCode::scene_invalid,
      "pin.0.edge: expected an edge of its pattern, such as back.hem, got \"front.tip\"; did you mean "
      "front.top?",
      [&] { environment::Environment refused(misspelt); });
}

TEST_F(Garments, StandUprightWhicheverAxisIsUp) {
  const scene::Scene z_up = dressed("[time]\nduration = 0.2\n"), y_up = [&] {
    scene::Scene scene = z_up;
    scene.up = scene::UpAxis::y;
    return scene;
  }();
  const environment::Environment a(z_up), b(y_up);
  for (std::size_t i = 0; i < a.model.cloths[0].mesh.positions.size(); ++i) {
    const Vec3 p = a.model.cloths[0].mesh.positions[i] - z_up.cloths[0].pose.position,
               q = b.model.cloths[0].mesh.positions[i] - z_up.cloths[0].pose.position;
    EXPECT_LT((Vec3(p.x(), p.z(), -p.y()) - q).norm(), 1e-12);
  }
}

TEST_F(Garments, AStartThatTouchesTheWearerIsRefusedWithItsPlace) {
  const scene::Scene scene =
      dressed("[[obstacle]]\nname = 'post'\nshape = 'cylinder'\nradius = 0.16\nheight = 1.2\nposition = [0, 0, 0.4]\n");
  support::expect_error(ExitCode::scene_invalid, "'tube'", [&] { production::SceneSimulation simulation(scene); });
}

/// The message with which a start is refused; empty if it is accepted.
std::string refusal_of(const scene::Scene& scene) {
  try {
    production::SceneSimulation simulation(scene);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST_F(Garments, AStartThatMeetsACharacterTellsHowArmsAreHeldOff) {
  support::write_bytes(folder_ / "rod.x", support::rod_file());
  const auto refused = [&](const std::string& of_character, double height) {
    return refusal_of(support::scene_of_text(
        fmt::format("[[character]]\nname = 'rod'\nfile = '{}'\n{}[[cloth]]\nname = 'sheet'\nsize = 0.4\nparticles = 5\n"
                    "position = [0, 0, {}]\n[[obstacle]]\nname = 'box'\nshape = 'box'\nsize = [0.1, 0.1, "
                    "0.1]\nposition = [0, 0, 3]\n",
                    (folder_ / "rod.x").string(), of_character, height)));
  };
  const std::string hint = "stance_arms = 45 holds them off the body", dressed = "dressing = 0.5\nblend = 0.2\n";
  const std::string message = refused(dressed, 0.5);
  EXPECT_NE(message.find("'rod'"), std::string::npos) << message;
  EXPECT_NE(message.find(hint), std::string::npos) << message;
  // The message has no hint if nothing is dressed, or if the cloth touches another body.
  const std::string moving = refused("", 0.5), elsewhere = refused(dressed, 3);
  EXPECT_NE(moving.find("'rod'"), std::string::npos) << moving;
  EXPECT_EQ(moving.find(hint), std::string::npos) << moving;
  EXPECT_NE(elsewhere.find("'box'"), std::string::npos) << elsewhere;
  EXPECT_EQ(elsewhere.find(hint), std::string::npos) << elsewhere;
}

// While nothing moves, a frame is one step. But a frame during sewing takes all its steps, because rest lengths change.
TEST_F(Garments, TakeAllTheirStepsWhileTheyAreSewn) {
  production::SceneSimulation simulation(dressed("pin = [{ low = 0, high = 1 }]\n[time]\nfps = 25\nduration = 1\n"));
  int frame = 0;
  for (; frame < 15; ++frame) EXPECT_EQ(simulation.advance().steps, 4) << "frame " << frame + 1;
  for (; frame < 18; ++frame) EXPECT_EQ(simulation.advance().steps, 1) << "frame " << frame + 1;
}

// Something holds a cloth at the width of its start until the sewing has ended, and then releases it. While threads are
// locked, nothing changes, so a frame may be one step; while the cloth catches up, it may not.
TEST(SewnCloth, CatchesUpAfterTheSewingOnceItsThreadsAreReleased) {
  constexpr double kStep = 0.02, kSewing = 0.1;
  scene::Scene scene = testing::sheet_alone(0.2, 5, 0);
  scene.cloths[0].shape = scene::ClothShape::aligned_triangles;
  scene.cloths[0].material.max_stretch = 0.1;
  model::Model model = environment::Environment(scene).model;
  const std::vector<Vec3> released = model.cloths[0].start;
  model.cloths[0].sheet.sewn = true;
  model.cloths[0].sewing = kSewing;
  for (Vec3& x : model.cloths[0].sheet.rest) x *= 2;
  const std::vector<Vec3> held = model.cloths[0].sheet.rest;
  ClothSystem cloth(model);
  std::size_t widened = 0;
  for (int step = 1; step <= 6; ++step) {
    cloth.update_rest_shapes(step * kStep);
    cloth.finish_step(step * kStep);
    widened += cloth.accept(held, kStep).size();
  }
  EXPECT_EQ(widened, 1U);
  EXPECT_TRUE(cloth.is_constant_between(2 * kSewing, 3 * kSewing));
  EXPECT_TRUE(cloth.accept(released, kStep).empty());
  EXPECT_GT(cloth.max_strain(released), 0.3);
  int steps = 0;
  for (; !cloth.is_constant_between(2 * kSewing, 3 * kSewing) && steps < 10; ++steps)
    EXPECT_TRUE(cloth.accept(released, kStep).empty()) << "its widening is reported once";
  // Sewing stops in the second of five steps, so that two thirds of the way to the pattern are left.
  EXPECT_EQ(steps, 4);
  EXPECT_LT(cloth.max_strain(released), 1e-12);
}

}  // namespace
}  // namespace weft::simulation
