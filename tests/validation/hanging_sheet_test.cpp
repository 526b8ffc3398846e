// A sheet that hangs by its upper edge.
#include <gtest/gtest.h>

#include <numbers>

#include "film/production/scene_simulation.hpp"
#include "simulation/scenes.hpp"

namespace weft::simulation {
namespace {

TEST(HangingSheet, IsLongerByHalfItsWeightOverItsStiffness) {
  constexpr double kLength = 0.8, kDensity = 0.3, kStiffness = 150;
  for (scene::Integrator integrator : {scene::Integrator::implicit_euler, scene::Integrator::bdf2}) {
    scene::Scene scene = testing::sheet_alone(kLength, 9, 0);
    testing::solve_tightly(scene);
    scene.time.integrator = integrator;
    scene::Cloth& cloth = scene.cloths[0];
    cloth.pose.rotation = Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitX());  // warp upward
    cloth.material.density = kDensity;
    cloth.material.stretch_weft = cloth.material.stretch_warp = kStiffness;
    cloth.material.stretch_viscosity = 2;
    cloth.material.shear = cloth.material.bend = 0;
    scene::Pin top;
    top.low = {0, 1};
    cloth.pins.push_back(top);

    production::SceneSimulation simulation(scene);
    FrameReport report;
    // The sheet comes to rest: its slowest mode, a quarter wave with speed √(k/ρ) = 22 m/s, has a period of 0.14 s, a
    // fourteenth of the run.
    for (int k = 0; k < 50; ++k) report = simulation.advance();
    EXPECT_LT(report.kinetic_energy, 1e-15);

    // With lumped masses, each edge carries exactly the weight of the sheet below its middle, so the extensions of a
    // thread sum up to ρ g L² / 2k without a discretisation error. Tolerance: Newton's method leaves unbalanced forces
    // of 1e-9 of the weight.
    const double expected = kDensity * 9.81 * kLength * kLength / (2 * kStiffness);
    const auto& x = testing::sheet_of(simulation.snapshot());
    for (std::size_t i = 0; i < 9; ++i) {
      EXPECT_NEAR(x[72 + i].z() - x[i].z() - kLength, expected, 1e-6 * expected);
      EXPECT_NEAR(x[i].x(), x[72 + i].x(), 1e-9);
    }
    // The edge next to the pin has the largest strain: it carries the whole sheet except the upper half of its own
    // cell, 0.05 m.
    EXPECT_NEAR(report.max_strain, kDensity * 9.81 * (kLength - 0.05) / kStiffness, 1e-6);
  }
}

}  // namespace
}  // namespace weft::simulation
