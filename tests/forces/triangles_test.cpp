// Triangle cloth must be exact on any mesh if the continuum solution is simple.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "forces/sheets.hpp"
#include "forces/triangle_meshes.hpp"

namespace weft::forces {
namespace {

using testing::kMeshings;
using testing::Positions;

const Vec2 kSize(0.4, 0.3);  // [m]

Positions mapped(const mesh::Mesh& mesh, const std::function<Vec3(double, double)>& surface) {
  Positions x;
  for (const Vec2& uv : mesh.uv) x.push_back(surface(uv.x(), uv.y()));
  return x;
}

// Vertices at least `rings` edges away from the border.
std::vector<char> inside(const mesh::Sheet& sheet, int rings) {
  std::vector<char> result(sheet.rest.size(), 1);
  for (const mesh::Edge& edge : mesh::collect_edges(sheet.triangles).edges)
    if (edge.triangles[1] < 0)
      for (Index v : edge.vertices) result[v] = 0;
  for (int ring = 1; ring < rings; ++ring) {
    const std::vector<char> before = result;
    for (const mesh::Triangle& t : sheet.triangles)
      for (Index a : t)
        for (Index b : t)
          if (!before[a]) result[b] = 0;
  }
  return result;
}

TEST(TriangleMembrane, DefiniteFormLeavesOutWhatCompressionSoftens) {
  const mesh::Mesh mesh = mesh::make_triangle_sheet(mesh::Grid{3, 3, 0.1, 0.1}, mesh::Pattern::aligned);
  TriangleMembrane membrane(mesh::make_sheet_from_mesh(mesh), 0, {1000, 0, 0}, {0, 0});
  // `across` and `exactly_across`: second derivative of the energy with respect to θ, where the weft turns out of the
  // plane, s_u = (stretch, 0, θ) [N·m].
  const auto stretched = [&](double stretch) {
    return mapped(mesh, [&](double u, double v) { return Vec3(stretch * u, v, 0); });
  };
  const auto of_turn = [&](const Eigen::MatrixXd& k) {
    double sum = 0;
    for (std::size_t a = 0; a < mesh.uv.size(); ++a)
      for (std::size_t b = 0; b < mesh.uv.size(); ++b)
        sum += mesh.uv[a].x() * mesh.uv[b].x() *
               k(static_cast<Eigen::Index>(3 * a + 2), static_cast<Eigen::Index>(3 * b + 2));
    return sum;
  };
  const auto across = [&](double stretch) {
    const Positions x = stretched(stretch);
    return of_turn(testing::stiffness_of(membrane, x, testing::zeros(x), 0));
  };
  const auto exactly_across = [&](double stretch) {
    const Positions x = stretched(stretch);
    return of_turn(testing::jacobian_of(membrane, x, testing::zeros(x), 0));
  };
  const double along = 1000 * 0.2 * 0.2;  // k A [N·m]
  EXPECT_NEAR(exactly_across(0.8), -0.25 * along, 1e-12 * along);
  EXPECT_NEAR(across(0.8), 0, 1e-12 * along);
  EXPECT_NEAR(exactly_across(0.1), -9 * along, 1e-12 * along);
  EXPECT_NEAR(across(0.1), 0, 1e-12 * along);
}

TEST(TriangleMembrane, LinearMapHasTheEnergyAndTheStressOfTheContinuum) {
  const Vec3 su(1.05, 0.1, 0.02), sv(-0.04, 0.97, 0.1);
  const double weft = 1000, warp = 700, shear = 90;
  const double c = su.dot(sv);
  const double density =
      0.5 * weft * std::pow(su.norm() - 1, 2) + 0.5 * warp * std::pow(sv.norm() - 1, 2) + 0.25 * shear * c * c;
  // Force per width on a cut across the weft [N/m].
  const Vec3 traction_u = weft * (su.norm() - 1) * su.normalized() + 0.5 * shear * c * sv;
  for (const testing::Meshing& meshing : kMeshings) {
    const mesh::Mesh mesh = meshing.make(kSize, 8);
    const mesh::Sheet sheet = mesh::make_sheet_from_mesh(mesh);
    const TriangleMembrane membrane(sheet, 0, {weft, warp, 0}, {shear, 0});
    const Positions x = mapped(mesh, [&](double u, double v) -> Vec3 { return su * u + sv * v; });
    const double area = kSize.prod();
    EXPECT_NEAR(membrane.energy(x), density * area, 1e-12 * density * area) << meshing.name;
    const Positions f = testing::force_of(membrane, x, testing::zeros(x));
    const std::vector<char> inner = inside(sheet, 1);
    Vec3 work = Vec3::Zero();  // done along the virtual displacement that stretches the weft uniformly
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (inner[i]) {
        EXPECT_LT(f[i].norm(), 1e-11) << meshing.name;
      }
      work -= mesh.uv[i].x() * f[i];
    }
    EXPECT_LT((work - traction_u * area).norm(), 1e-12 * traction_u.norm() * area) << meshing.name;
  }
}

TEST(TriangleCurvature, IsExactForEveryQuadraticWhereNoSideIsFree) {
  for (const testing::Meshing& meshing : kMeshings) {
    const mesh::Mesh mesh = meshing.make(kSize, 8);
    const mesh::Sheet sheet = mesh::make_sheet_from_mesh(mesh);
    const auto stencils = curvature_stencils(sheet);
    const mesh::EdgeSet edges = mesh::collect_edges(sheet.triangles);
    int exact = 0;
    for (std::size_t t = 0; t < stencils.size(); ++t) {
      Vec3 curvature = Vec3::Zero();
      for (std::size_t k = 0; k < stencils[t].vertices.size(); ++k) {
        const Vec2& uv = mesh.uv[stencils[t].vertices[k]];
        const double w = 0.7 * uv.x() * uv.x() - 1.1 * uv.x() * uv.y() + 0.4 * uv.y() * uv.y() + 0.3 * uv.x() - 0.2;
        curvature += stencils[t].weights[k] * w;
      }
      bool free = false;
      for (Index e : edges.of_triangle[t]) free = free || edges.edges[e].triangles[1] < 0;
      if (free) continue;
      ++exact;
      // Tolerance: rounding errors of weights of 1e4 to 1e6 1/m², times values of w of about 0.2 m [1/m].
      EXPECT_LT((curvature - Vec3(1.4, 0.8, -1.1)).norm(), 2e-9) << meshing.name << ", triangle " << t;
    }
    EXPECT_GT(exact, static_cast<int>(stencils.size()) / 2);
  }
}

// The smallest closed surface: nothing defines the angle between its two triangles.
TEST(TriangleCurvature, OfTwoTrianglesWithTheSameCornersIsZero) {
  const mesh::Mesh mesh{.topology = {.quads = {}, .triangles = {{0, 1, 2}, {0, 2, 1}}},
                        .positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                        .uv = {}};
  for (const CurvatureStencil& stencil : curvature_stencils(mesh::make_sheet_from_mesh(mesh))) {
    EXPECT_EQ(stencil.vertices.size(), 3U);
    // Tolerance: rounding errors of weights of about 1 / area = 2 1/m².
    for (const Vec3& weight : stencil.weights) EXPECT_LT(weight.norm(), 1e-14);
  }
}

TEST(TriangleBend, ConstantMomentLeavesNoForceInside) {
  for (const testing::Meshing& meshing : kMeshings) {
    const mesh::Mesh mesh = meshing.make(kSize, 16);
    const mesh::Sheet sheet = mesh::make_sheet_from_mesh(mesh);
    const TriangleBend bend(sheet, 0, {1, 0});
    const Positions x = mapped(mesh, [](double u, double v) { return Vec3(u, v, u * u - 0.6 * u * v + 0.3 * v * v); });
    const Positions f = testing::force_of(bend, x, testing::zeros(x));
    const std::vector<char> inner = inside(sheet, 5);
    double largest = 0;
    for (std::size_t i = 0; i < f.size(); ++i)
      if (inner[i]) largest = std::max(largest, f[i].norm());
    // Tolerance: rounding errors, relative to the forces at the border.
    EXPECT_LT(largest, 1e-9 * testing::largest(f)) << meshing.name;
  }
}

TEST(TriangleBend, OnlyRigidMotionsAndStretchCostNothing) {
  // Three rigid motions have frequency 0. The lowest other frequency of a free square plate with ν = 0 is
  // 15.57 √(B/ρ)/L² (here B, ρ and L are 1); no mesh may have a softer mode.
  for (const testing::Meshing& meshing : kMeshings) {
    const mesh::Mesh mesh = meshing.make({1, 1}, 10);
    const mesh::Sheet sheet = mesh::make_sheet_from_mesh(mesh);
    TriangleBend bend(sheet, 0, {1, 0});
    const Eigen::MatrixXd full = testing::stiffness_of(bend, sheet.rest, testing::zeros(sheet.rest), 0);
    const auto masses = lumped_masses(sheet, 1);
    const auto count = static_cast<Eigen::Index>(masses.size());
    Eigen::MatrixXd scaled(count, count);
    for (Eigen::Index i = 0; i < count; ++i)
      for (Eigen::Index j = 0; j < count; ++j)
        scaled(i, j) = full(3 * i + 2, 3 * j + 2) / std::sqrt(masses[i] * masses[j]);
    const Eigen::VectorXd squares = scaled.selfadjointView<Eigen::Lower>().eigenvalues();
    EXPECT_LT(std::abs(squares[2]), 1e-7) << meshing.name;
    EXPECT_NEAR(std::sqrt(squares[3]), 15.57, 0.02 * 15.57) << meshing.name;
  }
}

TEST(TriangleMasses, AddUpToTheSheets) {
  for (const testing::Meshing& meshing : kMeshings) {
    double sum = 0;
    for (double mass : lumped_masses(mesh::make_sheet_from_mesh(meshing.make(kSize, 8)), 0.2)) sum += mass;
    EXPECT_NEAR(sum, 0.2 * kSize.prod(), 1e-15) << meshing.name;
  }
}

}  // namespace
}  // namespace weft::forces
