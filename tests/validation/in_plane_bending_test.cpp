// Compares a strip bent in its own plane with beam theory: elements with locking would be too stiff.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "validation/cantilever.hpp"
#include "validation/cloth_model.hpp"

namespace weft::simulation {
namespace {

using scene::ClothShape;

constexpr double kBeamLength = 0.1, kBeamWidth = 0.01;  // from the held column to the tip [m]
constexpr double kStretch = 1000, kShear = 1000;        // [N/m]

/// In-plane sag of the tip of a strip under transverse gravity, relative to a beam: ν = 0, EI = k w³ / 12, and a shear
/// stiffness of 5/6 · (μ / 2) w (Timoshenko). The first column is held, and nothing bends out of the plane.
double sag_over_beam(ClothShape shape, int across) {
  scene::Scene scene = testing::sheet_alone(1, 3, 0);
  scene.physics.gravity = {0, -9.81e-3, 0};  // small displacements
  scene::Cloth& cloth = scene.cloths[0];
  cloth.shape = shape;
  cloth.size = {kBeamLength, kBeamWidth};
  cloth.particles_weft = 10 * across + 1;
  cloth.particles_warp = across + 1;
  cloth.material.stretch_weft = cloth.material.stretch_warp = kStretch;
  cloth.material.shear = kShear;
  cloth.material.bend = 0;
  scene::Pin clamp;
  clamp.high = {0, 1};
  cloth.pins = {clamp};
  testing::ClothModel model(scene);
  model.find_rest(model.free_along({0, 1}));
  const auto tip = static_cast<std::size_t>((10 * across + 1) * (across / 2 + 1) - 1);
  const double sag = -(model.x[tip].y() - model.cloth().mesh.positions[tip].y());
  const double q = cloth.material.density * 9.81e-3 * kBeamWidth;
  const double beam = q * std::pow(kBeamLength, 4) / (8 * kStretch * std::pow(kBeamWidth, 3) / 12) +
                      q * kBeamLength * kBeamLength / (2 * (5.0 / 6) * 0.5 * kShear * kBeamWidth);
  return sag / beam;
}

// With n cells across, the sag is 1 / (1 + c / n²) times that of the beam. For quads, c = 2: the error of the
// trapezoidal rule in the second moment of area Σ y². Measured: c = 3.5 for aligned triangles, whose strain is constant
// in each triangle, and 1 for crossed triangles. With two cells, aligned triangles thus sag half as far as the beam; as
// the error is of second order, this is not locking.
TEST(InPlaneBending, ApproachesBeamTheoryInSecondOrder) {
  for (const auto& [shape, c] : {std::pair(ClothShape::quads, 2.0), std::pair(ClothShape::aligned_triangles, 3.5),
                                 std::pair(ClothShape::crossed_triangles, 1.0)}) {
    std::printf("%s: sag over beam theory with 2, 4, 8, 16 cells across:", testing::name_of(shape));
    for (int across : {2, 4, 8, 16}) {
      const double found = sag_over_beam(shape, across);
      std::printf(" %.4f", found);
      EXPECT_NEAR(found, 1 / (1 + c / (across * across)), 5e-3) << testing::name_of(shape) << ' ' << across;
    }
    std::printf("\n");
  }
}

}  // namespace
}  // namespace weft::simulation
