// Cusick's drape test (bench/fabric_tests.hpp): its supports, agreement of meshes, and measured fabrics.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <map>
#include <numbers>
#include <string>

#include "film/scene/fabrics.hpp"
#include "lab/bench/fabric_tests.hpp"
#include "support/test_folder.hpp"
#include "validation/cantilever.hpp"
#include "validation/cloth_model.hpp"

namespace weft::simulation {
namespace {

using bench::cusick::Drape, bench::cusick::Specimen, bench::cusick::rings;
using bench::cusick::kPlateRadius, bench::cusick::kSpecimenRadius;
using scene::ClothShape;

/// Drapes the specimen and expects it to be at rest.
Drape drape_to_rest(const scene::Scene& scene, const std::vector<mesh::Triangle>& triangles) {
  const Drape found = bench::cusick::drape(scene, triangles);
  EXPECT_LT(found.kinetic_energy, 1e-7);
  return found;
}

class Cusick : public support::TestFolder {
 protected:
  scene::Scene scene_of(const Specimen& disc, const scene::Material& material) {
    return bench::cusick::scene_of(disc, material, folder_ / "disc.obj");
  }

  /// Mean drape coefficient of two specimens.
  double mean_coefficient(const char* name, const scene::Material& material) {
    double mean = 0;
    std::printf("%s:", name);
    for (int seed : {1, 2}) {
      const Specimen disc = rings(14, seed);
      const Drape d = drape_to_rest(scene_of(disc, material), disc.triangles);
      std::printf(" %.1f %% (strain %.4f, %.1f CPU s)", 100 * d.coefficient, d.strain, d.cpu_s);
      mean += 0.5 * d.coefficient;
    }
    std::printf(", mean %.1f %%\n", 100 * mean);
    return mean;
  }
};

// A plate with ν = 0, clamped at a radius of 9 cm and free at 15 cm, sags at its rim by 1.940715e-6 m⁴ q / B under the
// load q [N/m²], from the radial solution A + B r² + C ln r + D r² ln r + q r⁴ / 64 B.
TEST_F(Cusick, PlatesClampAtTheirEdge) {
  constexpr double kSag = 1.940715e-6;
  for (int free : {8, 12, 16}) {
    const Specimen disc = rings(free, 1);
    scene::Material material;
    material.bend = 10;  // stiff, so that it sags by micrometres only
    testing::ClothModel model(scene_of(disc, material));
    model.find_rest(model.free_along({0, 1, 2}));
    double sag = 0, count = 0;
    for (const Vec3& x : model.x)
      if (x.head<2>().norm() > kSpecimenRadius - 1e-6) sag -= x.z(), ++count;
    sag *= material.bend / (count * material.density * 9.81);
    std::printf("%d rings: %.3f %%\n", free, 100 * (sag / kSag - 1));
    // The relative error is 1.36 / n² with n free rings: 2.1 % with eight.
    EXPECT_NEAR(free * free * (sag / kSag - 1), 1.36, 0.05);
  }
}

// All fabrics but polyester match published figures within 10 % (tests/bench/README.md#fabrics). Published ranges are
// up to 24 percentage points wide, and would hide changes of the program. Each fabric must therefore also match its
// coefficient in `found` within 0.9 percentage points, the spread of four specimens.
TEST_F(Cusick, FabricsDrapeAsMeasured) {
  const std::map<std::string, double> found = {{"cotton", 0.780}, {"poplin", 0.846}, {"denim", 0.875},
                                               {"jersey", 0.329}, {"wool", 0.546},   {"suiting", 0.739},
                                               {"silk", 0.326},   {"satin", 0.545},  {"polyester", 0.726},
                                               {"faille", 0.309}, {"leather", 0.763}};
  for (const scene::Fabric& fabric : scene::fabrics()) {
    if (!fabric.measured.drape) continue;
    const std::string& name = fabric.material.fabric;
    const auto [low, high] = *fabric.measured.drape;
    const double mean = mean_coefficient(name.c_str(), fabric.material);
    EXPECT_GT(mean, 0.9 * low) << name;
    EXPECT_TRUE(mean < 1.1 * high || name == "polyester") << name;
    ASSERT_TRUE(found.contains(name)) << name;
    EXPECT_NEAR(mean, found.at(name), 0.009) << name;
  }
}

TEST_F(Cusick, CoefficientIsThatOfAFinerMesh) {
  std::vector<double> found;
  for (int free : {7, 10, 14}) {
    found.push_back(0);
    for (int seed : {1, 2}) {
      const Specimen disc = rings(free, seed);
      const Drape d = drape_to_rest(scene_of(disc, scene::find_fabric("leather")->material), disc.triangles);
      std::printf("leather, %d rings, %zu particles: %.1f %%\n", free, disc.positions.size(), 100 * d.coefficient);
      found.back() += 0.5 * d.coefficient;
    }
  }
  // Measured, from coarse to fine: 66.9, 73.0 and 76.4 %. In finer cells, bending friction keeps narrower folds.
  EXPECT_NEAR(found[1], found[2], 0.05);
}

/// A square specimen with the area of the disc, because a disc cannot consist of quads. Quads and aligned triangles
/// have the same particles, and hold the same ones; crossed triangles have about as many in a coarser grid.
scene::Scene square(ClothShape shape, const scene::Material& material) {
  const int particles = shape == ClothShape::crossed_triangles ? 41 : 57;
  scene::Scene scene = testing::sheet_alone(kSpecimenRadius * std::sqrt(std::numbers::pi), particles, 0);
  // Gravity tilted by 0.3 degrees makes all specimens fold to the same side.
  scene.physics.gravity = 9.81 * Vec3(0.005, 0.003, -1).normalized();
  scene::Cloth& cloth = scene.cloths[0];
  cloth.shape = shape;
  cloth.material = material;
  const model::Model model = environment::Environment(scene).model;
  const std::vector<Vec3>& x = model.cloths[0].start;
  const double reach = kPlateRadius + 0.5 * cloth.size.x() / (particles - 1);
  std::vector<std::size_t> held;
  for (std::size_t i = 0; i < x.size(); ++i)
    if (x[i].norm() < reach) held.push_back(i);
  cloth.pins = bench::cusick::pins_at(x, held);
  return scene;
}

// Largest measured differences from quads, both for leather: 2.4 percentage points for aligned triangles, and 5.4 for
// crossed triangles, whose cells are 1.4 times as wide.
TEST_F(Cusick, QuadsDrapeAsTrianglesDo) {
  for (const char* fabric : {"silk", "wool", "leather", "denim"}) {
    std::printf("%s, square:", fabric);
    double quads = 0;
    for (ClothShape shape : testing::kShapes) {
      const scene::Scene scene = square(shape, scene::find_fabric(fabric)->material);
      const model::Model model = environment::Environment(scene).model;
      const Drape d = drape_to_rest(scene, model.cloths[0].mesh.topology.triangles);
      std::printf(" %s %.1f %% (strain %.4f, %.1f s)", testing::name_of(shape), 100 * d.coefficient, d.strain, d.cpu_s);
      if (shape == ClothShape::quads) quads = d.coefficient;
      EXPECT_NEAR(d.coefficient, quads, shape == ClothShape::crossed_triangles ? 0.06 : 0.03)
          << fabric << ", " << testing::name_of(shape);
    }
    std::printf("\n");
  }
}

}  // namespace
}  // namespace weft::simulation
