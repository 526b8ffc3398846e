// Tests of attachments, which are springs between cloths or from cloth to bodies: forces, breaking, release.
#include "physics/simulation/attachments.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "film/production/scene_simulation.hpp"
#include "simulation/scenes.hpp"
#include "support/scene_runs.hpp"

namespace weft::simulation {
namespace {

using testing::lowest;

/// A towel of 0.03 kg that hangs from a rail by an attachment. `keys`: keys of the attachment; `more`: further tables.
scene::Scene towel(const std::string& keys, const std::string& more = "") {
  return support::scene_of_text(
      "[time]\nduration = 1\nstep = 0.01\n[physics]\nair_density = 0\n[contact]\nobstacles = false\nself = false\n"
      "[[cloth]]\nname = \"towel\"\nsize = [0.5, 0.3]\nparticles = [11, 7]\nposition = [0, 0, 0.8]\nrotation = [90, 0, "
      "0]\nmaterial = { density = 0.2, stretch_viscosity = 0.5 }\n"
      "[[obstacle]]\nname = \"rail\"\nshape = \"box\"\nsize = [1, 0.02, 0.02]\nposition = [0, 0, 0.98]\n"
      "[[attach]]\nname = \"peg\"\ncloth = \"towel\"\nto = \"rail\"\nlow = [0, 1]\nhigh = [1, 1]\n" +
      keys + more);
}

struct Hanging {
  std::vector<FrameReport> reports;
  std::vector<double> lowest;  // height of the lowest particle, per frame [m]
};
Hanging hang_up(const scene::Scene& scene) {
  production::SceneSimulation simulation(scene);
  Hanging result;
  for (int frame = 1; frame < scene.frame_count(); ++frame) {
    result.reports.push_back(simulation.advance());
    result.lowest.push_back(lowest(testing::sheet_of(simulation.snapshot())));
  }
  return result;
}

constexpr double kWeight = 0.2 * 0.15 * 9.81;  // of the towel [N]

TEST(Attachments, BearTheWeightThatHangsOnThem) {
  const Hanging hanging = hang_up(towel("stiffness = 500\n"));
  const simulation::AttachmentLoad& peg = hanging.reports.back().attachments.at(0);
  EXPECT_EQ(peg.name, "peg");
  EXPECT_TRUE(peg.holds);
  EXPECT_NEAR(peg.load / kWeight, 1, 0.01);
  // The 11 springs of 500 N/m extend by 0.05 mm; the cloth below them stretches, too.
  EXPECT_NEAR(hanging.lowest.back(), 0.65, 0.001);
}

// A plate of 0.5 m/s strikes a sheet that taut springs hold. BDF2 solves the jump of velocity at the impact separately.
// If that solution ignored the springs, particles would reach 1,181 m/s in one step (measured). The springs may throw
// the sheet back, with a speed of the order of the plate's.
TEST(Attachments, HoldWhatIsStruck) {
  production::SceneSimulation simulation(support::scene_of_text(
      "[time]\nduration = 0.2\nfps = 100\nstep = 0.01\nintegrator = \"bdf2\"\n[physics]\nair_density = 0\ngravity = "
      "[0, 0, 0]\n"
      "[[cloth]]\nname = \"sheet\"\nsize = [0.2, 0.2]\nparticles = [5, 5]\nposition = [0, 0, 0.1]\n"
      "[[obstacle]]\nname = \"base\"\nshape = \"box\"\nsize = [0.4, 0.4, 0.02]\nposition = [0, 0, -0.3]\n"
      "[[obstacle]]\nname = \"plate\"\nshape = \"box\"\nsize = [0.4, 0.4, 0.02]\ninterpolation = \"linear\"\n"
      "keys = [{ time = 0, position = [0, 0, 0.065] }, { time = 0.08, position = [0, 0, 0.105] }]\n"
      "[[attach]]\nname = \"springs\"\ncloth = \"sheet\"\nto = \"base\"\n"));
  double fastest = 0;
  for (int frame = 1; frame <= 12; ++frame) {
    simulation.advance();
    for (const Vec3& v : simulation.state().velocities) fastest = std::max(fastest, v.norm());
  }
  EXPECT_GT(fastest, 0.3);
  EXPECT_LT(fastest, 1);  // measured: 0.66
}

TEST(Attachments, BreakUnderTheLoadThatTheyBearAndHoldBelow) {
  const Hanging holding = hang_up(towel("breaking_load = 1.0\n"));
  EXPECT_TRUE(holding.reports.back().attachments.at(0).holds);
  const Hanging breaking = hang_up(towel("breaking_load = 0.15\n"));
  EXPECT_FALSE(breaking.reports.back().attachments.at(0).holds);
  EXPECT_EQ(breaking.reports.back().attachments.at(0).load, 0);
  EXPECT_LT(breaking.lowest.back(), 0.65 - 0.4 * 9.81);  // in one second, the towel falls by 4.9 m
}

TEST(Attachments, LetGoInTime) {
  const Hanging released = hang_up(towel("release = 0.6\n"));
  EXPECT_NEAR(released.lowest[14], 0.65, 0.002);
  EXPECT_TRUE(released.reports[13].attachments.at(0).holds);
  EXPECT_FALSE(released.reports[15].attachments.at(0).holds);
  EXPECT_NEAR(released.lowest.back(), 0.65 - 0.5 * 9.81 * 0.16, 0.05);  // after a fall of 0.4 s
}

TEST(Attachments, BeginWhereTheClothIsThen) {
  const Hanging begun = hang_up(towel("begin = 0.2\n"));
  EXPECT_FALSE(begun.reports[3].attachments.at(0).holds);
  EXPECT_TRUE(begun.reports[5].attachments.at(0).holds);
  const double fallen = 0.5 * 9.81 * 0.04;
  EXPECT_NEAR(*std::ranges::min_element(begun.lowest), 0.65 - fallen, 0.15);
  EXPECT_LT(begun.lowest.back(), 0.65 - 0.5 * fallen);
}

TEST(Attachments, DrawTheirEndsTogetherToALength) {
  scene::Scene scene = towel("length = 0\nstiffness = 500\n");
  scene.physics.gravity.setZero();
  scene.cloths[0].pose.position.z() = 0.75;  // the upper edge is 0.07 m below the rail
  production::SceneSimulation simulation(scene);
  for (int frame = 0; frame < 25; ++frame) simulation.advance();
  double highest = 0;
  for (const Vec3& x : testing::sheet_of(simulation.snapshot())) highest = std::max(highest, x.z());
  EXPECT_NEAR(highest, 0.97, 0.005);
}

TEST(Attachments, WarnOnceIfTheyPullFasterThanClothCanFollowWhateverTheStep) {
  const auto warnings = [](double gap, const std::string& keys, double step = 0.01) {
    scene::Scene scene = towel(keys);
    scene.time.step = step;
    scene.cloths[0].pose.position.z() = 0.97 - gap - 0.15;  // the upper edge starts `gap` below the rail [m]
    scene.physics.gravity.setZero();
    scene.time.duration = 0.16;
    std::string all;
    for (const FrameReport& report : hang_up(scene).reports)
      for (const std::string& text : report.warnings) all += text + "\n";
    return all;
  };
  EXPECT_EQ(warnings(0.1, "length = 0\nbegin = 0.1\n").find("attach.peg"), std::string::npos);
  const std::string far = warnings(0.5, "length = 0\nbegin = 0.1\n");
  EXPECT_NE(far.find("frame 3: attach.peg: pulls cloth to its target at 50 m/s when it is tied"), std::string::npos)
      << far;
  EXPECT_EQ(far.find("attach.peg"), far.rfind("attach.peg")) << far;
  const std::string in_short_steps = warnings(0.5, "length = 0\nbegin = 0.1\n", 0.002);
  EXPECT_NE(in_short_steps.find("at 250 m/s"), std::string::npos) << in_short_steps;
  // A soft spring pulls slowly enough, at up to 0.5 m · √(0.1 N/m / 0.25 g) = 10 m/s.
  EXPECT_EQ(warnings(0.5, "length = 0\nbegin = 0.1\nstiffness = 0.1\n").find("attach.peg"), std::string::npos);
}

TEST(Attachments, FollowTheirBody) {
  production::SceneSimulation simulation(
      towel("release = 0\n",
            "[[obstacle]]\nname = \"lift\"\nshape = \"sphere\"\nradius = 0.02\ninterpolation = \"linear\"\nkeys = [{ "
            "time = 0, position = [0, 0, 1] }, { time = 0.5, position = [0, 0, 1.2] }]\n[[attach]]\nname = "
            "\"hook\"\ncloth = \"towel\"\nto = \"lift\"\nlow = [0.5, 1]\nhigh = [0.5, 1]\n"));
  for (int frame = 0; frame < 25; ++frame) simulation.advance();
  double highest = 0;
  for (const Vec3& x : testing::sheet_of(simulation.snapshot())) highest = std::max(highest, x.z());
  EXPECT_NEAR(highest, 0.95 + 0.2, 0.01);
}

// The program does not measure the work of the lifting body. As there is no contact either, the energy check must infer
// the supply of energy from the motion of the body.
TEST(Attachments, ToABodyThatLiftsAreNoEnergyWithoutASource) {
  production::SceneSimulation simulation(towel(
      "release = 0\n",
      "[[obstacle]]\nname = \"lift\"\nshape = \"sphere\"\nradius = 0.02\ncollide = false\nkeys = [{ time = 0, position "
      "= [0, 0, 1] }, { time = 0.5, position = [0, 0, 3] }]\n[[attach]]\nname = \"hook\"\ncloth = \"towel\"\nto = "
      "\"lift\"\nlow = [0, 1]\nhigh = [1, 1]\n"));
  for (int frame = 0; frame < 15; ++frame) EXPECT_TRUE(simulation.advance().warnings.empty()) << frame;
}

TEST(Attachments, StoreEnergyThatIsReported) {
  scene::Scene scene = towel("length = 0\nstiffness = 1\n");
  scene.cloths[0].pose.position.z() = 0.75;  // the upper edge is 0.07 m below the rail
  scene.cloths[0].velocity = Vec3(0, 0, -1);
  production::SceneSimulation simulation(scene);
  // Eleven springs of 1 N/m, of which the first and the last count half, have a stiffness of 10 N/m. After a frame of
  // 0.04 s, they are 0.09 to 0.11 m long.
  const double energy = simulation.advance().elastic_energy;
  EXPECT_GT(energy, 10 * 0.5 * 0.09 * 0.09);
  EXPECT_LT(energy, 10 * 0.5 * 0.11 * 0.11);
}

// An attachment that breaks in the last step of a frame: the 0.01 J that its springs have stored are lost.
TEST(Attachments, StoreNoEnergyOnceTheyAreBroken) {
  scene::Scene scene = towel("length = 0\nstiffness = 1\nbreaking_load = 0.1\n");
  scene.time.step = 0.04;  // one step a frame
  scene.physics.gravity.setZero();
  scene.cloths[0].pose.position.z() = 0.75;  // 0.07 m below the rail
  production::SceneSimulation simulation(scene);
  const FrameReport report = simulation.advance();
  EXPECT_GT(report.attachments.at(0).load, 0.1);
  EXPECT_FALSE(report.attachments.at(0).holds);
  EXPECT_LT(report.elastic_energy, 0.005);  // that of the cloth alone
}

// Two sheets, one above the other, buttoned at a corner; the upper one moves.
constexpr const char* kButton =
    "[time]\nduration = 1\n[physics]\ngravity = [0, 0, 0]\nair_density = 0\n[contact]\nself = false\n"
    "[[cloth]]\nname = \"lower\"\nsize = 0.2\nparticles = 6\n"
    "[[cloth]]\nname = \"upper\"\nsize = 0.2\nparticles = 6\nposition = [0.03, 0.02, 0.01]\nvelocity = [0.2, 0.1, "
    "0.3]\n"
    "[[attach]]\nname = \"button\"\ncloth = \"upper\"\nto = \"lower\"\nlow = [0, 0]\nhigh = [0, 0]\nstiffness = 2000\n";

TEST(Attachments, BetweenClothsKeepTheirMomentumAndTheirDistance) {
  production::SceneSimulation simulation(support::scene_of_text(kButton));
  const auto momentum = [&] {
    const ParticleState state = simulation.state();
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 0; i < state.masses.size(); ++i) sum += state.masses[i] * state.velocities[i];
    return sum;
  };
  const Vec3 start = momentum();
  double farthest = 0;
  for (int frame = 0; frame < 25; ++frame) {
    simulation.advance();
    // The place to which the corner is tied: at fractions 0.75 and 0.5 of the first cell of the lower sheet.
    const auto& lower = simulation.snapshot()->states[0].positions;
    const Vec3 place = 0.25 * lower[0] + 0.25 * lower[1] + 0.5 * lower[7];
    farthest = std::max(farthest, (simulation.snapshot()->states[1].positions[0] - place).norm());
  }
  EXPECT_LT((momentum() - start).norm(), 1e-12 * start.norm());
  EXPECT_LT(farthest, 0.0115);  // 0.01 m plus the extension by the impact of 0.006 kg at 0.4 m/s
  EXPECT_LT((simulation.state().velocities[0]).norm(), 1.0);
  EXPECT_GT((simulation.state().velocities[0]).norm(), 0.01);  // the upper sheet pulls the lower one along
}

TEST(Attachments, HaveForcesThatAreDerivativesOfTheirEnergyAndTermsThatAreOfTheirForces) {
  const scene::Scene scene = support::scene_of_text(kButton);
  const model::Model model = environment::Environment(scene).model;
  const std::vector<Index> first{0, 36};
  Attachments attachments(model, first, std::vector<Index>(model.bodies.size(), -1));
  std::vector<Vec3> x = model.cloths[0].start;
  x.insert(x.end(), model.cloths[1].start.begin(), model.cloths[1].start.end());
  attachments.begin_step(0, 0.01, x, std::vector<double>(x.size(), 0.001));
  for (std::size_t i = 0; i < x.size(); ++i)
    x[i] += 0.004 * Vec3(std::sin(3.0 * i), std::sin(5.0 * i), std::sin(7.0 * i));
  x[36] += Vec3(0.002, 0.004, 0.03);
  std::vector<Vec3> force(x.size(), Vec3::Zero());
  attachments.add_forces(x, force);
  solver::LinearSystem system;
  attachments.add_terms(x, 1, system);
  ASSERT_EQ(system.terms.size(), 1u);
  const solver::StencilTerm& term = system.terms[0];
  int touched = 0;
  for (std::size_t i = 0; i < x.size(); ++i)
    for (int axis = 0; axis < 3; ++axis) {
      constexpr double kStep = 1e-6;
      const auto at = [&](double shift) {
        std::vector<Vec3> moved = x, forces(x.size(), Vec3::Zero());
        moved[i][axis] += shift;
        attachments.add_forces(moved, forces);
        return std::pair(attachments.energy(moved), forces);
      };
      const auto above = at(kStep), below = at(-kStep);
      EXPECT_NEAR((below.first - above.first) / (2 * kStep), force[i][axis], 1e-6);
      touched += force[i][axis] != 0;
      for (int a = 0; a < 4; ++a) {
        const auto p = static_cast<std::size_t>(term.particles[a]);
        double weight = 0;
        for (int b = 0; b < 4; ++b)
          if (static_cast<std::size_t>(term.particles[b]) == i) weight += term.weights[b];
        const Vec3 expected = -term.weights[a] * weight * term.stiffness.col(axis);
        EXPECT_LT(((above.second[p] - below.second[p]) / (2 * kStep) - expected).norm(), 1e-3) << "of 2000 N/m";
      }
    }
  EXPECT_EQ(touched, 12);
}

}  // namespace
}  // namespace weft::simulation
