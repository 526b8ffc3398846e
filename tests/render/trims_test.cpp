// Hems, seams and edges of cloth.
#include "film/render/trims.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "render/scaled_pictures.hpp"
#include "render/snapshots.hpp"

namespace weft::render {
namespace {

/// A sheet of n x n squares of two triangles each, 1 m wide. `parts`: the right half is a panel of its own.
frame::Surface sheet(int n, bool parts) {
  frame::Surface surface;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) surface.uv.emplace_back(static_cast<double>(i) / n, static_cast<double>(j) / n);
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const Index a = j * (n + 1) + i, b = a + 1, c = b + n + 1, d = a + n + 1;
      surface.triangles.insert(surface.triangles.end(), {{a, b, c}, {a, c, d}});
      if (parts) surface.part_of_triangle.insert(surface.part_of_triangle.end(), 2, 2 * i < n ? 0 : 1);
    }
  }
  if (parts) surface.parts.resize(2);
  return surface;
}

TEST(Trims, AreDistancesFromBordersAndSeams) {
  const frame::Surface surface = sheet(8, true);
  const Trims trims(surface);
  for (std::size_t v = 0; v < surface.uv.size(); ++v) {
    const Vec2 at = surface.uv[v];
    const Trim trim = trims.at(static_cast<Index>(v));
    EXPECT_NEAR(trim.from_border(), std::min({at.x(), at.y(), 1 - at.x(), 1 - at.y()}), 1e-6) << at.transpose();
    EXPECT_NEAR(trim.distance[Trim::seam], std::abs(at.x() - 0.5), 1e-6) << at.transpose();
  }
  // From (1/8, 0) to (0, 1/8), across a corner: both ends are on the border, the middle is 1/16 away from it.
  const Trim corner = trims.middle(0 + 1, 9);
  EXPECT_NEAR(corner.from_border(), 1.0 / 16, 1e-6);
  EXPECT_EQ(trims.rims().size(), 4U * 8);
}

TEST(Trims, PlacesAlongABorderGoOnFromEdgeToEdge) {
  const frame::Surface surface = sheet(8, false);
  const Trims trims(surface);
  int jumps = 0;
  for (const auto& [a, b, triangle] : trims.rims()) {
    const Trim from = trims.at(a), to = trims.at(b);
    const int kind =
        from.distance[Trim::border] + to.distance[Trim::border] < 1e-9f ? Trim::border : Trim::other_border;
    EXPECT_EQ(from.distance[kind] + to.distance[kind], 0);
    EXPECT_EQ(trims.at(a).distance[Trim::seam], kNoTrim);
    const float apart = std::abs(to.along[kind] - from.along[kind]);
    if (std::abs(apart - 0.125f) > 1e-5f) ++jumps;
  }
  EXPECT_EQ(jumps, 0) << "as each side has places of its own";
}

// Cells are three times as wide as high, so near a corner the nearest border changes within triangles. In a triangle,
// the distance from each pair of opposite borders is linear, so the minimum of both distances is exact everywhere.
TEST(Trims, LinesTurnSharplyAtCorners) {
  frame::Surface surface = sheet(6, false);
  for (Vec2& at : surface.uv) at.x() *= 3;
  const Trims trims(surface);
  for (const Triangle& triangle : surface.triangles) {
    for (int k = 0; k < 3; ++k) {
      const std::array<double, 3> shares = {0.7, 0.2, 0.1};
      Vec2 at = Vec2::Zero();
      std::array<double, 2> distance{};
      for (int c = 0; c < 3; ++c) {
        const Index vertex = triangle[(k + c) % 3];
        at += shares[c] * surface.uv[vertex];
        for (int kind = 0; kind < 2; ++kind) distance[kind] += shares[c] * trims.at(vertex).distance[kind];
      }
      const double from_sides = std::min(at.x(), 3 - at.x()), from_ends = std::min(at.y(), 1 - at.y());
      const double expected = std::min(from_sides, from_ends);
      if (expected > 1.0 / 6) continue;
      EXPECT_NEAR(std::min(distance[0], distance[1]), expected, 1e-6) << at.transpose();
    }
  }
}

// At a vertex of a line, two edges of this line are equally near. Their order must not matter, so the triangles are
// tested in several orders.
TEST(Trims, LinesGoOnThroughTheMiddlesOfTheirEdges) {
  frame::Surface surface = sheet(8, true);
  for (const std::size_t stride : {5U, 11U, 37U}) {
    std::vector<Triangle> shuffled;
    std::vector<std::int32_t> parts;
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
      shuffled.push_back(surface.triangles[t * stride % surface.triangles.size()]);
      parts.push_back(surface.part_of_triangle[t * stride % surface.triangles.size()]);
    }
    surface.triangles = shuffled;
    surface.part_of_triangle = parts;
    const Trims trims(surface);
    for (const Triangle& triangle : surface.triangles) {
      for (int k = 0; k < 3; ++k) {
        const Index a = triangle[k], b = triangle[(k + 1) % 3];
        const Vec2 at = 0.5 * (surface.uv[a] + surface.uv[b]);
        const Trim trim = trims.middle(a, b);
        EXPECT_NEAR(trim.from_border(), std::min({at.x(), at.y(), 1 - at.x(), 1 - at.y()}), 1e-6) << at.transpose();
        EXPECT_NEAR(trim.distance[Trim::seam], std::abs(at.x() - 0.5), 1e-6) << at.transpose();
      }
    }
  }
}

// A dart joins two triangles that are apart in the drawing of one panel.
TEST(Trims, DartsAreSeams) {
  frame::Surface surface = sheet(2, true);
  surface.part_of_triangle.assign(surface.triangles.size(), 0);
  for (const Triangle& t : surface.triangles)
    surface.paint_uv.push_back({surface.uv[t[0]], surface.uv[t[1]], surface.uv[t[2]]});
  EXPECT_EQ(Trims(surface).at(4).distance[Trim::seam], kNoTrim);
  // In the drawing, the right cell of the lower row moves right by 0.1, except for vertex 4 in the middle of the sheet.
  for (std::size_t t : {2, 3})
    for (std::size_t k = 0; k < 3; ++k)
      if (surface.triangles[t][k] != 4) surface.paint_uv[t][k].x() += 0.1;
  const Trims trims(surface);
  EXPECT_NEAR(trims.at(1).distance[Trim::seam], 0, 1e-9);
  EXPECT_NEAR(trims.at(4).distance[Trim::seam], 0, 1e-9);
  EXPECT_NEAR(trims.at(0).distance[Trim::seam], 0.5, 1e-6);
  EXPECT_NEAR(trims.at(7).distance[Trim::seam], 0.5, 1e-6);
}

TEST(Trims, AStripAlongTheBorderFacesOutwardAndIsAsThickAsTheCloth) {
  const frame::Surface surface = sheet(3, false);
  std::vector<Vec3> positions;
  for (const Vec2& at : surface.uv) positions.emplace_back(at.x(), at.y(), 0);
  const std::vector<Vec3> normals(positions.size(), Vec3::UnitZ());
  const Trims trims(surface);
  const RimStrip strip = rim_strip(trims.rims(), positions, normals, 0.01);
  ASSERT_EQ(strip.triangles.size(), 2U * 12);
  double area = 0;
  for (const auto& [a, b, c] : strip.triangles) {
    const Vec3 middle = (strip.positions[a] + strip.positions[b] + strip.positions[c]) / 3;
    const Vec3 normal = (strip.positions[b] - strip.positions[a]).cross(strip.positions[c] - strip.positions[a]);
    EXPECT_GT(normal.dot(middle - Vec3(0.5, 0.5, middle.z())), 0);
    EXPECT_LE(middle.z(), 0);
    area += 0.5 * normal.norm();
  }
  EXPECT_NEAR(area, 4 * 0.01, 1e-12);
}

/// Cloth that fills the picture, tilted back by 50 degrees. A line of stitches is vertical in its middle (a seam) or
/// horizontal.
frame::FrameSnapshot sewn_cloth(double distance, bool seam, Threads threads = Threads::plain) {
  frame::FrameSnapshot snapshot;
  snapshot.stage = stage_without_sky();
  const double angle = 50 * std::numbers::pi / 180, half = 10;
  frame::Surface grid = sheet(2, seam);
  const Vec3 up(0, std::sin(angle), std::cos(angle));
  std::vector<Vec3> positions;
  for (Vec2& at : grid.uv) {
    at *= 2 * half;
    positions.push_back((at.x() - half) * Vec3::UnitX() + (at.y() - half) * up);
  }
  frame::Surface& cloth = add_surface(snapshot, frame::ObjectKind::cloth, positions, grid.triangles);
  cloth.uv = grid.uv;
  cloth.parts = grid.parts;
  cloth.part_of_triangle = grid.part_of_triangle;
  cloth.appearance.color = cloth.appearance.back_color = Vec3(0.6, 0.4, 0.3);
  cloth.appearance.finish.threads = threads;
  for (frame::SurfacePart& part : cloth.parts) part.appearance = cloth.appearance;
  cloth.appearance.thickness = 1e-3;
  cloth.appearance.hem = seam ? 0 : half - 0.008;  // puts the stitches 1 cm from the middle, on both sides
  snapshot.cameras = {camera_at(Vec3(0, -distance, 0), Vec3::Zero(), 30)};
  snapshot.lights = {sun(Vec3::UnitY())};
  return snapshot;
}

TEST(Trims, StitchesShowCloseByAndInFinalQualityOnly) {
  for (const bool seam : {false, true}) {
    const image::Image close = drawn(sewn_cloth(0.1, seam), 1);
    int darkest = 255, palest = 0;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        darkest = std::min<int>(darkest, close.pixel(x, y)[1]);
        palest = std::max<int>(palest, close.pixel(x, y)[1]);
      }
    }
    EXPECT_GT(palest - darkest, 25) << seam;
    const image::Image preview = drawn(sewn_cloth(0.1, seam), 1, Quality::preview);
    EXPECT_LE(std::abs(preview.pixel(80, 50)[1] - preview.pixel(20, 20)[1]), 4);
  }
}

/// Counts the dark lines across the middle of a picture.
int dark_lines(const image::Image& image) {
  const auto level = [&](int y) {
    double sum = 0;
    for (int x = 40; x < 120; ++x) sum += image.pixel(x, y)[1];
    return sum / 80;
  };
  int lines = 0;
  for (int y = 5; y < 95; ++y) {
    // Light varies by less than a level over five pixels; a row of stitches darkens by five levels or more.
    const bool is_minimum = level(y) < level(y - 1) && level(y) <= level(y + 1);
    if (is_minimum && level(y) < std::min(level(y - 5), level(y + 5)) - 2) ++lines;
  }
  return lines;
}

// One hem is above the middle, one below. Each has one row of stitches in woven cloth, and two rows in a knit.
TEST(Trims, KnitsAreHemmedInTwoRows) {
  EXPECT_EQ(dark_lines(drawn(sewn_cloth(0.08, false), 1)), 2);
  EXPECT_EQ(dark_lines(drawn(sewn_cloth(0.08, false, Threads::knit), 1)), 4);
}

TEST(Trims, ThreadOfDenimHasAColorOfItsOwn) {
  const auto reddest = [](Threads threads) {
    const image::Image image = drawn(sewn_cloth(0.08, true, threads), 1);
    int most = 0;
    for (int y = 5; y < 95; ++y)
      for (int x = 40; x < 120; ++x) most = std::max(most, image.pixel(x, y)[0] - image.pixel(x, y)[2]);
    return most;
  };
  // The cloth has 0.3 more red than blue, and so has its default thread; the thread of denim has 0.55 more.
  EXPECT_GT(reddest(Threads::denim), reddest(Threads::twill) + 20);
}

// Light comes from one side of a seam that is oblique to the columns of pixels. If the slope of the seam's groove were
// computed for each pair of pixels, the groove would look like bright and dark dashes.
TEST(Trims, SeamsOfFewPixelsAreLinesWithoutDashes) {
  for (const double distance : {0.15, 0.25, 0.35}) {
    frame::FrameSnapshot snapshot = sewn_cloth(distance, true);
    const Eigen::AngleAxisd slant(0.15, Vec3::UnitY());
    for (Vec3& position : snapshot.states[0].positions) position = slant * position;
    snapshot.lights = {sun(Vec3(1, 1, 0))};
    const image::Image image = drawn(snapshot, 1);
    int palest = 0, palest_beside = 0;
    for (int y = 10; y < 90; ++y) {
      const int seam = static_cast<int>(80 + std::tan(0.15) * (50 - y));
      for (int x = seam - 14; x < seam + 14; ++x) {
        int& level = std::abs(x - seam) < 4 ? palest : palest_beside;
        level = std::max<int>(level, image.pixel(x, y)[1]);
      }
    }
    EXPECT_LE(palest, palest_beside + 3) << distance;
  }
}

// At any distance, a line of stitches must equal the mean of a picture of six times the resolution. Measured
// difference: 0.4 to 1.1 levels; without filtering of lines, 4.6.
TEST(Trims, StitchesHaveNoBeats) {
  constexpr int kFiner = 6;
  for (double distance = 0.26; distance < 21; distance *= 2.62) {
    const frame::FrameSnapshot snapshot = sewn_cloth(distance, true);
    const image::Image image = drawn(snapshot, 1), finer = drawn(snapshot, kFiner);
    double squares = 0, farthest = 0;
    int count = 0;
    // Compare within four pixels of the line.
    for (int y = 10; y < 90; ++y) {
      for (int x = 76; x < 84; ++x) {
        const double off = image.pixel(x, y)[1] - mean(finer, kFiner * x, kFiner * y, kFiner);
        squares += off * off;
        farthest = std::max(farthest, std::abs(off));
        ++count;
      }
    }
    EXPECT_LT(std::sqrt(squares / count), 2) << distance << ' ' << farthest;
  }
}

/// Two dark panels side by side before the bright backdrop, with a vertical slit of `gap` [m] between them, which is a
/// zip. The zip is closed up to a gap of 6 mm.
frame::FrameSnapshot zipped_cloth(double gap) {
  frame::FrameSnapshot snapshot;
  snapshot.stage = stage_without_sky();
  std::vector<Vec3> positions;
  for (const double z : {-0.5, 0.0, 0.5})
    for (const double x : {-0.5, -0.5 * gap, 0.5 * gap, 0.5}) positions.emplace_back(x, 0, z);
  std::vector<Triangle> triangles;
  for (const Index a : {0, 2, 4, 6}) {
    triangles.push_back({a, a + 1, a + 5});
    triangles.push_back({a, a + 5, a + 4});
  }
  frame::Surface& cloth = add_surface(snapshot, frame::ObjectKind::cloth, positions, triangles);
  cloth.closures = {{{1, 2}, {5, 6}, {9, 10}}};
  cloth.max_closed_gap = 0.006;
  cloth.appearance.color = cloth.appearance.back_color = Vec3::Constant(0.2);
  cloth.appearance.thickness = 1e-3;
  snapshot.cameras = {camera_at(Vec3(0, -0.3, 0), Vec3::Zero(), 30)};
  snapshot.lights = {sun(Vec3::UnitY())};
  return snapshot;
}

TEST(Trims, ClosedZipsShowNoLight) {
  const auto brightest = [](double gap, Quality quality) {
    const image::Image image = drawn(zipped_cloth(gap), 1, quality);
    int level = 0;
    for (int y = 10; y < 90; ++y)
      for (int x = 40; x < 120; ++x) level = std::max<int>(level, image.pixel(x, y)[1]);
    return level;
  };
  for (const Quality quality : {Quality::draft, Quality::final}) {
    EXPECT_LT(brightest(0.003, quality), 80);
    EXPECT_GT(brightest(0.008, quality), 150) << "open";
  }
}

}  // namespace
}  // namespace weft::render
