#include "film/render/outlines.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "film/render/painted_mesh.hpp"

namespace weft::render {
namespace {

constexpr int kOutlinedWidth = 96, kOutlinedHeight = 64;
constexpr std::uint64_t kWhite = 0xFFFFFFFFFFFF, kBlack = 0;

/// A view along +y from the origin. At a distance of 1 m, half of its width is 1 m: a pixel is a 48th of the distance.
View test_view() {
  View view;
  view.axes = view_axes(Vec3::UnitY(), Vec3::UnitZ());
  view.tan_half_width = 1;
  view.tan_half_height = static_cast<double>(kOutlinedHeight) / kOutlinedWidth;
  view.near = 0.1;
  view.view_from_world = look_along(view.eye, view.axes);
  view.clip_from_world = perspective(1, view.tan_half_height, view.near) * view.view_from_world;
  return view;
}

/// World position that appears at (x, y) in the picture [pixels from the lower left corner], at this distance along the
/// view axis [m].
Vec3 seen_at(double x, double y, double distance) {
  return distance *
         Vec3(2 * x / kOutlinedWidth - 1, 1, (2 * y / kOutlinedHeight - 1) * kOutlinedHeight / kOutlinedWidth);
}

/// A mesh of one flat colour.
struct Thing {
  std::vector<Vec3> positions;
  std::vector<Triangle> triangles;
  std::uint64_t color;
};

/// Things, and the pixels that they cover: distances, surfaces and colours, without antialiasing at first.
struct Scene {
  std::vector<Thing> things;
  std::vector<Seen> seen = std::vector<Seen>(kOutlinedWidth * kOutlinedHeight, Seen{100, kNothing});
  std::vector<std::uint64_t> picture = std::vector<std::uint64_t>(kOutlinedWidth * kOutlinedHeight, kBlack);

  /// Adds a thing. Its pixels are those for whose centres covers(x, y) is true. `back`: 0.5 if they show its back.
  template <class Covers>
  void add(const Thing& thing, float distance, const Covers& covers, float back = 0) {
    things.push_back(thing);
    for (int y = 0; y < kOutlinedHeight; ++y) {
      for (int x = 0; x < kOutlinedWidth; ++x) {
        if (!covers(x + 0.5, y + 0.5)) continue;
        seen[y * kOutlinedWidth + x] = {distance, static_cast<float>(kFirstSurface + things.size() - 1) + back};
        picture[y * kOutlinedWidth + x] = thing.color;
      }
    }
  }
  /// Returns what antialiased the picture.
  Outlines antialias(const std::optional<Floor>& floor = std::nullopt) {
    std::vector<DrawnMesh> meshes;
    for (const Thing& thing : things) meshes.push_back({thing.positions, thing.triangles});
    Outlines outlines(kOutlinedWidth, kOutlinedHeight);
    outlines.antialias(seen, meshes, floor, test_view(), {0, 0, kOutlinedWidth, kOutlinedHeight}, picture);
    return outlines;
  }
  int red(int x, int y) const { return static_cast<int>((picture[y * kOutlinedWidth + x] & 0xFFFF) / 257); }
};

const std::vector<Triangle> kQuad = {{0, 1, 2}, {0, 2, 3}};

Thing quad(double x0, double y0, double x1, double y1, double distance, std::uint64_t color) {
  return {{seen_at(x0, y0, distance), seen_at(x1, y0, distance), seen_at(x1, y1, distance), seen_at(x0, y1, distance)},
          kQuad,
          color};
}

// Each pixel has sixteen samples, no two of them in the same sixteenth of its width. For a vertical edge at any
// position, the covered fraction is thus exact to half a sample. The sum of the fractions over a row is the width of
// the quad.
TEST(Outlines, EdgePixelsShowTheirCoveredShareToHalfASample) {
  for (const double edge : {20.0625, 20.3, 20.5, 20.8, 21.0}) {
    Scene scene;
    scene.add(quad(10, 10, edge, 50, 2, kWhite), 2,
              [&](double x, double y) { return x > 10 && x < edge && y > 10 && y < 50; });
    scene.antialias();
    double sum = 0;
    for (int x = 0; x < kOutlinedWidth; ++x) sum += scene.red(x, 30) / 255.0;
    EXPECT_NEAR(sum, edge - 10, 1.0 / 32 + 0.01) << edge;
    EXPECT_EQ(scene.red(15, 30), 255);
    EXPECT_EQ(scene.red(30, 30), 0);
  }
}

// Two sheets, 0.5 mm apart, at a distance of 2 m. The difference of 1 / distance is too small to reveal an outline, but
// the numbers of the surfaces differ.
TEST(Outlines, BorderOfASheetOnAnotherIsSmoothed) {
  Scene scene;
  scene.add(quad(0, 0, kOutlinedWidth, kOutlinedHeight, 2.0005, 0x404040404040), 2.0005f,
            [](double, double) { return true; });
  // The border of the sheet rises by one pixel in eight columns.
  const auto border = [](double x) { return 20 + x / 8; };
  const Thing sheet{{seen_at(0, 0, 2), seen_at(kOutlinedWidth, 0, 2),
                     seen_at(kOutlinedWidth, border(kOutlinedWidth), 2), seen_at(0, border(0), 2)},
                    kQuad,
                    kWhite};
  scene.add(sheet, 2, [&](double x, double y) { return y < border(x); });
  scene.antialias();
  // Each column is covered up to the height [pixels] of the border at its middle. Tolerance: about one sample of 16.
  for (int x = 8; x < 88; ++x) {
    double covered = 0;
    for (int y = 0; y < kOutlinedHeight; ++y) covered += (scene.red(x, y) - 64) / 191.0;
    EXPECT_NEAR(covered, border(x + 0.5), 0.07) << x;
  }
}

TEST(Outlines, TheBackOfASheetEndsAgainstItsFront) {
  // A sheet that is folded at x = 40.5. Both sides of the fold are the same surface at the same distance, but the right
  // side shows its back.
  Scene scene;
  Thing folded{{seen_at(10, 10, 2), seen_at(40.5, 10, 2), seen_at(40.5, 50, 2), seen_at(10, 50, 2)},
               {{0, 1, 2}, {0, 2, 3}},
               kWhite};
  folded.positions.insert(folded.positions.end(), {seen_at(70, 10, 2), seen_at(70, 50, 2)});
  folded.triangles.insert(folded.triangles.end(), {{4, 1, 2}, {4, 2, 5}});
  scene.add(folded, 2, [](double x, double y) { return x > 10 && x < 70 && y > 10 && y < 50; });
  for (int y = 10; y < 50; ++y) {
    for (int x = 41; x < 70; ++x) {
      scene.seen[y * kOutlinedWidth + x].surface += 0.5f;
      scene.picture[y * kOutlinedWidth + x] = kBlack;
    }
  }
  scene.antialias();
  EXPECT_NEAR(scene.red(40, 30), 128, 1);
  EXPECT_EQ(scene.red(39, 30), 255);
  EXPECT_EQ(scene.red(41, 30), 0);
}

// A quad that covers the whole picture is split into triangles along a line through a sample, at many angles. In spite
// of rounding, the sample must belong to one of the triangles.
TEST(Outlines, SampleOnACutBetweenTrianglesBelongsToOneOfThem) {
  const double x = 48 + 19 / 32.0, y = 32 + 19 / 32.0;
  for (int i = 0; i < 300; ++i) {
    const double angle = 2 * std::numbers::pi * i / 300, across = 300 * std::cos(angle), along = 300 * std::sin(angle);
    Scene scene;
    const Thing cut{{seen_at(x - across, y - along, 2), seen_at(x + along, y - across, 2),
                     seen_at(x + across, y + along, 2), seen_at(x - along, y + across, 2)},
                    kQuad,
                    kWhite};
    scene.add(cut, 2, [](double, double) { return true; });
    // The black pixel (49, 32) is at another distance, so pixel (48, 32) beside it gets samples. A sample that belonged
    // to no triangle would be black.
    scene.seen[32 * kOutlinedWidth + 49] = {100, kNothing};
    scene.picture[32 * kOutlinedWidth + 49] = kBlack;
    scene.antialias();
    EXPECT_EQ(scene.red(48, 32), 255) << i;
  }
}

TEST(Outlines, NearerHidesFartherInEitherOrder) {
  for (const bool near_first : {true, false}) {
    Scene scene;
    const auto near = [&] {
      scene.add(quad(10, 10, 40.25, 50, 1, kWhite), 1,
                [](double x, double y) { return x > 10 && x < 40.25 && y > 10 && y < 50; });
    };
    const auto far = [&] {
      scene.add(quad(0, 0, kOutlinedWidth, kOutlinedHeight, 2, 0x404040404040), 2,
                [&](double x, double y) { return !near_first || x < 10 || x > 40.25 || y < 10 || y > 50; });
    };
    if (near_first) near();
    far();
    if (!near_first) near();
    scene.antialias();
    EXPECT_NEAR(scene.red(40, 30), 64 + 191 / 4, 1) << near_first;
    EXPECT_EQ(scene.red(39, 30), 255);
    EXPECT_EQ(scene.red(41, 30), 64);
  }
}

// Two sides of a box, white and grey, meet in a vertical edge. They are the same surface and have the same distance at
// the edge. The second edge passes 0.01 pixels beside the centre of a pixel, which is thus near the planes of both
// sides.
TEST(Outlines, SidesOfAnEdgeKeepTheirColors) {
  for (const auto& [edge, white_samples] : {std::pair(40.25, 4), std::pair(40.51, 8)}) {
    Scene scene;
    const Thing box{{seen_at(10, 10, 3), seen_at(edge, 10, 2), seen_at(edge, 50, 2), seen_at(10, 50, 3),
                     seen_at(80, 10, 3), seen_at(80, 50, 3)},
                    {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}},
                    kWhite};
    scene.add(box, 2, [](double x, double y) { return x > 10 && x < 80 && y > 10 && y < 50; });
    for (int y = 10; y < 50; ++y) {
      for (int x = 10; x < 80; ++x) {
        const double center = x + 0.5,
                     fraction = center < edge ? (center - 10) / (edge - 10) : (80 - center) / (80 - edge);
        // 1 / distance is linear over the picture of each side.
        scene.seen[y * kOutlinedWidth + x].distance =
            static_cast<float>(1 / (1 / 3.0 + fraction * (1 / 2.0 - 1 / 3.0)));
        if (center > edge) scene.picture[y * kOutlinedWidth + x] = 0x404040404040;
      }
    }
    scene.antialias();
    EXPECT_EQ(scene.red(39, 30), 255) << edge;
    EXPECT_NEAR(scene.red(40, 30), 64 + 191 * white_samples / 16, 1) << edge;
    EXPECT_EQ(scene.red(41, 30), 64) << edge;
  }
}

TEST(Outlines, WhatReachesBehindTheViewerIsCutOff) {
  // A strip on the ground, 1 m below the viewer. It begins behind the viewer and covers the lower part of the picture.
  Scene scene;
  const Thing strip{{Vec3(-50, -5, -1), Vec3(50, -5, -1), Vec3(50, 3.2, -1), Vec3(-50, 3.2, -1)}, kQuad, kWhite};
  // The strip ends 3.2 m in front of the viewer: 48 / 3.2 = 15 pixels below the middle, above row 16.
  for (int y = 0; y < 17; ++y) {
    const float distance = static_cast<float>(1 / ((32 - y - 0.5) / 48));
    for (int x = 0; x < kOutlinedWidth; ++x) {
      scene.seen[y * kOutlinedWidth + x] = {distance, kFirstSurface};
      scene.picture[y * kOutlinedWidth + x] = kWhite;
    }
  }
  scene.things.push_back(strip);
  scene.antialias();
  for (int x = 0; x < kOutlinedWidth; ++x) {
    EXPECT_EQ(scene.red(x, 16), 255);
    EXPECT_EQ(scene.red(x, 17), 0);
  }
}

// The same strip as lace: a picture makes its right half transparent.
TEST(Outlines, LaceThatReachesBehindTheViewerIsCutOff) {
  const std::vector<Vec3> strip = {Vec3(-50, -5, -1), Vec3(50, -5, -1), Vec3(50, 3.2, -1), Vec3(-50, 3.2, -1)};
  constexpr int kTexels = 64, kMiddle = kOutlinedWidth / 2;
  frame::Texture lace{kTexels, 1, {}};
  for (int x = 0; x < kTexels; ++x)
    lace.rgba.insert(lace.rgba.end(), {255, 255, 255, static_cast<std::uint8_t>(x < kTexels / 2 ? 255 : 0)});
  std::vector<MipLevel> levels{base_mip_level(lace, false)};
  while (levels.back().width > 1) levels.push_back(next_mip_level(levels.back()));
  frame::Appearance look;
  look.paint.texture_from_uv << 0.5, 0, 0.5, 0, 0, 0.5;  // the picture is 2 m wide, around x = 0
  PaintedMesh painted;
  for (const Vec3& position : strip) painted.places.emplace_back(static_cast<float>(position.x()), 0.0f);
  painted.ranges = {{0, kQuad.size(), &look}};
  const Opacity opacity(levels, frame::Paint::Wrap::clamp, frame::Paint::Wrap::clamp);
  const Holes holes(painted, {&opacity});
  Scene scene;
  for (int y = 0; y < 17; ++y) {
    for (int x = 0; x < kMiddle; ++x) {
      scene.seen[y * kOutlinedWidth + x] = {static_cast<float>(1 / ((32 - y - 0.5) / 48)), kFirstSurface};
      scene.picture[y * kOutlinedWidth + x] = kWhite;
    }
  }
  const std::vector<DrawnMesh> meshes = {{strip, kQuad, &holes}};
  Outlines(kOutlinedWidth, kOutlinedHeight)
      .antialias(scene.seen, meshes, std::nullopt, test_view(), {0, 0, kOutlinedWidth, kOutlinedHeight}, scene.picture);
  for (int x = 0; x < kMiddle - 1; ++x) {
    EXPECT_GE(scene.red(x, 16), 239) << x << ": at most one of 16 samples may be between two triangles";
    EXPECT_EQ(scene.red(x, 17), 0) << x;
  }
  // The interpolated opacity falls over half a pixel around the middle.
  for (int y = 0; y < 16; ++y) {
    EXPECT_GT(scene.red(kMiddle - 1, y), 180) << y;
    EXPECT_LT(scene.red(kMiddle, y), 75) << y;
  }
}

TEST(Outlines, FloorFillsWhatLiesBehind) {
  Scene scene;
  const Floor floor{Vec3(0, 0, -1), Vec3::UnitZ(), {}};
  for (int y = 0; y < kOutlinedHeight; ++y) {
    for (int x = 0; x < kOutlinedWidth; ++x) {
      const double nearness = (32 - y - 0.5) / 48;
      if (nearness > 0) scene.seen[y * kOutlinedWidth + x] = {static_cast<float>(1 / nearness), kFloor};
      scene.picture[y * kOutlinedWidth + x] = nearness > 0 ? 0x606060606060 : kBlack;
    }
  }
  scene.add(quad(10, 4, 40.75, 20, 1, kWhite), 1,
            [](double x, double y) { return x > 10 && x < 40.75 && y > 4 && y < 20; });
  scene.antialias(floor);
  EXPECT_NEAR(scene.red(40, 10), (3 * 0xFF + 0x60) / 4, 1);
}

TEST(Outlines, APictureOfOneFlatThingIsLeftAlone) {
  Scene scene;
  scene.add(quad(-10, -10, kOutlinedWidth + 10, kOutlinedHeight + 10, 2, 0x121234345656), 2,
            [](double, double) { return true; });
  EXPECT_EQ(scene.antialias().count(), 0u);
}

TEST(Outlines, APictureWithoutSurfacesKeepsNothingOfTheOneBefore) {
  Scene scene;
  scene.add(quad(10, 10, 30, 50, 2, kWhite), 2,
            [](double x, double y) { return x > 10 && x < 30 && y > 10 && y < 50; });
  Outlines outlines = scene.antialias();
  EXPECT_GT(outlines.count(), 0u);
  Scene empty;
  outlines.antialias(empty.seen, {}, std::nullopt, test_view(), {}, empty.picture);
  EXPECT_EQ(outlines.count(), 0u);
  std::vector<Eigen::Vector4f> surfaces;
  outlines.extract_surfaces(empty.seen, empty.picture, surfaces);
  for (const Eigen::Vector4f& pixel : surfaces) ASSERT_EQ(pixel, Eigen::Vector4f(Eigen::Vector4f::Zero()));
}

}  // namespace
}  // namespace weft::render
