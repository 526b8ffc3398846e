// Texture coordinates of pictures on the shapes of obstacles.
#include "film/environment/picture_places.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>

#include "core/error.hpp"
#include "film/environment/environment.hpp"
#include "support/scene_runs.hpp"

namespace weft::environment {
namespace {

constexpr double kPi = std::numbers::pi;

const std::vector<std::string> kShapes = {
    "shape = 'sphere'\nradius = 0.5",
    "shape = 'box'\nsize = [1, 2, 3]",
    "shape = 'box'\nsize = [1, 2, 3]\nbevel = 0.2",
    "shape = 'cone'\nradius = 0.5\nheight = 1",
    "shape = 'torus'\nradius = 0.5\ntube_radius = 0.2",
    "shape = 'cylinder'\nradius = 0.5\nheight = 2",
    "shape = 'half_pipe'\nradius = 1\nlength = 2\nthickness = 0.1",
    "shape = 'plane'\nsize = [4, 2]\ninfinite = false",
};

struct PlacedPicture {
  mesh::Mesh mesh;
  PicturePlaces places;
};

PlacedPicture place_picture(const std::string& shape, const std::string& up, const std::optional<Vec2>& tile = {}) {
  const scene::Scene scene = support::scene_of_text("up = '" + up + "'\n[[obstacle]]\nname = 'thing'\n" + shape + "\n");
  assets::LoadedMesh loaded = mesh_of(scene, scene.obstacles[0]);
  PicturePlaces places = picture_places(scene, scene.obstacles[0], loaded, tile);
  return {std::move(loaded.mesh), std::move(places)};
}

/// Vectors along the surface [m] over which u and v grow by 1 on a triangle.
struct Directions {
  Vec3 u, v, normal;
};
std::optional<Directions> directions(const PlacedPicture& placed, std::size_t t) {
  const auto& [a, b, c] = placed.mesh.topology.triangles[t];
  const auto& x = placed.mesh.positions;
  const Vec2 p = placed.places[t][1] - placed.places[t][0], q = placed.places[t][2] - placed.places[t][0];
  Eigen::Matrix2d places;
  places << p, q;
  if (std::abs(places.determinant()) < 1e-12) return std::nullopt;
  Eigen::Matrix<double, 3, 2> sides;
  sides << x[b] - x[a], x[c] - x[a];
  const Eigen::Matrix<double, 3, 2> by_place = sides * places.inverse();
  return Directions{by_place.col(0), by_place.col(1), (x[b] - x[a]).cross(x[c] - x[a]).normalized()};
}

TEST(PicturePlaces, ShowNoPictureMirroredFromOutside) {
  for (const std::string& shape : kShapes)
    for (const std::string up : {"z", "y"}) {
      const PlacedPicture placed = place_picture(shape, up);
      ASSERT_EQ(placed.places.size(), placed.mesh.topology.triangles.size());
      std::size_t without_area = 0;
      for (std::size_t t = 0; t < placed.places.size(); ++t) {
        const auto to = directions(placed, t);
        if (!to) {
          ++without_area;
          continue;
        }
        EXPECT_GT(to->u.cross(to->v).dot(to->normal), 0) << shape << " " << up << " " << t;
      }
      EXPECT_EQ(without_area, 0u) << shape;
    }
}

TEST(PicturePlaces, AreUprightAtTheFront) {
  for (const std::string& shape : kShapes)
    for (const std::string up : {"z", "y"}) {
      const Vec3 up_axis = up == "z" ? Vec3(0, 0, 1) : Vec3(0, 1, 0),
                 front = up == "z" ? Vec3(0, -1, 0) : Vec3(0, 0, 1);
      const PlacedPicture placed = place_picture(shape, up);
      for (std::size_t t = 0; t < placed.places.size(); ++t) {
        const auto to = directions(placed, t);
        if (!to || to->normal.dot(front) < 0.98 || shape.find("half_pipe") != std::string::npos) continue;
        EXPECT_GT(to->u.normalized().x(), 0.95) << shape << " " << up;
        EXPECT_GT(to->v.normalized().dot(up_axis), 0.9) << shape << " " << up;
      }
    }
}

TEST(PicturePlaces, GoOnceAroundAndAreNowhereTornInATriangle) {
  for (const std::string& shape : kShapes) {
    const PlacedPicture placed = place_picture(shape, "z");
    Vec2 low(1, 1), high(0, 0);
    for (const auto& corners : placed.places) {
      for (std::size_t k = 0; k < 3; ++k) {
        low = low.cwiseMin(corners[k]);
        high = high.cwiseMax(corners[k]);
        const Vec2 side = corners[(k + 1) % 3] - corners[k];
        const bool flat = shape.find("box") != std::string::npos || shape.find("plane") != std::string::npos;
        if (flat) continue;
        EXPECT_LT(side.cwiseAbs().maxCoeff(), 0.5) << shape;
      }
    }
    // A triangle at a seam may extend beyond the picture, by at most its own width.
    EXPECT_GT(low.minCoeff(), -0.2) << shape;
    EXPECT_LT(high.maxCoeff(), 1.2) << shape;
    // Together, the triangles show at least 90 % of the picture's width and height. On a bevelled box, a part at the
    // edges may be missing, because each triangle of a bevel shows the picture of the nearest side.
    EXPECT_GT((high - low).minCoeff(), 0.9) << shape;
  }
}

TEST(PicturePlaces, WithAWidthAreMeasuredInMetres) {
  const Vec2 tile(0.5, 0.25);
  for (const std::string& shape : {kShapes[1], kShapes[7]}) {
    const PlacedPicture placed = place_picture(shape, "z", tile);
    for (std::size_t t = 0; t < placed.places.size(); ++t) {
      const auto to = directions(placed, t);
      ASSERT_TRUE(to);
      EXPECT_NEAR(to->u.norm(), tile.x(), 1e-12);
      EXPECT_NEAR(to->v.norm(), tile.y(), 1e-12);
    }
  }
  // Six tiles of 0.5 m fit best around a cylinder of 3.14 m circumference, so each is widened to 0.524 m.
  const PlacedPicture placed = place_picture(kShapes[5] + "\nsegments = 200", "z", tile);
  for (std::size_t t = 0; t < placed.places.size(); ++t) {
    const auto to = directions(placed, t);
    ASSERT_TRUE(to);
    if (std::abs(to->normal.z()) > 0.5) continue;
    EXPECT_NEAR(to->u.norm(), kPi / 6, 1e-3);
    EXPECT_NEAR(to->v.norm(), tile.y(), 1e-9);
  }
}

TEST(PicturePlaces, OfAFileAreItsUVs) {
  const std::filesystem::path file =
      std::filesystem::path(testing::TempDir()) / ("weft_places_" + std::to_string(::getpid()) + ".obj");
  const std::string shape = "shape = 'mesh'\nfile = '" + file.string() + "'";
  std::ofstream(file) << "v 0 0 0\nv 2 0 0\nv 2 2 0\nvt 0 0\nvt 1 0\nvt 1 1\nf 1/1 2/2 3/3\n";
  EXPECT_EQ(place_picture(shape, "z").places.at(0), (std::array<Vec2, 3>{Vec2(0, 0), Vec2(1, 0), Vec2(1, 1)}));
  // One unit of the texture coordinates of this file is 2 m long.
  EXPECT_LT((place_picture(shape, "z", Vec2(0.5, 1)).places.at(0)[2] - Vec2(4, 2)).norm(), 1e-12);
  std::ofstream(file) << "v 0 0 0\nv 2 0 0\nv 2 2 0\nf 1 2 3\n";
  EXPECT_THROW(place_picture(shape, "z"), Error);
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace weft::environment
