// Rest shapes of sewn sheets between start and pattern; elastic bands along edges.
#include <gtest/gtest.h>

#include <numeric>

#include "core/archive.hpp"
#include "forces/sheets.hpp"
#include "physics/forces/bands.hpp"

namespace weft::forces {
namespace {

using testing::kGrid;
using testing::Positions;

mesh::Sheet flat_sheet() {
  return mesh::make_sheet_from_mesh(mesh::make_triangle_sheet(kGrid, mesh::Pattern::aligned));
}

TEST(SewnMembranes, HaveNoStressAtTheStartAndThatOfThePatternAtTheEnd) {
  mesh::Sheet sheet = flat_sheet();
  const TriangleMembrane pattern(sheet, 0, {1000, 700, 0}, {100, 0});
  sheet.sewn = true;
  sheet.rest = testing::crumpled(kGrid, 0.008, 3);
  TriangleMembrane sewn(sheet, 0, {1000, 700, 0}, {100, 0});

  const double full = pattern.energy(sheet.rest);
  sewn.interpolate_rest_shape(0);
  // Tolerance of the energy: strains have rounding errors of some 1e-16.
  EXPECT_LT(sewn.energy(sheet.rest), 1e-25 * full);
  EXPECT_LT(testing::largest(testing::force_of(sewn, sheet.rest, testing::zeros(sheet.rest))), 1e-9);
  EXPECT_LT(sewn.max_strain(sheet.rest), 1e-12);

  double before = 0;
  for (double fraction : {0.2, 0.4, 0.6, 0.8, 1.0}) {
    sewn.interpolate_rest_shape(fraction);
    EXPECT_GT(sewn.energy(sheet.rest), before);
    before = sewn.energy(sheet.rest);
  }
  const Positions x = testing::crumpled(kGrid, 0.004, 8);
  EXPECT_EQ(sewn.energy(x), pattern.energy(x));
  EXPECT_EQ(testing::force_of(sewn, x, testing::zeros(x)), testing::force_of(pattern, x, testing::zeros(x)));
}

// The start is twice as long along weft and half as long along warp as the pattern. At the fraction s of the sewing,
// the strain is 2 / (2 − s) − 1 along weft and 0.5 / (0.5 + s / 2) − 1 along warp.
TEST(SewnMembranes, AreStrainedByTheShareOfTheWay) {
  mesh::Sheet sheet = flat_sheet();
  sheet.sewn = true;
  for (Vec3& x : sheet.rest) x = {2 * x.x(), 0.5 * x.y(), 0};
  TriangleMembrane sewn(sheet, 0, {1000, 700, 0}, {100, 0});
  const double area = 4 * 0.02 * 3 * 0.03;
  for (double fraction : {0.25, 0.5, 1.0}) {
    sewn.interpolate_rest_shape(fraction);
    const double weft = 2 / (2 - fraction) - 1, warp = 0.5 / (0.5 + 0.5 * fraction) - 1;
    const double energy = area * (500 * weft * weft + 350 * warp * warp);
    EXPECT_NEAR(sewn.energy(sheet.rest), energy, 1e-12 * energy);
  }
}

// The start is twice as long along weft as the pattern, and something holds it at 1.5 times the pattern.
TEST(SewnMembranes, StayAsWideAsTheirThreadsMustBe) {
  constexpr double kOnset = 0.1, kHeld = 1.5, kStep = 0.01;
  mesh::Sheet sheet = flat_sheet();
  sheet.sewn = true;
  Positions held = sheet.rest;
  for (Vec3& x : held) x.x() *= kHeld;
  for (Vec3& x : sheet.rest) x.x() *= 2;
  TriangleMembrane sewn(sheet, 0, {1000, 700, 0}, {100, 0}), free(sheet, 0, {1000, 700, 0}, {100, 0}), restored = sewn;
  bool ended = false;
  for (int step = 1; step <= 100; ++step) {
    const double progress = step * kStep;
    sewn.interpolate_rest_shape(0.5 * (2 * progress - kStep));  // a half step that is rejected
    sewn.interpolate_rest_shape(progress);
    EXPECT_FALSE(ended);
    ended = sewn.accept_rest_shape(held, kOnset, kStep);
    free.interpolate_rest_shape(progress);
    free.accept_rest_shape(held, 1, kStep);
    if (step != 80) continue;
    ByteWriter saved;
    sewn.serialize_rest_shape(saved, progress);
    ByteReader reader{saved.bytes};
    restored.serialize_rest_shape(reader, progress);
    restored.interpolate_rest_shape(progress);
    EXPECT_EQ(restored.energy(held), sewn.energy(held));
  }
  EXPECT_TRUE(ended);
  EXPECT_FALSE(sewn.accept_rest_shape(held, kOnset, kStep));
  EXPECT_FALSE(sewn.is_catching_up()) << "its threads stay locked";
  // The rest width stops at the value at which the threads begin to lock. Tolerance: two steps. Each of the 100 steps
  // shortens the rest width by 1/100 of the difference between start and pattern, and by at most twice as much.
  EXPECT_NEAR(sewn.max_strain(held), kOnset, 2 * kStep * kHeld);
  EXPECT_NEAR(sewn.widening().fraction, kHeld / (1 + kOnset) - 1, 2 * kStep);
  EXPECT_EQ(free.widening().fraction, 0);
  EXPECT_NEAR(free.max_strain(held), kHeld - 1, 1e-12);
}

// One particle inside the sheet is held 30 % of a cell beside its place in the pattern, so that only triangles on one
// side of it lock.
TEST(SewnMembranes, AreNotReportedWiderForSingleTriangles) {
  constexpr double kOnset = 0.1, kStep = 0.01;
  mesh::Sheet sheet = flat_sheet();
  sheet.sewn = true;
  Positions held = sheet.rest;
  held[static_cast<std::size_t>(kGrid.index(2, 1))].x() += 0.3 * kGrid.du(1);
  for (Vec3& x : sheet.rest) x.x() *= 2;
  TriangleMembrane sewn(sheet, 0, {1000, 700, 0}, {100, 0}), free = sewn;
  for (int step = 1; step <= 100; ++step) {
    sewn.interpolate_rest_shape(step * kStep);
    sewn.accept_rest_shape(held, kOnset, kStep);
    free.interpolate_rest_shape(step * kStep);
    free.accept_rest_shape(held, 1, kStep);
  }
  EXPECT_LT(sewn.energy(held), 0.9 * free.energy(held)) << "some triangles are wider than in the pattern";
  EXPECT_EQ(sewn.widening().fraction, 0);
}

TEST(SewnMembranes, MakeUpForTheTimeInWhichTheyWereStopped) {
  mesh::Sheet sheet = flat_sheet();
  sheet.sewn = true;
  Positions held = sheet.rest;
  for (Vec3& x : sheet.rest) x.x() *= 2;
  for (Vec3& x : held) x.x() *= 2;
  TriangleMembrane sewn(sheet, 0, {1000, 700, 0}, {100, 0});
  for (const double progress : {0.2, 0.4, 0.6, 0.8, 1.0}) {
    sewn.interpolate_rest_shape(progress);
    sewn.accept_rest_shape(held, progress < 0.5 ? 0.1 : 10, 0.2);
    if (progress == 0.4) {
      EXPECT_NEAR(sewn.widening().fraction, 0.8, 1e-12);
    }
  }
  EXPECT_EQ(sewn.widening().fraction, 0);
  EXPECT_NEAR(sewn.max_strain(held), 1, 1e-12);
}

// Something holds the cloth at the width of its start until the sewing has ended, and then releases it.
TEST(SewnMembranes, CatchUpAfterTheSewingOnceTheirThreadsAreReleased) {
  constexpr double kOnset = 0.1, kStep = 0.25;
  mesh::Sheet sheet = flat_sheet();
  sheet.sewn = true;
  const Positions released = sheet.rest;
  for (Vec3& x : sheet.rest) x.x() *= 2;
  TriangleMembrane sewn(sheet, 0, {1000, 700, 0}, {100, 0});
  for (const double progress : {0.25, 0.5, 0.75, 1.0}) {
    sewn.interpolate_rest_shape(progress);
    EXPECT_EQ(sewn.accept_rest_shape(sheet.rest, kOnset, kStep), progress == 1);
  }
  EXPECT_NEAR(sewn.widening().fraction, 0.75, 1e-12);
  EXPECT_FALSE(sewn.is_catching_up()) << "its threads are locked";
  sewn.accept_rest_shape(released, kOnset, kStep);
  for (const double left : {0.5, 0.25, 0.0}) {
    EXPECT_TRUE(sewn.is_catching_up());
    EXPECT_FALSE(sewn.accept_rest_shape(released, kOnset, kStep)) << "the sewing has ended before";
    sewn.interpolate_rest_shape(1);
    EXPECT_NEAR(sewn.widening().fraction, left, 1e-12);
    EXPECT_NEAR(sewn.max_strain(released), 1 - 1 / (1 + left), 1e-12);
  }
  EXPECT_FALSE(sewn.is_catching_up());
}

// The start is half as long along weft as the pattern, and something holds it at the length of the pattern.
TEST(SewnMembranes, AreNotStoppedBeforeTheyAreAsWideAsTheirPattern) {
  mesh::Sheet sheet = flat_sheet();
  sheet.sewn = true;
  const Positions held = sheet.rest;
  for (Vec3& x : sheet.rest) x.x() *= 0.5;
  TriangleMembrane sewn(sheet, 0, {1000, 700, 0}, {100, 0});
  for (const double progress : {0.2, 0.4, 0.6, 0.8, 1.0}) {
    sewn.interpolate_rest_shape(progress);
    EXPECT_NEAR(sewn.max_strain(held), 1 / (0.5 + 0.5 * progress) - 1, 1e-12);
    sewn.accept_rest_shape(held, 0.1, 0.2);
  }
}

TEST(ElasticBands, PullWithTheirStiffnessTimesStrain) {
  mesh::Sheet sheet = flat_sheet();
  sheet.bands.push_back({{0, 1, 2}, {0.02, 0.02}, 0.8, 50, 0, 0, 0});
  const Bands bands(sheet, 0, 1000);
  const Positions f = testing::force_of(bands, sheet.rest, testing::zeros(sheet.rest));
  // Each piece of the band is 20 mm long, and 16 mm at rest: the strain is 0.25, and the force 50 N · 0.25.
  EXPECT_NEAR(f[0].x(), 12.5, 1e-12);
  EXPECT_NEAR(f[1].norm(), 0, 1e-12);
  EXPECT_NEAR(f[2].x(), -12.5, 1e-12);
}

TEST(SeamAllowances, AreStripsOfTheCloth) {
  mesh::Sheet sheet = flat_sheet();
  const auto plain = lumped_masses(sheet, 0.2);
  sheet.bands.push_back({{0, 1, 2}, {0.02, 0.02}, 1, 0, 0, 0, 0.03});
  const auto masses = lumped_masses(sheet, 0.2);
  EXPECT_NEAR(masses[1] - plain[1], 0.2 * 0.03 * 0.02, 1e-15);
  const Bands bands(sheet, 0, 1000);
  for (Vec3& x : sheet.rest) x *= 1.1;
  EXPECT_NEAR(testing::force_of(bands, sheet.rest, testing::zeros(sheet.rest))[0].x(), 1000 * 0.03 * 0.1, 1e-12);
}

TEST(ElasticBands, OfSewnSheetsPullNothingAtTheStart) {
  mesh::Sheet sheet = flat_sheet();
  sheet.bands.push_back({{0, 1, 2}, {0.02, 0.02}, 0.8, 50, 0, 0, 0});
  sheet.sewn = true;
  for (Vec3& x : sheet.rest) x *= 1.7;
  Bands bands(sheet, 0, 1000);
  bands.interpolate_rest_shape(0);
  EXPECT_EQ(bands.energy(sheet.rest), 0);
  bands.interpolate_rest_shape(1);
  const double strain = 1.7 / 0.8 - 1;
  EXPECT_NEAR(bands.energy(sheet.rest), 2 * 0.5 * 50 * 0.016 * strain * strain, 1e-12);
}

// A hem of length L and bending stiffness E, bent to a circle of radius R, has the energy ½ E L / R².
TEST(Hems, ResistBendingAsRods) {
  mesh::Sheet sheet = flat_sheet();
  const int pieces = 40;
  const double length = 0.4, radius = 0.3, stiffness = 1e-3;
  mesh::Band band;
  Positions x;
  for (Index k = 0; k <= pieces; ++k) {
    band.vertices.push_back(k);
    if (k > 0) band.lengths.push_back(length / pieces);
    const double angle = k * length / pieces / radius;
    x.emplace_back(radius * std::sin(angle), 0, radius * (1 - std::cos(angle)));
  }
  band.bend = stiffness;
  sheet.bands.push_back(band);
  const Bands bands(sheet, 0, 1000);
  const double inner = length * (pieces - 1) / pieces;  // only inner particles have curvature
  EXPECT_NEAR(bands.energy(x), 0.5 * stiffness * inner / (radius * radius), 1e-3 * bands.energy(x));
}

TEST(Hems, AddTheirMass) {
  mesh::Sheet sheet = flat_sheet();
  const auto plain = lumped_masses(sheet, 0.2);
  sheet.bands.push_back({{0, 1, 2, 3, 4}, {0.02, 0.02, 0.02, 0.02}, 1, 0, 0.05, 0, 0});
  const auto hemmed = lumped_masses(sheet, 0.2);
  EXPECT_NEAR(hemmed[0] - plain[0], 0.05 * 0.01, 1e-15);
  EXPECT_NEAR(hemmed[2] - plain[2], 0.05 * 0.02, 1e-15);
  EXPECT_EQ(hemmed[7], plain[7]);
  EXPECT_NEAR(std::accumulate(plain.begin(), plain.end(), 0.0), 0.2 * 0.08 * 0.09, 1e-15);
}

}  // namespace
}  // namespace weft::forces
