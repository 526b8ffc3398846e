#include "film/character/figure.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace weft::character {
namespace {

/// RGBA of the picture at the middle of a triangle.
std::array<int, 4> painted(const Character& body, std::size_t triangle) {
  const Material& material = body.coloring.materials[body.coloring.material_of_triangle[triangle]];
  const auto& places = body.coloring.uv[triangle];
  const Vec2 at = (places[0] + places[1] + places[2]) / 3;
  const int column = std::clamp(static_cast<int>(at.x() * material.width), 0, material.width - 1);
  const int row = std::clamp(static_cast<int>((1 - at.y()) * material.height), 0, material.height - 1);
  const auto* pixel = material.pixels.data() + 4 * (static_cast<std::size_t>(row) * material.width + column);
  return {pixel[0], pixel[1], pixel[2], pixel[3]};
}

TEST(Figure, HairIsOnTheHeadShoesAreOnTheFeetAndNothingIsBetween) {
  for (const double height : {1.5, 1.75}) {
    const Character body = make_mannequin({.height = height, .edge_length = 0.03});
    ASSERT_EQ(body.coloring.uv.size(), body.mesh.topology.triangles.size());
    EXPECT_TRUE(body.coloring.covers_look);
    int hair = 0, sole = 0, face = 0, skin = 0;
    for (std::size_t t = 0; t < body.coloring.uv.size(); ++t) {
      Vec3 middle = Vec3::Zero();
      for (const Index v : body.mesh.topology.triangles[t]) middle += body.mesh.positions[v] / (3 * height);
      const std::array<int, 4> ink = painted(body, t);
      const Vec3 at = middle * 175;  // [cm]
      if (at.z() > 172) {
        EXPECT_EQ(ink[3], 255) << at.transpose();
        ++hair;
      } else if (at.z() < 1.5) {
        EXPECT_EQ(ink[3], 255) << at.transpose();
        ++sole;
      } else if (at.z() > 12 && at.z() < 150 && std::abs(at.x()) < 40) {
        EXPECT_EQ(ink[3], 0) << at.transpose();
        ++skin;
      } else if (body.coloring.material_of_triangle[t] == 1) {
        EXPECT_LT(at.y(), -5);
        ++face;
      }
    }
    EXPECT_GT(std::min({hair, sole, face}), 10);
    EXPECT_GT(skin, 1000);
  }
}

TEST(Figure, BothSidesOfTheFaceAreAlike) {
  const Character body = make_mannequin({});
  const Material& face = body.coloring.materials[1];
  int inked = 0;
  for (int row = 0; row < face.height; ++row) {
    for (int column = 0; column < face.width / 2; ++column) {
      const auto alpha = [&](int k) { return face.pixels[4 * (static_cast<std::size_t>(row) * face.width + k) + 3]; };
      EXPECT_EQ(alpha(column), alpha(face.width - 1 - column));
      inked += alpha(column) > 100;
    }
  }
  EXPECT_GT(inked, 100) << "brows, lids and lips";
}

TEST(Figure, HairIsPaintedWhereItsVolumeIs) {
  const Character body = make_mannequin({});
  int knot = 0, ears = 0;
  for (std::size_t t = 0; t < body.coloring.uv.size(); ++t) {
    Vec3 middle = Vec3::Zero();
    for (const Index v : body.mesh.topology.triangles[t]) middle += body.mesh.positions[v] / 3;
    if (middle.z() < 1.5) continue;
    const int alpha = painted(body, t)[3];
    if (middle.y() > 0.105) {
      EXPECT_EQ(alpha, 255) << middle.transpose();
      ++knot;
    } else if (std::abs(middle.x()) > 0.08) {
      EXPECT_LT(alpha, 100) << middle.transpose();
      ++ears;
    }
  }
  EXPECT_GT(std::min(knot, ears), 20);
}

}  // namespace
}  // namespace weft::character
