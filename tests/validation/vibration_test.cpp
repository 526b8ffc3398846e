// Natural frequencies with closed forms: membrane, plate, chain and cantilever.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>

#include "validation/cantilever.hpp"
#include "validation/cloth_model.hpp"

namespace weft::simulation {
namespace {

using scene::ClothShape;

constexpr double kPi = std::numbers::pi;
constexpr double kClothDensity = 0.2;  // [kg/m²]

class Vibration : public ::testing::TestWithParam<ClothShape> {
 protected:
  using Mode = testing::ClothModel::Mode;

  static void expect(const char* what, const std::vector<Mode>& modes, const std::vector<double>& exact) {
    std::printf("%s, %s:", testing::name_of(GetParam()), what);
    ASSERT_GE(modes.size(), exact.size());
    for (std::size_t k = 0; k < exact.size(); ++k) {
      const double found = modes[k].frequency;
      std::printf(" %8.4f rad/s (%.3f %%)", found, 100 * (found / exact[k] - 1));
      EXPECT_NEAR(found, exact[k], 0.01 * exact[k]) << what << ", mode " << k + 1;
    }
    std::printf("\n");
  }
};

/// Holds the four sides of a sheet.
void hold_border(scene::Cloth& cloth) {
  for (int axis : {0, 1})
    for (double end : {0.0, 1.0}) {
      scene::Pin side;
      side.low[axis] = side.high[axis] = end;
      cloth.pins.push_back(side);
    }
}

// λ(m, n) = π² (m²/a² + n²/b²) of the first three modes of a rectangle.
std::vector<double> wave_numbers_sq(const Vec2& size) {
  std::vector<double> all;
  for (int m = 1; m < 4; ++m)
    for (int n = 1; n < 4; ++n)
      all.push_back(kPi * kPi * (m * m / (size.x() * size.x()) + n * n / (size.y() * size.y())));
  std::sort(all.begin(), all.end());
  all.resize(3);
  return all;
}

scene::Scene rectangle(ClothShape shape) {
  scene::Scene scene = testing::sheet_alone(1, 3, 0);
  scene.physics.gravity = Vec3::Zero();
  scene::Cloth& cloth = scene.cloths[0];
  cloth.shape = shape;
  cloth.size = {0.4, 0.3};
  cloth.particles_weft = 33;
  cloth.particles_warp = 25;
  cloth.material.density = kClothDensity;
  hold_border(cloth);
  return scene;
}

TEST_P(Vibration, OfATautMembrane) {
  scene::Scene scene = rectangle(GetParam());
  scene::Cloth& cloth = scene.cloths[0];
  cloth.material.bend = 0;
  cloth.start_scale = {1.02, 1.02};
  testing::ClothModel model(scene);
  std::vector<double> exact;
  // Threads stretched by λ have the tension k (λ - 1): in rest coordinates ω² = k (1 - 1/λ) λ(m, n) / ρ.
  for (double square : wave_numbers_sq(cloth.size))
    exact.push_back(std::sqrt(cloth.material.stretch_weft * (1 - 1 / 1.02) * square / kClothDensity));
  expect("membrane", model.modes(model.free_along({2}), 3), exact);
}

TEST_P(Vibration, OfASupportedPlate) {
  const scene::Scene scene = rectangle(GetParam());
  const scene::Cloth& cloth = scene.cloths[0];
  testing::ClothModel model(scene);
  std::vector<double> exact;
  for (double square : wave_numbers_sq(cloth.size))
    exact.push_back(square * std::sqrt(cloth.material.bend / kClothDensity));
  expect("plate", model.modes(model.free_along({2}), 3), exact);
}

/// A strip that hangs from its upper row. Its bending stiffness is so small that it only keeps the rows straight.
scene::Scene chain(ClothShape shape) {
  scene::Scene scene = testing::sheet_alone(1, 3, 0);
  scene::Cloth& cloth = scene.cloths[0];
  cloth.shape = shape;
  cloth.size = {0.01, 0.5};
  cloth.particles_warp = 51;
  cloth.pose.rotation = Eigen::AngleAxisd(0.5 * kPi, Vec3::UnitX());  // warp upward
  cloth.material.density = kClothDensity;
  cloth.material.stretch_weft = cloth.material.stretch_warp = 5000;  // [N/m]; the weight stretches by 0.01 % on average
  cloth.material.bend = 1e-7;                                        // affects boundary layers of √(B / T) = 0.3 mm
  cloth.material.bend_viscosity = cloth.material.bend_friction = 0;
  scene::Pin top;
  top.low = {0, 1};
  cloth.pins = {top};
  return scene;
}

TEST_P(Vibration, OfAHangingChain) {
  testing::ClothModel model(chain(GetParam()));
  model.find_rest(model.free_along({0, 2}));
  std::vector<double> exact;
  for (double zero : {2.40483, 5.52008, 8.65373})  // zeros of the Bessel function J0
    exact.push_back(0.5 * zero * std::sqrt(9.81 / 0.5));
  // Each mode has a slightly faster counterpart in which the ribbon twists, driven by the same tension.
  std::vector<Mode> sways = model.modes(model.free_along({1}), 6);
  std::erase_if(sways, [](const Mode& mode) { return mode.mass_fraction < 0.02; });
  expect("chain", sways, exact);
}

TEST_P(Vibration, OfACantilever) {
  const testing::Overhang strip;
  scene::Scene scene = testing::cantilever(GetParam(), strip, 40);
  scene.physics.gravity = Vec3::Zero();
  testing::ClothModel model(scene);
  std::vector<double> exact;
  for (double beta : {1.87510, 4.69409, 7.85476})
    exact.push_back(beta * beta * std::sqrt(strip.rigidity / strip.density) / (strip.length * strip.length));
  expect("cantilever", model.modes(model.free_along({2}), 3), exact);
}

/// Mode shape of a cantilever at s = x / L.
double cantilever_mode(double beta, double s) {
  const double sigma = (std::cosh(beta) + std::cos(beta)) / (std::sinh(beta) + std::sin(beta));
  return std::cosh(beta * s) - std::cos(beta * s) - sigma * (std::sinh(beta * s) - std::sin(beta * s));
}

// A run of a cantilever after a push: its frequency follows from the upward zero crossings of its component in the
// mode, over ten periods of a hundred steps. With these steps, the midpoint rule is slow by (ω h)² / 12 = 0.03 %.
TEST(VibrationOfARun, HasThePhaseOfItsModes) {
  const testing::Overhang strip;
  for (double beta : {1.87510, 4.69409}) {
    const double exact = beta * beta * std::sqrt(strip.rigidity / strip.density) / (strip.length * strip.length);
    scene::Scene scene = testing::cantilever(ClothShape::quads, strip, 40);
    scene.physics.gravity = Vec3::Zero();
    scene.cloths[0].velocity = {0, 0, 1e-4 * exact};
    scene.time = {.duration = 1, .fps = 100 * exact / (2 * kPi), .step = 1};
    scene.time.integrator = scene::Integrator::implicit_midpoint;
    scene.solver.newton_tolerance = 1e-6;
    scene.solver.linear_tolerance = 1e-3;
    production::SceneSimulation simulation(scene);
    double before = 0;
    std::vector<double> ups;  // times of upward zero crossings [frames]
    for (int k = 1; ups.size() < 11 && k < 1300; ++k) {
      simulation.advance();
      double amplitude = 0;
      for (const Vec3& x : testing::sheet_of(simulation.snapshot())) {
        if (x.x() < 0) continue;
        const double mass = x.x() > (1 - 1e-3) * strip.length ? 0.5 : 1;  // relative; half in the last column
        amplitude += mass * x.z() * cantilever_mode(beta, x.x() / strip.length);
      }
      if (before < 0 && amplitude >= 0) ups.push_back(k - amplitude / (amplitude - before));
      before = amplitude;
    }
    ASSERT_EQ(ups.size(), 11u);
    const double found = 10 * 100 / (ups.back() - ups.front()) * exact;
    std::printf("run: %.4f rad/s (%.3f %%)\n", found, 100 * (found / exact - 1));
    EXPECT_NEAR(found, exact, 0.01 * exact);
  }
}

INSTANTIATE_TEST_SUITE_P(Of, Vibration, ::testing::ValuesIn(testing::kShapes),
                         [](const auto& instance) { return testing::name_of(instance.param); });

}  // namespace
}  // namespace weft::simulation
