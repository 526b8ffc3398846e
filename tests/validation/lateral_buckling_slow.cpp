// A narrow strip is held by one end, with its length horizontal and its width vertical. Above a critical weight, it
// buckles sideways.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>

#include "film/production/scene_simulation.hpp"
#include "simulation/scenes.hpp"
#include "validation/cantilever.hpp"
#include "validation/cloth_model.hpp"

namespace weft::simulation {
namespace {

using scene::ClothShape;

// Γ = ρ g L³ / B at which a narrow strip with ν = 0 buckles: q L³ = 12.854 √(EI GJ) (Prandtl; the factor follows from
// 2.14229, the first zero of the Bessel function J_(-1/6)) with q = ρ g w, EI = B w and, for a plate, GJ = 2 B w.
constexpr double kOnset = 18.18;

constexpr double kStripLength = 0.1;  // [m]
constexpr double kRigidity = 1e-4;    // [N·m]

struct Strip {
  int along, across;  // number of cells from the last held column to the tip, and over the width
};

double spacing(const Strip& cells) {
  return kStripLength / cells.along;
}

scene::Scene upright_strip(ClothShape shape, const Strip& cells, double gamma) {
  scene::Scene scene = testing::sheet_alone(1, 3, 0);
  const double l = spacing(cells);
  scene::Cloth& cloth = scene.cloths[0];
  cloth.shape = shape;
  cloth.size = {(cells.along + 1) * l, cells.across * l};
  cloth.particles_weft = cells.along + 2;
  cloth.particles_warp = cells.across + 1;
  cloth.pose.rotation = Eigen::AngleAxisd(0.5 * std::numbers::pi, Vec3::UnitX());  // warp upward
  cloth.material.density = gamma * kRigidity / (9.81 * std::pow(kStripLength, 3));
  // In its plane, even the narrowest strip (w = 2.5 mm) hardly sags: its in-plane stiffness k w² / 12 is 500 times B.
  cloth.material.stretch_weft = cloth.material.stretch_warp = cloth.material.shear = 1e5;
  cloth.material.bend = kRigidity;
  cloth.material.bend_viscosity = cloth.material.bend_friction = 0;
  scene::Pin clamp;
  clamp.high = {1.1 / (cells.along + 1), 1};
  cloth.pins = {clamp};
  return scene;
}

// The upright strip, sagging in its own plane, is in equilibrium for any weight. The out-of-plane Jacobian decides
// whether the equilibrium is stable.
bool is_stable(ClothShape shape, const Strip& cells, double gamma) {
  testing::ClothModel model(upright_strip(shape, cells, gamma));
  model.find_rest(model.free_along({0, 2}));
  return model.stable(model.free_along({1}));
}

double onset(ClothShape shape, const Strip& cells) {
  double low = 10, high = 40;
  EXPECT_TRUE(is_stable(shape, cells, low));
  EXPECT_FALSE(is_stable(shape, cells, high));
  while (high - low > 5e-3) {
    const double middle = 0.5 * (low + high);
    (is_stable(shape, cells, middle) ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

// The clamp prevents warping at the end of the strip, which adds a stiffness in proportion to w / L. The onset of the
// narrowest strip is within 3 % of theory, and the line through the onsets of the two narrowest strips meets the theory
// at w = 0.
TEST(LateralBuckling, BeginsAtTheWeightOfTheory) {
  for (ClothShape shape : testing::kShapes) {
    std::printf("%s: w/L, onset\n", testing::name_of(shape));
    Vec2 before = Vec2::Zero(), last = Vec2::Zero();
    for (int along : {20, 40, 80, 160}) {
      before = last;
      last = {4 * spacing({along, 4}) / kStripLength, onset(shape, {along, 4})};
      std::printf("  %.4f  %.3f  %5.2f %%\n", last.x(), last.y(), 100 * (last.y() / kOnset - 1));
    }
    EXPECT_NEAR(last.y(), kOnset, 0.03 * kOnset);
    const double limit = last.y() - last.x() * (before.y() - last.y()) / (before.x() - last.x());
    std::printf("  0       %.3f  %5.2f %%\n", limit, 100 * (limit / kOnset - 1));
    EXPECT_NEAR(limit, kOnset, 0.01 * kOnset);
  }
}

TEST(LateralBuckling, HardlyDependsOnTheCellsAcross) {
  for (ClothShape shape : testing::kShapes) {
    const double coarse = onset(shape, {40, 2}), middle = onset(shape, {80, 4}), fine = onset(shape, {160, 8});
    std::printf("%s: w/L 0.05, onset with 2, 4, 8 cells across: %.3f %.3f %.3f\n", testing::name_of(shape), coarse,
                middle, fine);
    EXPECT_NEAR(coarse, fine, 0.03 * fine);
    EXPECT_NEAR(middle, fine, 0.01 * fine);
  }
}

constexpr Strip kOfRun{20, 2};

/// Maximum distance from its plane after a run of 5 s, for a strip with an initial push of 1 mm/s.
double sideways_displacement(double gamma) {
  scene::Scene scene = upright_strip(ClothShape::quads, kOfRun, gamma);
  scene.time = {.duration = 5, .fps = 10, .step = 0.05};
  scene.solver.newton_tolerance = 1e-6;
  scene.solver.linear_tolerance = 1e-3;
  scene.cloths[0].material.stretch_weft = scene.cloths[0].material.stretch_warp = 1e4;
  scene.cloths[0].velocity = {0, 1e-3, 0};
  production::SceneSimulation simulation(scene);
  for (int k = 1; k < scene.frame_count(); ++k) simulation.advance();
  double aside = 0;
  for (const Vec3& x : testing::sheet_of(simulation.snapshot())) aside = std::max(aside, std::abs(x.y()));
  return aside;
}

TEST(LateralBuckling, StripOfARunFallsAsideWhereItsJacobianSays) {
  const double at = onset(ClothShape::quads, kOfRun);
  const double below = sideways_displacement(0.9 * at), above = sideways_displacement(1.1 * at);
  std::printf("aside after 5 s: %.2e m at 0.9, %.2e m at 1.1 of the onset\n", below, above);
  EXPECT_LT(below, 1e-3);
  EXPECT_GT(above, 1e-2);
}

}  // namespace
}  // namespace weft::simulation
