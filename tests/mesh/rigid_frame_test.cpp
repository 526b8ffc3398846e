// Frames of rigid bodies, compared with the second moments of solids.
#include "physics/mesh/rigid_frame.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>
#include <vector>

#include "physics/mesh/mesh.hpp"
#include "physics/mesh/shapes.hpp"

namespace weft::mesh {
namespace {

RigidFrame frame_of(const Mesh& mesh) {
  return {mesh.topology.triangles, mesh.positions};
}

/// Second moments about the centre of four particles, each with a quarter of a unit mass.
Mat3 second_moments(const RigidFrame& frame) {
  Mat3 sum = Mat3::Zero();
  for (const Vec3& x : frame.particles()) sum += 0.25 * (x - frame.centre()) * (x - frame.centre()).transpose();
  return sum;
}

TEST(RigidFrame, HasTheMomentsOfABox) {
  const RigidFrame frame = frame_of(make_box(Vec3(0.3, 0.2, 0.001), 0, 8));
  EXPECT_NEAR(frame.volume(), 0.3 * 0.2 * 0.001, 1e-15);
  EXPECT_LT(frame.centre().norm(), 1e-15);
  const Mat3 expected = Vec3(0.09 / 12, 0.04 / 12, 1e-6 / 12).asDiagonal();
  EXPECT_LT((second_moments(frame) - expected).norm(), 1e-12);
}

TEST(RigidFrame, HasTheMomentsOfACylinderWhereverItIs) {
  Mesh mesh = make_cylinder(0.1, 0.5, 256);
  const Mat3 turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  const Vec3 shift(5, -3, 2);
  for (Vec3& x : mesh.positions) x = turn * x + shift;
  const RigidFrame frame = frame_of(mesh);
  EXPECT_LT((frame.centre() - shift).norm(), 1e-9);
  const Mat3 expected = turn * Vec3(0.01 / 4, 0.01 / 4, 0.25 / 12).asDiagonal() * turn.transpose();
  // Tolerance: the moments of a polygon of 256 corners are smaller than those of a circle by the fraction 2e-4.
  EXPECT_LT((second_moments(frame) - expected).norm(), 4e-4 * expected.norm());
  EXPECT_NEAR(frame.volume() / (std::numbers::pi * 0.01 * 0.5), 1, 2e-4);
}

TEST(RigidFrame, CarriesAllVertices) {
  const Mesh mesh = make_sphere(0.2, 16);
  const RigidFrame frame = frame_of(mesh);
  // The vertices must follow the particles in any affine motion.
  Mat3 deform;
  deform << 1, 0.2, 0, -0.1, 0.9, 0.3, 0, 0, 1.2;
  std::vector<Vec3> particles;
  for (const Vec3& x : frame.particles()) particles.push_back(deform * x + Vec3(1, 2, 3));
  std::vector<Vec3> vertices(mesh.positions.size());
  frame.place(particles, vertices);
  double farthest = 0;
  for (std::size_t v = 0; v < vertices.size(); ++v)
    farthest = std::max(farthest, (vertices[v] - deform * mesh.positions[v] - Vec3(1, 2, 3)).norm());
  EXPECT_LT(farthest, 1e-14);
}

TEST(RigidFrame, RefusesWhatEnclosesNothing) {
  EXPECT_THROW(frame_of(make_plane(Vec2(1, 1))), std::invalid_argument);
  Mesh open = make_box(Vec3(1, 1, 1), 0, 8);
  open.topology.triangles.pop_back();
  EXPECT_THROW(frame_of(open), std::invalid_argument);
}

// The moments of a flat body are rounding errors, so that its principal axes and inertia would be arbitrary.
TEST(RigidFrame, RefusesABoxWithoutThicknessHoweverItIsTurned) {
  for (int k = 1; k <= 20; ++k) {
    Mesh flat = make_box(Vec3(1, 1, 1e-9), 0, 8);
    const Mat3 turn = Eigen::AngleAxisd(0.1 * k, Vec3(1, 2, 3).normalized()).toRotationMatrix();
    for (Vec3& x : flat.positions) x = turn * x;
    EXPECT_THROW(frame_of(flat), std::invalid_argument) << k;
  }
}

// The triangle that two tetrahedra share, inside of the surface around both. At each of its edges, three triangles
// meet.
TEST(RigidFrame, RefusesAWallInside) {
  Mesh mesh;
  mesh.positions = {{1, 0, 0}, {0, 1, 0}, {-1, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  mesh.topology.triangles = {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {1, 0, 4}, {2, 1, 4}, {0, 2, 4}};
  EXPECT_NO_THROW(frame_of(mesh));
  mesh.topology.triangles.push_back({0, 1, 2});
  EXPECT_THROW(frame_of(mesh), std::invalid_argument);
}

// One side of a cube faces inward. The signed volume of such a mesh is a third of that of the cube.
TEST(RigidFrame, RefusesTrianglesThatFaceDifferentWays) {
  Mesh cube = make_box(Vec3(1, 1, 1), 0, 8);
  const std::vector<Vec3>& x = cube.positions;
  const auto first = static_cast<std::size_t>(cube.topology.triangles.front()[0]);
  int turned = 0;
  for (Triangle& t : cube.topology.triangles) {
    const auto is_opposite = [&](Index v) { return x[static_cast<std::size_t>(v)].z() == -x[first].z(); };
    if (!std::ranges::all_of(t, is_opposite)) continue;
    std::swap(t[0], t[1]);
    ++turned;
  }
  ASSERT_GT(turned, 0);
  EXPECT_THROW(frame_of(cube), std::invalid_argument);
}

TEST(RigidFrame, IsMadeOfAllClosedShapes) {
  for (const Mesh& mesh : {make_box(Vec3(1, 2, 3), 0.1, 8), make_cone(1, 2, 24), make_torus(1, 0.2, 24),
                           make_half_pipe(1, 2, 0.1, 24), make_sphere(1, 24)})
    EXPECT_GT(frame_of(mesh).volume(), 0.1);
}

}  // namespace
}  // namespace weft::mesh
