// Path data as outlines: every command, and invalid text.
#include "film/garment/outline.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "film/garment/triangulation.hpp"

namespace weft::garment {
namespace {

std::vector<Vec2> sampled(const Outline& outline) {
  std::vector<Vec2> points;
  for (const Curve& curve : outline)
    for (int i = 0; i < 200; ++i) points.push_back(curve.at(i / 200.0));
  return points;
}

double area_of(const std::string& path) {
  const ParsedPath parsed = parse_path(path);
  EXPECT_EQ(parsed.mistake, "") << path;
  return parsed.mistake.empty() ? polygon_area(sampled(parsed.outline)) : 0;
}

TEST(Outlines, LinesInEveryFormGiveTheSamePolygon) {
  for (const char* path : {"M0 0L3 0L3 2L0 2Z", "m 0,0 l 3,0 0,2 -3,0 z", "M0 0H3V2H0Z", "M0 0h3v2h-3z",
                           "M 0 0 3 0 3 2 0 2 0 0 Z", "M+0-0L3e0.0L3 2 0,2z", "M0,0 L3,0 L3,2 L0,2 L0,0"}) {
    const ParsedPath parsed = parse_path(path);
    ASSERT_EQ(parsed.mistake, "") << path;
    EXPECT_EQ(parsed.outline.size(), 4U) << path;
    EXPECT_NEAR(area_of(path), 6, 1e-12) << path;
  }
}

// Coordinates of 0.01 mm. The outline ends 0.022 mm from its start, 4.5e-5 of its diagonal; another one, 0.14 mm from
// it.
TEST(Outlines, RoundedRelativeCoordinatesCloseThem) {
  const std::string almost = "m 10,10 l 300.12,0 0.03,400.2 -300.14,0.01 -0.03,-400.2";
  for (const std::string& path : {almost, almost + " z"}) {
    const ParsedPath parsed = parse_path(path);
    ASSERT_EQ(parsed.mistake, "") << path;
    EXPECT_EQ(parsed.outline.size(), 4U) << path;
    EXPECT_EQ(parsed.outline.back().end(), parsed.outline.front().start()) << path;
  }
  const ParsedPath apart = parse_path("m 10,10 l 300.12,0 0.03,400.2 -300.14,0.01 -0.1,-400.1 z");
  ASSERT_EQ(apart.mistake, "");
  EXPECT_EQ(apart.outline.size(), 5U) << "the closing line is an edge";
}

TEST(Outlines, ArcsAreCircles) {
  // A cubic that approximates a quarter circle deviates by at most 2.7e-4 of the radius. Areas have smaller errors.
  const double disc = std::numbers::pi * 0.25;
  EXPECT_NEAR(area_of("M -0.5 0 A 0.5 0.5 0 0 1 0.5 0 A 0.5 0.5 0 0 1 -0.5 0 Z"), disc, 3e-4 * disc);
  EXPECT_NEAR(area_of("M -0.5 0 A 0.5 0.5 0 1 0 0.5 0 A 0.5 0.5 0 1 0 -0.5 0 Z"), -disc, 3e-4 * disc);
  // The larger arc, three quarters of the circle, then lines to the centre.
  EXPECT_NEAR(area_of("M 0.5 0 A 0.5 0.5 0 1 0 0 0.5 L 0 0 Z"), -0.75 * disc, 3e-4 * disc);
  // An ellipse rotated by 30 degrees.
  EXPECT_NEAR(std::abs(area_of("M 0.433012701892 0.25 A 0.5 0.2 30 0 1 -0.433012701892 -0.25 A 0.5 0.2 30 0 1 "
                               "0.433012701892 0.25 Z")),
              std::numbers::pi * 0.1, 3e-4);
  // Radii that are too small for the distance of the end points are scaled up.
  EXPECT_NEAR(std::abs(area_of("M -0.5 0 A 0.1 0.1 0 0 1 0.5 0 A 0.1 0.1 0 0 1 -0.5 0 Z")), disc, 3e-4 * disc);
}

TEST(Outlines, SmoothCommandsReflectTheHandleBefore) {
  EXPECT_NEAR(area_of("M0 0C1 1 2 1 3 0S5-1 6 0L6 2L0 2Z"), area_of("M0 0C1 1 2 1 3 0C4-1 5-1 6 0L6 2L0 2Z"), 1e-12);
  EXPECT_NEAR(area_of("M0 0Q1 1 2 0T4 0L4 2L0 2Z"), area_of("M0 0Q1 1 2 0Q3-1 4 0L4 2L0 2Z"), 1e-12);
  // The area under a quadratic is two thirds of its control triangle.
  EXPECT_NEAR(area_of("M0 0Q1 1 2 0Z"), -2.0 / 3, 1e-4);
  // The second outline begins with a smooth curve, but the control point before it belongs to the first outline.
  const ParsedPaths two = parse_paths("M9 9L9 8C6 8 5 5 9 9M0 0S2-1 3 0L3 2L0 2Z");
  ASSERT_EQ(two.outlines.size(), 2u) << two.mistake;
  EXPECT_NEAR(polygon_area(sampled(two.outlines[1])), area_of("M0 0S2-1 3 0L3 2L0 2Z"), 1e-12);
}

TEST(Outlines, WhatIsNoOutlineIsRefusedWithItsPlace) {
  const std::pair<const char*, const char*> kBad[] = {
      {"", "closed"},
      {"M0 0L1 0L1 1", "closed"},
      {"L1 0Z", "M at the start"},
      {"M0 0L1 0L1 1ZL2 2", "nothing after"},
      {"M0 0L1 0L1 1ZM2 2L3 2L3 3Z", "second M"},
      {"M0 0M1 0Z", "second M"},
      {"M0 0L1 x Z", "expected a number, got \"x\" at character 8"},
      {"M0 0L1 ", "expected a number, got the end"},
      {"M0 0L1e999 0Z", "number from"},
      {"M0 0L+-1 0Z", "got \"+\" at character 6"},
      {"M0 0Lnan 0Z", "expected a number"},
      {"M0 0A1 1 0 2 0 1 1Z", "expected 0 or 1"},
      {"M0 0B1 1Z", "a command"},
      {"M0 0Z", "two curves"},
      {"M1 1L1 1L1 1Z", "two curves"},
  };
  for (const auto& [path, words] : kBad)
    EXPECT_NE(parse_path(path).mistake.find(words), std::string::npos) << path << ": " << parse_path(path).mistake;
}

TEST(Outlines, DamagedPathsAreRefusedOrRead) {
  const std::string path = "M0 0C1 1 2 1 3 0S5-1 6 0A1 1 30 0 1 6 2Q3 3 2 2T0 2h-.5v-1z";
  std::mt19937 engine(5);
  int read = 0;
  for (int round = 0; round < 5000; ++round) {
    std::string damaged = path;
    for (int k = 0; k < 1 + round % 3; ++k) {
      const std::size_t at = engine() % damaged.size();
      if (engine() % 2 == 0)
        damaged[at] = static_cast<char>(engine() % 256);
      else
        damaged.erase(at, 1 + engine() % 3);
      if (damaged.empty()) damaged = "M";
    }
    const ParsedPath parsed = parse_path(damaged);
    if (!parsed.mistake.empty()) continue;
    ++read;
    for (const Curve& curve : parsed.outline) ASSERT_TRUE(curve.at(0.3).allFinite()) << damaged;
  }
  EXPECT_GT(read, 100);
}

TEST(Outlines, EqualSharesOfTheLengthAreEquallyFarApart) {
  const ParsedPath quarter = parse_path("M1 0A1 1 0 0 1 0 1L0 0Z");
  ASSERT_EQ(quarter.mistake, "");
  const Arclength along({quarter.outline[0]});
  // Tolerance: the relative error of the cubic's radius, 2.7e-4, is also that of its length.
  EXPECT_NEAR(along.length(), 0.5 * std::numbers::pi, 3e-4);
  for (int k = 0; k <= 10; ++k) {
    const double angle = 0.05 * std::numbers::pi * k;
    EXPECT_LT((along.at(k / 10.0) - Vec2(std::cos(angle), std::sin(angle))).norm(), 5e-4);
  }
}

}  // namespace
}  // namespace weft::garment
