// Rigid motions cause no material forces.
#include <gtest/gtest.h>

#include <memory>

#include "forces/sheets.hpp"
#include "forces/triangle_meshes.hpp"

namespace weft::forces {
namespace {

using testing::kGrid;
using testing::Positions;

struct AllForces {
  Stretch stretch{kGrid, 0, {1000, 700, 5}};
  Shear shear{kGrid, 0, {100, 5}};
  Bend bend{kGrid, 0, {1e-3, 1e-4}};
  mesh::Sheet sheet = mesh::make_sheet_from_mesh(mesh::make_triangle_sheet(kGrid, mesh::Pattern::aligned));
  TriangleMembrane membrane{sheet, 0, {1000, 700, 5}, {100, 5}};
  TriangleBend triangle_bend{sheet, 0, {1e-3, 1e-4}};
  std::vector<std::pair<std::string, const Force*>> list{{"stretch", &stretch},
                                                         {"shear", &shear},
                                                         {"bend", &bend},
                                                         {"membrane of triangles", &membrane},
                                                         {"bend of triangles", &triangle_bend}};
};

TEST(Invariance, NoForceAtRestAndAfterRigidMotion) {
  const AllForces all;
  for (const auto& [name, force] : all.list) {
    for (const Positions& x : {testing::flat(kGrid), testing::moved_rigidly(testing::flat(kGrid))}) {
      // Tolerance: coordinates have rounding errors of 4e-16 m; the force multiplies them by 1000 N/m in about ten
      // terms.
      EXPECT_LT(testing::largest(testing::force_of(*force, x, testing::zeros(x))), 5e-12) << name;
      EXPECT_LT(force->energy(x), 1e-24) << name;
    }
  }
}

TEST(Invariance, NoForceAtRestOfAGradedGridAndAfterRigidMotion) {
  const mesh::Grid grid{5, 4, 0.02, 0.03, 10, 0.2};
  const Stretch stretch(grid, 0, {1000, 700, 5});
  const Shear shear(grid, 0, {100, 5});
  const Bend bend(grid, 0, {1e-3, 1e-4});
  for (const Force* force : std::initializer_list<const Force*>{&stretch, &shear, &bend})
    for (const Positions& x : {testing::flat(grid), testing::moved_rigidly(testing::flat(grid))}) {
      // Tolerance: six times that of the even grid. The stiffness of an edge is proportional to the width of its strip
      // of cloth and to 1 / length. For the shortest edges, width / length is six times as large as in the even grid.
      EXPECT_LT(testing::largest(testing::force_of(*force, x, testing::zeros(x))), 3e-11);
      EXPECT_LT(force->energy(x), 1e-23);
    }
}

TEST(Invariance, EnergyIsTheSameAfterARigidMotionAndForcesTurnWithIt) {
  const AllForces all;
  const Positions x = testing::crumpled(kGrid, 0.004, 1), moved = testing::moved_rigidly(x);
  for (const auto& [name, force] : all.list) {
    EXPECT_NEAR(force->energy(moved), force->energy(x), 1e-12 * force->energy(x)) << name;
    const Positions f = testing::force_of(*force, x, testing::zeros(x));
    Positions turned = testing::force_of(*force, moved, testing::zeros(x));
    for (std::size_t i = 0; i < x.size(); ++i) {
      const Vec3 expected = Eigen::AngleAxisd(1.1, Vec3(1, 2, -3).normalized()) * f[i];
      EXPECT_LT((turned[i] - expected).norm(), 1e-11 * testing::largest(f)) << name;
    }
  }
}

TEST(Invariance, RigidVelocitiesMeetNoViscosity) {
  const AllForces all;
  const Positions x = testing::crumpled(kGrid, 0.004, 2), v = testing::rigid_velocities(x);
  for (const auto& [name, force] : all.list) {
    const Positions still = testing::force_of(*force, x, testing::zeros(x));
    const Positions turning = testing::force_of(*force, x, v);
    const Positions bent = testing::force_of(*force, x, testing::random_vectors(x.size(), 2, 3));
    double difference = 0, other = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      difference = std::max(difference, (turning[i] - still[i]).norm());
      other = std::max(other, (bent[i] - still[i]).norm());
    }
    // Tolerance: rounding errors, relative to the viscous forces of random velocities of the same size.
    EXPECT_LT(difference, 1e-13 * other) << name;
    EXPECT_GT(other, 1e-3) << name;
  }
}

TEST(Invariance, ViscosityTakesEnergyAndNeverGivesIt) {
  const AllForces all;
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const Positions x = testing::crumpled(kGrid, 0.006, seed), v = testing::random_vectors(x.size(), 1, seed + 20);
    for (const auto& [name, force] : all.list) {
      const Positions viscous = testing::force_of(*force, x, v),
                      elastic = testing::force_of(*force, x, testing::zeros(x));
      EXPECT_LT((testing::dense(viscous) - testing::dense(elastic)).dot(testing::dense(v)), -1e-6) << name;
    }
  }
}

TEST(Invariance, ForcesSumToZeroAndTurnNothing) {
  const AllForces all;
  for (unsigned seed = 1; seed <= 3; ++seed) {
    const Positions x = testing::crumpled(kGrid, 0.006, seed), v = testing::random_vectors(x.size(), 1, seed + 10);
    for (const auto& [name, force] : all.list) {
      const Positions f = testing::force_of(*force, x, v);
      Vec3 sum = Vec3::Zero(), torque = Vec3::Zero();
      for (std::size_t i = 0; i < x.size(); ++i) {
        sum += f[i];
        torque += x[i].cross(f[i]);
      }
      // Tolerance: rounding errors of twenty forces, with lever arms of at most 0.12 m for the torque.
      EXPECT_LT(sum.norm(), 1e-13 * testing::largest(f)) << name;
      EXPECT_LT(torque.norm(), 1e-14 * testing::largest(f)) << name;
    }
  }
}

TEST(Invariance, ClothThatIsNotTheFirstPushesItsOwnParticlesOnly) {
  const Stretch stretch(kGrid, 7, {1000, 700, 5});
  const Shear shear(kGrid, 7, {100, 5});
  const Bend bend(kGrid, 7, {1e-3, 1e-4});
  const AllForces own;
  const TriangleMembrane membrane(own.sheet, 7, {1000, 700, 5}, {100, 5});
  const TriangleBend triangle_bend(own.sheet, 7, {1e-3, 1e-4});
  const Positions x = testing::crumpled(kGrid, 0.004, 1), v = testing::random_vectors(x.size(), 1, 4);
  Positions all_x = testing::random_vectors(7, 1, 5), all_v = testing::random_vectors(7, 1, 6);
  all_x.insert(all_x.end(), x.begin(), x.end());
  all_v.insert(all_v.end(), v.begin(), v.end());
  const Force* shifted[] = {&stretch, &shear, &bend, &membrane, &triangle_bend};
  for (std::size_t k = 0; k < 5; ++k) {
    const Positions f = testing::force_of(*shifted[k], all_x, all_v);
    EXPECT_EQ(Positions(f.begin(), f.begin() + 7), Positions(7, Vec3::Zero()));
    EXPECT_EQ(Positions(f.begin() + 7, f.end()), testing::force_of(*own.list[k].second, x, v));
  }
}

TEST(Invariance, MassesAddUpToTheSheetsAndAreHalvedAlongItsBorder) {
  const auto masses = lumped_masses(kGrid, 0.2);
  const double inner = 0.2 * kGrid.lu * kGrid.lv;
  double sum = 0;
  for (double m : masses) sum += m;
  EXPECT_NEAR(sum, 0.2 * (4 * kGrid.lu) * (3 * kGrid.lv), 1e-15);
  EXPECT_DOUBLE_EQ(masses[kGrid.index(2, 1)], inner);
  EXPECT_DOUBLE_EQ(masses[kGrid.index(0, 1)], inner / 2);
  EXPECT_DOUBLE_EQ(masses[kGrid.index(2, 3)], inner / 2);
  EXPECT_DOUBLE_EQ(masses[kGrid.index(4, 3)], inner / 4);
}

}  // namespace
}  // namespace weft::forces
