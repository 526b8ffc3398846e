// Tests of RigidVertices, which distribute forces on the vertices of a rigid body to its frame particles.
#include "physics/simulation/rigid_vertices.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <vector>

#include "physics/mesh/shapes.hpp"

namespace weft::simulation {
namespace {

// Corners of a box have weights of both signs, such as one of 1.5 and three of -0.2. If bounds of friction were
// distributed by the absolute values of the weights, their sum would be more than twice too large, and no body would
// count as about to slide.
TEST(RigidVertices, KeepTheSumsOfForcesAndOfTheirBounds) {
  const mesh::Mesh box = mesh::make_box(Vec3(0.2, 0.2, 0.1), 0, 2);
  const mesh::RigidFrame frame(box.topology.triangles, box.positions);
  RigidVertices vertices(Index{mesh::RigidFrame::kParticles});
  vertices.add(frame, 0);
  std::vector<Vec3> forces(static_cast<std::size_t>(vertices.end()), Vec3::Zero());
  std::vector<double> bounds(forces.size(), 0);
  for (std::size_t v = mesh::RigidFrame::kParticles; v < forces.size(); ++v) {
    bounds[v] = static_cast<double>(v);
    forces[v] = Vec3(1, -2, bounds[v]);
  }
  std::vector<Vec3> forces_of_frame(mesh::RigidFrame::kParticles, Vec3::Zero());
  std::vector<double> bounds_of_frame(mesh::RigidFrame::kParticles, 0);
  vertices.gather(forces, forces_of_frame);
  vertices.gather(bounds, bounds_of_frame);
  const auto sum = [](const auto& values, const auto& zero) {
    return std::accumulate(values.begin(), values.end(), zero);
  };
  const Vec3 none = Vec3::Zero();
  EXPECT_LT((sum(forces_of_frame, none) - sum(forces, none)).norm(), 1e-12);
  EXPECT_NEAR(sum(bounds_of_frame, 0.0), sum(bounds, 0.0), 1e-12);
}

}  // namespace
}  // namespace weft::simulation
