// A mass on a thread: only the thread's stiffness limits its extension, however large the mass ratio is.
#include <gtest/gtest.h>

#include <numbers>

#include "film/production/scene_simulation.hpp"
#include "simulation/scenes.hpp"

namespace weft::simulation {
namespace {

TEST(HangingWeight, StretchesItsThreadsByItsWeightOverTheirStiffness) {
  // 20 rows of 1 kg carry 10 to 100,000 kg. With such mass ratios, local iterative solvers are wrong by metres (Macklin
  // et al., "Small Steps in Physics Simulation", 2019).
  constexpr double kWidth = 0.01, kLength = 0.2, kStiffness = 1e9;
  for (double mass : {10.0, 1e3, 1e5}) {
    scene::Scene scene = testing::sheet_alone(1, 2, 0);
    testing::solve_tightly(scene);
    scene.solver.newton_tolerance = 1e-7;  // rounding errors of k · length make 1e-9 unreachable
    scene.time.step = 0.02;
    scene::Cloth& chain = scene.cloths[0];
    chain.size = {kWidth, kLength};
    chain.particles_warp = 21;
    chain.pose.rotation = Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitX());  // warp upward
    chain.material.density = 20 / (kWidth * kLength);
    chain.material.stretch_weft = chain.material.stretch_warp = kStiffness;
    chain.material.stretch_viscosity = 1e6;
    chain.material.bend = chain.material.bend_viscosity = chain.material.bend_friction = 0;
    scene::Pin top;
    top.low = {0, 1};
    chain.pins.push_back(top);
    scene::Weight weight;
    weight.high = {1, 0};
    weight.mass = mass;
    chain.weights.push_back(weight);
    production::SceneSimulation simulation(scene);
    for (int k = 0; k < 150; ++k) simulation.advance();
    const auto& x = testing::sheet_of(simulation.snapshot());
    const double expected = (mass * kLength + 0.5 * 20 * kLength) * 9.81 / (kStiffness * kWidth);
    EXPECT_NEAR(x[40].z() - x[0].z() - kLength, expected, 1e-6 * expected) << mass << " kg";
  }
}

}  // namespace
}  // namespace weft::simulation
