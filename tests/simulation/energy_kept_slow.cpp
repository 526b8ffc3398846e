// Compares how much energy the integration methods keep.
#include <gtest/gtest.h>

#include <cstdio>

#include "film/production/scene_simulation.hpp"
#include "simulation/swinging_sheet.hpp"

namespace weft::simulation {
namespace {

// Elastic, kinetic and potential energy, relative to that of the sheet hanging at rest [J].
class Energy {
 public:
  explicit Energy(const scene::Scene& scene) : scene_(scene) {
    // Finds the state of rest with implicit Euler, which damps.
    scene::Scene resting = scene;
    resting.time.integrator = scene::Integrator::implicit_euler;
    resting.time.step = 0.04;
    resting.time.fps = 25;
    resting.cloths[0].material.bend_viscosity = 1e-3;
    production::SceneSimulation simulation(resting);
    FrameReport report;
    for (int k = 0; k < 1500; ++k) report = simulation.advance();
    EXPECT_LT(report.kinetic_energy, 1e-6);
    rest_ = of(simulation, report);
  }
  double above_rest(const production::SceneSimulation& simulation, const FrameReport& report) const {
    return of(simulation, report) - rest_;
  }

 private:
  double of(const production::SceneSimulation& simulation, const FrameReport& report) const {
    const scene::Cloth& cloth = scene_.cloths[0];
    const int nu = cloth.particles_weft, nv = cloth.particles_warp;
    const double cell_mass = cloth.material.density * cloth.size.x() * cloth.size.y() / ((nu - 1) * (nv - 1));
    const auto& x = testing::sheet_of(simulation.snapshot());
    double height = 0;
    for (int j = 0; j < nv; ++j)
      for (int i = 0; i < nu; ++i) {
        const double share = (i == 0 || i == nu - 1 ? 0.5 : 1) * (j == 0 || j == nv - 1 ? 0.5 : 1);
        height += share * x[i + nu * j].z();
      }
    return report.kinetic_energy + report.elastic_energy + cell_mass * scene_.physics.gravity.norm() * height;
  }
  scene::Scene scene_;
  double rest_ = 0;
};

TEST(PinnedSheet, OfSecondOrderMethodsKeepMoreEnergyThanEuler) {
  scene::Scene scene = testing::swinging_sheet(24, 1000, 100, 5e-5);
  scene.time.fps = 20;
  scene.solver.newton_tolerance = 1e-5;
  scene.solver.linear_tolerance = 1e-2;
  const Energy energy(scene);
  std::printf("24x24, pinned at two corners, 0.5 s; energy above the rest position (VBD at 1/600 s: 2.1 to 2.2 %%)\n");
  std::vector<double> kept;
  const auto run = [&](scene::Integrator integrator, int rate) {
    scene.time.integrator = integrator;
    scene.time.step = 1.0 / rate;
    production::SceneSimulation simulation(scene);
    const double start = energy.above_rest(simulation, simulation.initial_report());
    FrameReport report;
    for (int k = 0; k < 10; ++k) report = simulation.advance();
    const double end = energy.above_rest(simulation, report);
    std::printf("%-18s step 1/%-5d %7.4f J of %7.4f J: %6.2f %%\n", name_of(integrator).c_str(), rate, end, start,
                100 * end / start);
    std::fflush(stdout);
    return end / start;
  };
  for (scene::Integrator integrator : testing::kIntegrators) kept.push_back(run(integrator, 600));
  const double finest = run(scene::Integrator::bdf2, 4800);
  EXPECT_LT(kept[0], kept[2]);
  EXPECT_LT(kept[2], kept[1]);
  // Only the method can take energy from the sheet, and the midpoint rule hardly takes any.
  EXPECT_NEAR(kept[1], 1, 0.02);
  EXPECT_GT(finest, kept[2]);
}

}  // namespace
}  // namespace weft::simulation
