// A swinging sheet pinned at two corners, without contact: its end depends on the time integration only.
#pragma once

#include <cmath>
#include <vector>

#include "film/production/scene_simulation.hpp"
#include "simulation/scenes.hpp"

namespace weft::simulation::testing {

/// A sheet of one square metre, flat at the start, held at two neighbouring corners. All forces are smooth: there is no
/// dry bending friction.
inline scene::Scene swinging_sheet(int particles, double stretch, double shear, double bend) {
  scene::Scene scene = sheet_alone(1, particles, 0);
  scene::Cloth& cloth = scene.cloths[0];
  cloth.material.stretch_weft = cloth.material.stretch_warp = stretch;
  cloth.material.shear = shear;
  cloth.material.bend = bend;
  cloth.material.bend_viscosity = cloth.material.bend_friction = 0;
  for (double u : {0.0, 1.0}) {
    scene::Pin corner;
    corner.low = corner.high = {u, 1};
    cloth.pins.push_back(corner);
  }
  return scene;
}

/// Final positions [m] and counts of a run.
struct SwingEnd {
  std::vector<Vec3> x;
  double estimate = 0;  ///< sum of the estimated local errors [m]
  int steps = 0, rejected = 0, newton = 0;
};

/// Runs the scene for this number of frames.
inline SwingEnd swing(const scene::Scene& scene, int frames) {
  production::SceneSimulation simulation(scene);
  SwingEnd end;
  FrameReport report;
  for (int k = 0; k < frames; ++k) {
    report = simulation.advance();
    end.estimate += report.error_estimate;
    end.steps += report.steps;
    end.rejected += report.rejected_steps;
    end.newton += report.newton_iterations;
  }
  end.x = sheet_of(simulation.snapshot());
  return end;
}

/// Root mean square of the distances between two states [m].
inline double rms_distance(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]).squaredNorm();
  return std::sqrt(sum / static_cast<double>(a.size()));
}

}  // namespace weft::simulation::testing
