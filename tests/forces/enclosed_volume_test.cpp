// Volume inside an open or closed surface, and its derivative.
#include "physics/forces/enclosed_volume.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "physics/mesh/shapes.hpp"

namespace weft::forces {
namespace {

double volume_of(const mesh::Mesh& mesh) {
  std::vector<Vec3> gradient(mesh.positions.size());
  return EnclosedVolume(mesh.topology.triangles, mesh.positions).evaluate(mesh.positions, gradient);
}

/// A sphere without its cap above height z; its rim is not planar.
mesh::Mesh bowl(double z) {
  mesh::Mesh mesh = mesh::make_sphere(0.2, 24);
  std::erase_if(mesh.topology.triangles, [&](const mesh::Triangle& t) {
    return (mesh.positions[t[0]] + mesh.positions[t[1]] + mesh.positions[t[2]]).z() / 3 > z;
  });
  // Drops vertices that no triangle uses.
  std::vector<Index> number(mesh.positions.size(), -1);
  std::vector<Vec3> kept;
  for (mesh::Triangle& t : mesh.topology.triangles)
    for (Index& corner : t) {
      if (number[corner] < 0) {
        number[corner] = static_cast<Index>(kept.size());
        kept.push_back(mesh.positions[corner]);
      }
      corner = number[corner];
    }
  mesh.positions = kept;
  return mesh;
}

TEST(EnclosedVolume, IsThatOfAPolyhedronWhicheverWayItsFacesLookAndWhereverItIs) {
  mesh::Mesh box = mesh::make_box({0.3, 0.4, 0.5}, 0, 4);
  EXPECT_NEAR(volume_of(box), 0.06, 1e-16);
  for (mesh::Triangle& t : box.topology.triangles) std::swap(t[0], t[1]);
  EXPECT_NEAR(volume_of(box), 0.06, 1e-16);
  for (Vec3& x : box.positions) x += Vec3(1e4, -2e4, 3e4);
  EXPECT_NEAR(volume_of(box), 0.06, 1e-12);  // measured error: 7e-14 m³, from rounded positions
  const mesh::Mesh sphere = mesh::make_sphere(0.2, 96);
  EXPECT_NEAR(volume_of(sphere) / (4.0 / 3 * std::numbers::pi * 0.008), 1, 3e-3);
}

TEST(EnclosedVolume, OfAnOpenTubeCountsAsClosedByFlatLids) {
  mesh::Mesh tube;
  constexpr int kAround = 12;
  constexpr double kSphereRadius = 0.1, kHeight = 0.3;
  for (int k = 0; k < kAround; ++k)
    for (double z : {0.0, kHeight}) {
      const double angle = 2 * std::numbers::pi * k / kAround;
      tube.positions.emplace_back(kSphereRadius * std::cos(angle), kSphereRadius * std::sin(angle), z);
      const int next = (k + 1) % kAround;
      if (z == 0)
        tube.topology.triangles.push_back({2 * k, 2 * next, 2 * next + 1});
      else
        tube.topology.triangles.push_back({2 * k, 2 * next + 1, 2 * k + 1});
    }
  const double base = 0.5 * kAround * kSphereRadius * kSphereRadius * std::sin(2 * std::numbers::pi / kAround);
  EXPECT_NEAR(volume_of(tube), base * kHeight, 1e-16);
}

TEST(EnclosedVolume, HasAsDerivativeForcesThatBalanceAndAreItsCentralDifferences) {
  mesh::Mesh mesh = bowl(0.07);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)  // makes the mesh asymmetric
    mesh.positions[i] += 0.02 * Vec3(std::sin(3.0 * i), std::sin(5.0 * i + 1), std::sin(7.0 * i + 2));
  const EnclosedVolume volume(mesh.topology.triangles, mesh.positions);
  std::vector<Vec3> x = mesh.positions, gradient(x.size()), unused(x.size());
  volume.evaluate(x, gradient);
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
  double size = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    force += gradient[i], torque += x[i].cross(gradient[i]), size += gradient[i].norm();
    for (int axis = 0; axis < 3; ++axis) {
      constexpr double kStep = 1e-4;
      const double middle = x[i][axis];
      x[i][axis] = middle + kStep;
      const double above = volume.evaluate(x, unused);
      x[i][axis] = middle - kStep;
      const double below = volume.evaluate(x, unused);
      x[i][axis] = middle;
      // The volume is linear in each coordinate, so the difference has only rounding errors.
      EXPECT_NEAR((above - below) / (2 * kStep), gradient[i][axis], 1e-12) << i;
    }
  }
  EXPECT_LT(force.norm(), 1e-15 * size * 100);
  EXPECT_LT(torque.norm(), 1e-15 * size * 100);
}

}  // namespace
}  // namespace weft::forces
