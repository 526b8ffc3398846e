// Tests of StepProblem: equal arguments and memory give equal forces, and no invalid cached value is used.
#include "physics/simulation/step_problem.hpp"

#include <gtest/gtest.h>

#include "forces/sheets.hpp"
#include "physics/simulation/pins.hpp"
#include "simulation/scenes.hpp"
#include "support/scene_runs.hpp"
#include "support/test_folder.hpp"

namespace weft::simulation {
namespace {

constexpr double kRate = 100;  // [1/s]
constexpr Index kSide = 5, kParticles = kSide * kSide;

// Two sheets with stretch, shear, bending and their viscosities. The fixture crumples and moves them, and adds a
// contact of particle 3 of the first sheet.
scene::Scene two_sheets() {
  scene::Scene scene = testing::sheet_alone(0.2, kSide, 0);
  scene::Material& material = scene.cloths[0].material;
  material.stretch_viscosity = material.shear_viscosity = 0.5;
  material.bend_viscosity = 1e-6;
  scene.cloths.push_back(scene.cloths[0]);
  scene.cloths[1].shape = scene::ClothShape::aligned_triangles;
  return scene;
}

class StepProblems : public ::testing::Test {
 protected:
  StepProblems()
      : model_(environment::Environment(two_sheets()).model),
        cloth_(model_),
        response_(collision::ResponseForm::springs, {cloth_.masses().begin(), cloth_.masses().end()}),
        v_(forces::testing::random_vectors(2 * kParticles, 1, 1)) {
    for (const model::Cloth& cloth : model_.cloths) x_.insert(x_.end(), cloth.start.begin(), cloth.start.end());
    const std::vector<Vec3> noise = forces::testing::random_vectors(x_.size(), 0.005, 2);
    for (std::size_t i = 0; i < x_.size(); ++i) x_[i] += noise[i];

    response_.begin_step(0.01);
    collision::Contact contact;
    contact.particles = {3, 0, 0, 0};
    contact.weights = {1, 0, 0, 0};
    contact.range = contact.full_range = 0.01;
    contact.stiffness = 50;
    contact.friction = 0.4;
    contact.relative_start = Vec3(0, 0, 0.004);
    contact.depth = 0.006;
    contact.obstacle_end = Vec3(0.001, 0, 0.005) - x_[3];
    response_.add(contact, x_);
  }

  StepProblem problem() {
    StepProblem made(cloth_);
    made.use_contacts(response_);
    return made;
  }
  integrator::StagePoint at(std::span<const Vec3> x, double rate = kRate) const { return {x, v_, x, rate, 1}; }
  std::vector<Vec3> forces(StepProblem& problem, std::span<const Vec3> x) const {
    std::vector<Vec3> force(x.size(), Vec3::Zero());
    problem.forces(at(x), force);
    return force;
  }
  std::vector<Vec3> linearise(StepProblem& problem, std::span<const Vec3> x, double rate = kRate,
                              int iteration = 0) const {
    std::vector<Vec3> force(x.size(), Vec3::Zero());
    problem.linearise(at(x, rate), iteration, force);
    return force;
  }
  // Moves all particles of a sheet by this number of spacings of 5 cm.
  std::vector<Vec3> moved(std::size_t sheet, double spacings) const {
    std::vector<Vec3> x = x_;
    for (std::size_t i = 0; i < kParticles; ++i) x[sheet * kParticles + i] += 0.05 * spacings * Vec3(0.6, 0, 0.8);
    return x;
  }
  static std::vector<Mat3> blocks(const StepProblem& problem) {
    const solver::BlockMatrix& matrix = problem.memory().system.matrix;
    std::vector<Mat3> all;
    matrix.for_each_block(0, matrix.rows(), [&](Index, Index, const Mat3& block) { all.push_back(block); });
    return all;
  }

  model::Model model_;
  ClothSystem cloth_;
  collision::ContactResponse response_;
  std::vector<Vec3> x_, v_;
};

TEST_F(StepProblems, GiveTheSameForceWhateverWasEvaluatedBefore) {
  StepProblem used = problem(), fresh = problem();
  linearise(used, moved(1, 2));
  used.begin_step(0, x_, {});
  const std::vector<Vec3> of_linearisation = linearise(used, x_);
  EXPECT_EQ(of_linearisation, linearise(fresh, x_));
  EXPECT_NE(of_linearisation, forces(used, moved(0, 1)));
  EXPECT_NE(of_linearisation, forces(used, moved(1, 1)));
  std::vector<Vec3> linear(x_.size(), Vec3::Zero());
  used.linear_forces(at(x_), linear);
  EXPECT_EQ(of_linearisation, linear);
  EXPECT_EQ(forces(used, x_), forces(fresh, x_));
}

TEST_F(StepProblems, KnowForcesByPositionAndVelocityOfEachCloth) {
  StepProblem used = problem();
  linearise(used, x_);
  for (std::vector<Vec3>* of : {&x_, &v_})
    for (std::size_t i : {0UL, 2UL * kParticles - 1}) {
      (*of)[i].y() += 1e-9;
      StepProblem fresh = problem();
      fresh.begin_step(0, x_, {});
      linearise(fresh, x_);
      EXPECT_EQ(forces(used, x_), forces(fresh, x_)) << i;
    }
}

TEST_F(StepProblems, ChangeTheirMemoryOnlyWhenTheyLinearise) {
  StepProblem problem = this->problem();
  linearise(problem, x_);
  linearise(problem, moved(0, 0.1));
  const SolveMemory before = problem.memory();
  const std::vector<Mat3> matrix = blocks(problem);
  EXPECT_EQ(before.contacts.updates, 2);
  forces(problem, moved(0, 1));
  forces(problem, x_);
  const SolveMemory& after = problem.memory();
  EXPECT_EQ(after.rate, before.rate);
  EXPECT_EQ(after.linearised_at, before.linearised_at);
  EXPECT_EQ(after.contacts.normal_forces, before.contacts.normal_forces);
  EXPECT_EQ(after.contacts.updates, before.contacts.updates);
  EXPECT_EQ(after.system.blocks[0].version, before.system.blocks[0].version);
  EXPECT_EQ(blocks(problem), matrix);

  // A copy with the same memory gives the same result.
  StepProblem twin = problem;
  EXPECT_EQ(linearise(twin, moved(1, 0.3)), linearise(problem, moved(1, 0.3)));
  EXPECT_EQ(blocks(twin), blocks(problem));
}

TEST_F(StepProblems, ReassembleTheMatrixForAnotherRate) {
  StepProblem used = problem(), fresh = problem();
  linearise(used, x_, kRate);
  linearise(used, x_, 2 * kRate);
  linearise(fresh, x_, 2 * kRate);
  EXPECT_EQ(blocks(used), blocks(fresh));
  linearise(used, x_, kRate);
  EXPECT_NE(blocks(used), blocks(fresh));
}

TEST_F(StepProblems, ReassembleTheRowsOfMovedClothAndAllRowsInEachStep) {
  StepProblem used = problem();
  linearise(used, x_);
  const std::vector<Mat3> start = blocks(used);
  const auto version = [&](std::size_t sheet) { return used.memory().system.blocks[sheet].version; };
  const auto first = version(0), second = version(1);
  linearise(used, moved(1, 0.004));  // below 0.005 spacings, up to which blocks are kept
  EXPECT_EQ(blocks(used), start);
  const std::vector<Vec3> far = moved(1, 0.5);
  linearise(used, far);
  EXPECT_EQ(version(0), first);
  EXPECT_GT(version(1), second);
  EXPECT_NE(blocks(used), start);

  const std::vector<Vec3> near = moved(0, 0.004);
  linearise(used, near);
  used.begin_step(0, x_, {});
  linearise(used, near);
  StepProblem fresh = problem();
  linearise(fresh, near);
  EXPECT_EQ(blocks(used), blocks(fresh));
  EXPECT_GT(version(0), first);
}

TEST_F(StepProblems, CountUpdatesOfFrictionOverAllSolvesOfAStep) {
  StepProblem problem = this->problem();
  for (int solve = 0; solve < 2; ++solve)
    for (int iteration = 0; iteration < 3; ++iteration)
      linearise(problem, moved(0, 0.01 * iteration), kRate, iteration);
  EXPECT_EQ(problem.memory().contacts.updates, 6);
  EXPECT_EQ(problem.memory().contacts.normal_forces.size(), 1U);
  linearise(problem, moved(0, 0.02));
  const double lagging = problem.memory().contacts.normal_forces[0];
  problem.begin_step(0, x_, {});
  EXPECT_EQ(problem.memory().contacts.updates, 0);
  linearise(problem, x_);
  EXPECT_NE(problem.memory().contacts.normal_forces[0], lagging);  // the normal force at the start of the step
}

TEST_F(StepProblems, FollowNormalForcesAgainAfterContactsHaveChanged) {
  StepProblem problem = this->problem();
  for (int update = 0; update < 25; ++update) linearise(problem, moved(0, 0.01));
  EXPECT_GE(problem.memory().contacts.updates, numerics.newton.slow_after);
  problem.limit_friction_updates();
  linearise(problem, x_);
  const double load = problem.memory().contacts.normal_forces[0];
  linearise(problem, moved(0, -0.02));
  EXPECT_NE(problem.memory().contacts.normal_forces[0], load);
}

TEST(PinnedProblem, ReassemblesTheMatrixWherePinsRelease) {
  for (const char* shape : {"quads", "crossed_triangles"}) {
    const scene::Scene scene =
        support::scene_of_text(std::string("[[cloth]]\nname = 'sheet'\nparticles = 5\nshape = '") + shape +
                               "'\npin = [{ low = [0, 0], high = [0.25, 1] }]\n");
    const model::Model model = environment::Environment(scene).model;
    const std::vector<Vec3>& x = model.cloths[0].start;
    const std::vector<Vec3> still(x.size(), Vec3::Zero());
    std::vector<integrator::HeldParticle> pinned;
    for (const model::WeightedParticle& chosen : model.cloths[0].pins[0].particles)
      pinned.push_back({{chosen.particle, Mat3::Zero()}, x[chosen.particle], Vec3::Zero()});
    ClothSystem cloth(model);
    StepProblem problem(cloth);
    const auto matrix_with = [&](std::span<const integrator::HeldParticle> held) {
      std::vector<Vec3> force = still;
      problem.begin_step(0, x, held);
      problem.linearise({x, still, x, kRate, 1}, 0, force);
      std::vector<Mat3> all;
      const solver::BlockMatrix& matrix = problem.memory().system.matrix;
      matrix.for_each_block(0, matrix.rows(), [&](Index, Index, const Mat3& block) { all.push_back(block); });
      return all;
    };
    const std::vector<Mat3> held = matrix_with(pinned);
    EXPECT_EQ(matrix_with(pinned), held) << "nothing was let go";
    EXPECT_NE(matrix_with({}), held) << shape;
    EXPECT_EQ(matrix_with(pinned), held) << shape;
  }
}

class SewnProblem : public support::TestFolder {};

TEST_F(SewnProblem, RecomputesForcesWhenTheRestShapeHasChanged) {
  support::write_bytes(folder_ / "tube.toml", testing::kTube);
  const scene::Scene scene =
      support::scene_of_text("[[cloth]]\nname = 'tube'\nshape = 'pattern'\nfile = '" +
                             (folder_ / "tube.toml").string() + "'\nedge_length = 0.1\nsewing = 0.5\n");
  const model::Model model = environment::Environment(scene).model;
  ClothSystem cloth(model);
  StepProblem problem(cloth);
  const std::vector<Vec3>& x = model.cloths[0].start;
  const std::vector<Vec3> still(x.size(), Vec3::Zero());
  const integrator::StagePoint at{x, still, x, kRate, 1};
  const auto force_at = [&](double t) {
    std::vector<Vec3> force = still;
    problem.begin_step(t, x, {});
    problem.linearise(at, 0, force);
    return force;
  };
  const std::vector<Vec3> start = force_at(0), later = force_at(0.3);
  EXPECT_NE(later, start);
  EXPECT_EQ(force_at(0.3), later) << "nothing was sewn";
  EXPECT_EQ(force_at(0), start);
}

// The cells measure 125 by 25 mm. The matrix is stiffest along their short sides.
TEST(ClothSystems, AggregateSlenderCellsAlongTheirShortSidesFirst) {
  scene::Scene scene = testing::sheet_alone(1, 9, 1);
  scene.cloths[0].size = {1, 0.2};
  const model::Model model = environment::Environment(scene).model;
  const std::vector<Index> of = ClothSystem(model).make_linear_system().aggregate_levels.front().of;
  ASSERT_EQ(of.size(), 81U);
  int together = 0;
  for (std::size_t i = 0; i < of.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      if (of[i] != of[j]) continue;
      ++together;
      EXPECT_EQ(i % 9, j % 9) << i << " and " << j;
    }
  EXPECT_EQ(together, 9 * 4);  // four pairs in each column of nine
}

}  // namespace
}  // namespace weft::simulation
