// A strip that overhangs its clamp under its own weight: the heavy elastica.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "film/production/scene_simulation.hpp"
#include "simulation/scenes.hpp"

namespace weft::simulation::testing {

/// Ratio H/W of drop to reach of the tip for Γ = ρ g L³ / B: the planar inextensible elastica under its own weight,
/// clamped horizontally, solved by shooting. Limits: Γ/8 and √(Γ/2).
struct ElasticaPoint {
  double gamma, drop_over_reach;
};
inline constexpr ElasticaPoint kHeavyElastica[] = {{0.1, 0.012500}, {1, 0.124562},  {2, 0.246673},  {5, 0.585721},
                                                   {10, 1.066802},  {20, 1.863930}, {50, 3.705561}, {100, 5.888105}};

/// The meshes of a rectangle.
inline constexpr scene::ClothShape kShapes[] = {scene::ClothShape::quads, scene::ClothShape::aligned_triangles,
                                                scene::ClothShape::crossed_triangles};

inline const char* name_of(scene::ClothShape shape) {
  if (shape == scene::ClothShape::quads) return "quads";
  return shape == scene::ClothShape::aligned_triangles ? "aligned" : "crossed";
}

/// The quantity that is changed to reach Γ.
enum class Route { length, rigidity, density };
inline constexpr Route kRoutes[] = {Route::length, Route::rigidity, Route::density};

struct Overhang {
  double length = 0.1;     ///< L [m]
  double rigidity = 1e-4;  ///< B [N·m]
  double density = 0.3;    ///< ρ [kg/m²]

  double gamma() const { return density * 9.81 * std::pow(length, 3) / rigidity; }
};

/// The default Overhang, Γ = 29, with one quantity changed to reach `gamma`.
inline Overhang overhang(double gamma, Route route) {
  Overhang strip;
  const double change = gamma / strip.gamma();
  if (route == Route::length) strip.length *= std::cbrt(change);
  if (route == Route::rigidity) strip.rigidity /= change;
  if (route == Route::density) strip.density *= change;
  return strip;
}

/// A strip with `cells` cells from the last held column, where the clamp acts, to the tip, and two across.
inline scene::Scene cantilever(scene::ClothShape shape, const Overhang& strip, int cells) {
  scene::Scene scene = sheet_alone(1, 3, 0);
  const double l = strip.length / cells;
  scene::Cloth& cloth = scene.cloths[0];
  cloth.shape = shape;
  cloth.size = {(cells + 1) * l, 2 * l};
  cloth.particles_weft = cells + 2;
  cloth.particles_warp = 3;
  cloth.pose.position = {0.5 * cloth.size.x() - l, 0, 0};  // the last held column is at x = 0
  cloth.material.density = strip.density;
  // At Γ = 100 the weight of at most 1 N/m stretches the strip by 0.05 % on average; at smaller Γ by less.
  cloth.material.stretch_weft = cloth.material.stretch_warp = cloth.material.shear = 1000;
  cloth.material.bend = strip.rigidity;
  cloth.material.bend_viscosity = cloth.material.bend_friction = 0;
  scene::Pin clamp;
  clamp.high = {1.1 / (cells + 1), 1};
  cloth.pins = {clamp};
  return scene;
}

/// H/W of the middle of the tip.
inline double drop_over_reach(const std::vector<Vec3>& x, int cells) {
  const Vec3& tip = x[2 * (cells + 2) - 1];
  return -tip.z() / tip.x();
}

/// H/W once the strip is at rest in a run. Implicit Euler with steps longer than the strip's swings damps its energy.
inline double drop_over_reach_of_run(scene::Scene scene, int cells) {
  scene.time = {.duration = 20, .fps = 5, .step = 0.2};
  scene.solver.newton_tolerance = 1e-5;
  scene.solver.linear_tolerance = 1e-3;
  production::SceneSimulation simulation(scene);
  FrameReport report;
  for (int k = 0; k < scene.frame_count(); ++k) report = simulation.advance();
  EXPECT_LT(report.kinetic_energy, 1e-10 * std::abs(report.potential_energy));
  return drop_over_reach(sheet_of(simulation.snapshot()), cells);
}

}  // namespace weft::simulation::testing
