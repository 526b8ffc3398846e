// Compares energy, force and Jacobian of each material force with one another.
#include <gtest/gtest.h>

#include <memory>
#include <ostream>
#include <string>

#include "forces/sheets.hpp"
#include "forces/triangle_meshes.hpp"
#include "physics/forces/bands.hpp"
#include "physics/forces/rope_force.hpp"
#include "physics/forces/stretch_limit.hpp"

namespace weft::forces {
namespace {

using testing::kGrid;
using testing::kStiffness;
using testing::Positions;

constexpr double kRate = 150;  // dv/dx of a scheme [1/s]

/// As kGrid, but with spacings from 10 to 29 mm along weft and from 42 to 19 mm along warp.
const mesh::Grid kGraded{5, 4, 0.02, 0.03, 3, 0.45};

struct Case {
  std::string name;
  std::function<std::unique_ptr<Force>(double elastic, double viscous)> make;
  mesh::Grid grid = kGrid;  // grid of the force
  friend void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }
};

const Case kCases[] = {
    {"stretch",
     [](double elastic, double viscous) {
       return std::make_unique<Stretch>(kGrid, 0, StretchParameters{elastic, 0.7 * elastic, viscous});
     }},
    {"shear",
     [](double elastic, double viscous) {
       return std::make_unique<Shear>(kGrid, 0, ShearParameters{elastic, viscous});
     }},
    {"bend",
     [](double elastic, double viscous) {
       return std::make_unique<Bend>(kGrid, 0, BendParameters{elastic, viscous, 0});
     }},
    // The random velocities of the tests, up to 1 m/s, change the curvature by about 1e4 1/(m·s). At this rate,
    // friction has its full size.
    {"bend_with_friction",
     [](double elastic, double viscous) {
       return std::make_unique<Bend>(kGrid, 0, BendParameters{elastic, viscous, 1000 * viscous});
     }},
    {"stretch_of_a_graded_grid",
     [](double elastic, double viscous) {
       return std::make_unique<Stretch>(kGraded, 0, StretchParameters{elastic, 0.7 * elastic, viscous});
     },
     kGraded},
    {"shear_of_a_graded_grid",
     [](double elastic, double viscous) {
       return std::make_unique<Shear>(kGraded, 0, ShearParameters{elastic, viscous});
     },
     kGraded},
    {"bend_of_a_graded_grid",
     [](double elastic, double viscous) {
       return std::make_unique<Bend>(kGraded, 0, BendParameters{elastic, viscous, 1000 * viscous});
     },
     kGraded},
    {"membrane_of_triangles",
     [](double elastic, double viscous) {
       const mesh::Sheet sheet = mesh::make_sheet_from_mesh(mesh::make_triangle_sheet(kGrid, mesh::Pattern::aligned));
       return std::make_unique<TriangleMembrane>(sheet, 0, StretchParameters{elastic, 0.7 * elastic, viscous},
                                                 ShearParameters{0.3 * elastic, 0.5 * viscous});
     }},
    {"bend_of_triangles",
     [](double elastic, double viscous) {
       const mesh::Sheet sheet = mesh::make_sheet_from_mesh(testing::delaunay_sheet(kGrid, 0.3, 3));
       return std::make_unique<TriangleBend>(sheet, 0, BendParameters{elastic, viscous, 1000 * viscous});
     }},
    {"membrane_of_triangles_while_sewn",
     [](double elastic, double viscous) {
       mesh::Sheet sheet = mesh::make_sheet_from_mesh(mesh::make_triangle_sheet(kGrid, mesh::Pattern::aligned));
       sheet.sewn = true;
       sheet.rest = testing::crumpled(kGrid, 0.008, 11);
       auto membrane = std::make_unique<TriangleMembrane>(sheet, 0, StretchParameters{elastic, 0.7 * elastic, viscous},
                                                          ShearParameters{0.3 * elastic, 0.5 * viscous});
       membrane->interpolate_rest_shape(0.4);
       return membrane;
     }},
    // In the crumpled sheets of the tests, some threads are below the onset of locking, some lock, and some exceed the
    // limit.
    {"stretch_limit",
     [](double, double) { return std::make_unique<StretchLimit>(kGrid, 0, StretchParameters{}, 0.1, 0.1); }},
    {"stretch_limit_of_triangles",
     [](double, double) {
       const mesh::Sheet sheet = mesh::make_sheet_from_mesh(mesh::make_triangle_sheet(kGrid, mesh::Pattern::aligned));
       const TriangleMembrane membrane(sheet, 0, StretchParameters{kStiffness, kStiffness, 0}, ShearParameters{});
       return std::make_unique<StretchLimit>(membrane, StretchParameters{}, 0.1, 0.1);
     }},
    {"elastic_band_and_hem",
     [](double elastic, double) {
       mesh::Sheet sheet = mesh::make_sheet_from_mesh(mesh::make_triangle_sheet(kGrid, mesh::Pattern::aligned));
       sheet.bands.push_back({{0, 1, 2, 3, 4}, {0.02, 0.02, 0.02, 0.02}, 0.8, elastic, 0, 1e-6 * elastic, 0});
       return std::make_unique<Bands>(sheet, 0, 0);
     }},
    {"rope",
     [](double elastic, double viscous) {
       return std::make_unique<RopeForce>(std::vector<double>(19, 0.02), false, 0,
                                          RopeForceParameters{.stretch = elastic,
                                                              .stretch_viscosity = viscous,
                                                              .bend = 1e-5 * elastic,
                                                              .bend_viscosity = 1e-5 * viscous});
     }},
    {"closed_cord",
     [](double elastic, double viscous) {
       return std::make_unique<RopeForce>(std::vector<double>(20, 0.02), true, 0,
                                          RopeForceParameters{.stretch = elastic,
                                                              .stretch_viscosity = viscous,
                                                              .bend = 1e-5 * elastic,
                                                              .bend_viscosity = 1e-5 * viscous});
     }},
};

class Derivatives : public ::testing::TestWithParam<Case> {};

// Step of the differences [m], and their tolerance relative to the largest entry. A displacement ε turns the direction
// of a slight curvature κ by ε / (l² κ) = 1e-3. The relative error of a central difference is the square of this;
// extrapolated differences (stiffness_by_differences()) have an error below 1e-10.
constexpr double kDifference = 4e-7;
constexpr double kRelative = 5e-8;

TEST_P(Derivatives, ForceIsMinusTheGradientOfTheEnergy) {
  for (unsigned seed = 1; seed <= 3; ++seed) {
    const auto force = GetParam().make(kStiffness, 0);
    testing::expect_forces_from_energy(*force, testing::crumpled(GetParam().grid, 0.003, seed), kDifference, kRelative);
  }
}

void expect_exact_jacobian(Force& force, const Positions& x, const Positions& v) {
  const Eigen::MatrixXd jacobian = testing::jacobian_of(force, x, v, kRate);
  const Eigen::MatrixXd differences = testing::stiffness_by_differences(force, x, v, kRate, kDifference);
  EXPECT_LT((jacobian - differences).cwiseAbs().maxCoeff(), kRelative * jacobian.cwiseAbs().maxCoeff());
}

TEST_P(Derivatives, ExactJacobianOfElasticityIsThatOfCentralDifferences) {
  for (unsigned seed = 1; seed <= 3; ++seed) {
    const auto force = GetParam().make(kStiffness, 0);
    const Positions x = testing::crumpled(GetParam().grid, 0.003, seed);
    expect_exact_jacobian(*force, x, testing::random_vectors(x.size(), 1, seed + 10));
  }
}

TEST_P(Derivatives, ExactJacobianOfViscosityIsThatOfCentralDifferences) {
  if (GetParam().name == "elastic_band_and_hem" || GetParam().name.starts_with("stretch_limit"))
    GTEST_SKIP() << "has no viscosity";
  for (unsigned seed = 1; seed <= 3; ++seed) {
    const auto force = GetParam().make(0, 5);
    const Positions x = testing::crumpled(GetParam().grid, 0.003, seed);
    expect_exact_jacobian(*force, x, testing::random_vectors(x.size(), 1, seed + 10));
  }
}

TEST_P(Derivatives, DefiniteJacobianIsSymmetricAndPositiveSemidefinite) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const auto force = GetParam().make(kStiffness, 5);
    const Positions x = testing::crumpled(GetParam().grid, 0.006, seed);
    const Positions v = testing::random_vectors(x.size(), 1, seed + 10);
    const Eigen::MatrixXd k = testing::stiffness_of(*force, x, v, kRate);
    const double scale = k.cwiseAbs().maxCoeff();
    EXPECT_LT((k - k.transpose()).cwiseAbs().maxCoeff(), 1e-14 * scale);
    // Tolerance: rounding errors of a few dozen terms in each of 60 rows.
    EXPECT_GT(k.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(), -1e-13 * scale);
  }
}

TEST_P(Derivatives, DefiniteJacobianIsTheExactOneWhereEdgesAreStretchedAndNothingIsSheared) {
  if (GetParam().name == "membrane_of_triangles_while_sewn") GTEST_SKIP() << "its threads are not those of the grid";
  // On a cylinder weft and warp stay orthogonal, and both are longer than at rest.
  const double radius = 0.05;
  const Positions x = testing::moved_rigidly(testing::shaped(GetParam().grid, [&](double u, double v) {
    const double angle = 1.2 * u / radius;
    return Vec3(radius * std::sin(angle), 1.1 * v, radius * (1 - std::cos(angle)));
  }));
  const auto force = GetParam().make(kStiffness, 5);
  const Eigen::MatrixXd definite = testing::stiffness_of(*force, x, testing::zeros(x), kRate);
  const Eigen::MatrixXd exact = testing::jacobian_of(*force, x, testing::zeros(x), kRate);
  if (GetParam().name.starts_with("bend")) {
    // The projected damping is as stiff across the curvature as along it, so the projection adds stiffness.
    const Eigen::MatrixXd added = definite - exact;
    EXPECT_GT(added.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(), -1e-13 * added.cwiseAbs().maxCoeff());
    return;
  }
  // Tolerance: rounding errors of the shear, which is zero.
  EXPECT_LT((definite - exact).cwiseAbs().maxCoeff(), 1e-13 * exact.cwiseAbs().maxCoeff());
}

TEST(DefiniteJacobian, OfTriangleBendingIsTheExactOneAlongTheNormal) {
  // A sheet that was lifted from a plane has curvature vectors that all point up. Damping along them is equal in both
  // matrices.
  const mesh::Sheet sheet = mesh::make_sheet_from_mesh(testing::delaunay_sheet(kGrid, 0.3, 3));
  Positions x = sheet.rest;
  for (Vec3& point : x) point.z() = 3 * point.x() * point.x() - 5 * point.x() * point.y();
  TriangleBend force(sheet, 0, BendParameters{kStiffness, 5, 5000});
  const Eigen::MatrixXd definite = testing::stiffness_of(force, x, testing::zeros(x), kRate);
  const Eigen::MatrixXd exact = testing::jacobian_of(force, x, testing::zeros(x), kRate);
  double largest = 0, off = 0;
  for (Eigen::Index i = 2; i < exact.rows(); i += 3)
    for (Eigen::Index j = 2; j < exact.cols(); j += 3) {
      largest = std::max(largest, std::abs(exact(i, j)));
      off = std::max(off, std::abs(definite(i, j) - exact(i, j)));
    }
  EXPECT_GT(largest, 0);
  EXPECT_LT(off, 1e-12 * largest);  // tolerance: rounding errors of sums of a few dozen terms
}

TEST_P(Derivatives, DefiniteJacobianLeavesOutNothingButNegativeParts) {
  const auto force = GetParam().make(kStiffness, 0);
  const Positions x = testing::crumpled(GetParam().grid, 0.006, 4), still = testing::zeros(x);
  const Eigen::MatrixXd exact = testing::jacobian_of(*force, x, still, kRate);
  const Eigen::MatrixXd added = testing::stiffness_of(*force, x, still, kRate) - exact;
  const double scale = exact.cwiseAbs().maxCoeff();
  EXPECT_GT(added.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(), -1e-13 * scale);
}

TEST_P(Derivatives, ExactJacobianOfCompressedOrShearedClothIsIndefinite) {
  // Newton's method needs a projected Hessian of all forces but bending, because their exact Hessian is indefinite.
  const auto force = GetParam().make(kStiffness, 0);
  const Positions x = testing::crumpled(GetParam().grid, 0.006, 3);
  const Eigen::MatrixXd k = testing::jacobian_of(*force, x, testing::zeros(x), kRate);
  const double min_eigenvalue = k.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff() / k.cwiseAbs().maxCoeff();
  if (GetParam().name.starts_with("bend"))
    EXPECT_GT(min_eigenvalue, -1e-13);
  else
    EXPECT_LT(min_eigenvalue, -1e-3);
}

TEST_P(Derivatives, ForceWithoutMatrixIsTheForceWithIt) {
  const auto force = GetParam().make(kStiffness, 5);
  const Positions x = testing::crumpled(GetParam().grid, 0.006, 1), v = testing::random_vectors(x.size(), 1, 2);
  EXPECT_EQ(testing::linearised(*force, x, v, kRate).force, testing::force_of(*force, x, v, kRate));
}

TEST_P(Derivatives, RangesOfParticlesAddUpToTheSameBits) {
  const auto force = GetParam().make(kStiffness, 5);
  const Positions x = testing::crumpled(GetParam().grid, 0.006, 1), v = testing::random_vectors(x.size(), 1, 2);
  testing::expect_same_bits_in_ranges(*force, x, v, kRate);
}

INSTANTIATE_TEST_SUITE_P(Of, Derivatives, ::testing::ValuesIn(kCases),
                         [](const auto& instance) { return instance.param.name; });

}  // namespace
}  // namespace weft::forces
