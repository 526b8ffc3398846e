// Ropes in scenes: how they are read, their start shape, and which are refused.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>

#include "film/scene/effective.hpp"
#include "film/scene/loader.hpp"
#include "film/scene/ropes.hpp"

namespace weft::scene {
namespace {

LoadResult load_rope(const std::string& keys) {
  return load_text("[[rope]]\nname = \"line\"\n" + keys, "ropes.toml");
}

double length_of(const RopeShape& shape) {
  double sum = 0;
  for (const double piece : shape.lengths) sum += piece;
  return sum;
}

TEST(RopeScenes, ReadBackAsTheyAreWrittenOut) {
  const std::string text =
      "points = [[0, 0, 1], [0.5, 0.1, 0.9], [1, 0, 1]]\nsmooth = true\ndiameter = 0.01\nmaterial = \"nylon\"\n"
      "pin = [{ at = 0 }, { at = [0.9, 1] }]\nweight = [{ at = 0.5, mass = 0.2 }]\n"
      "keys = [{ time = 0, length = 1.1 }, { time = 1, length = 0.9 }]\n";
  const LoadResult once = load_rope(text);
  ASSERT_EQ(once.describe(), "");
  const LoadResult again = load_text(effective_scene(once.scene), "ropes.toml");
  ASSERT_EQ(again.describe(), "");
  EXPECT_EQ(effective_scene(once.scene), effective_scene(again.scene));
  EXPECT_EQ(once.scene.hash, again.scene.hash);
  ASSERT_EQ(once.scene.ropes.size(), 1U);
  EXPECT_EQ(once.scene.ropes[0].points.size(), 3U);
  EXPECT_EQ(once.scene.cloths.size(), 1U) << "that of the rope";
  EXPECT_EQ(once.scene.cloths[0].pins.at(1).at, Vec2(0.9, 1));
}

TEST(RopeScenes, SlackRopesStartAsCatenariesOfTheirLength) {
  const LoadResult loaded = load_rope("from = [0, 0, 1]\nto = [1, 0.5, 1.4]\nlength = 1.9\n");
  ASSERT_EQ(loaded.describe(), "");
  const RopeShape shape = start_shape(loaded.scene.ropes[0], loaded.scene.up);
  EXPECT_LT((shape.places.front() - Vec3(0, 0, 1)).norm(), 1e-12);
  EXPECT_LT((shape.places.back() - Vec3(1, 0.5, 1.4)).norm(), 1e-12);
  EXPECT_NEAR(length_of(shape), 1.9, 1e-12);
  // A catenary satisfies z'' = √(1 + z'²) / a. Any two neighbouring pieces must give the same a.
  const auto ratio = [&](std::size_t i) {
    const Vec3 before = shape.places[i] - shape.places[i - 1], after = shape.places[i + 1] - shape.places[i];
    const auto slope = [](const Vec3& segment) { return segment.z() / segment.head<2>().norm(); };
    return before.norm() / (slope(after) - slope(before));
  };
  EXPECT_NEAR(ratio(5) / ratio(shape.places.size() - 6), 1, 0.01);
}

// Both lengths are the smallest double above the distance of the ends.
TEST(RopeScenes, RopesOfTheLengthOfTheirChordStartStraight) {
  for (const auto& [to, length] :
       {std::pair("[0.5, 1, 0.5]", "1.2247448713915892"), std::pair("[2, 1, 1]", "2.4494897427831783")}) {
    const LoadResult loaded = load_rope(std::string("from = [0, 0, 0]\nto = ") + to + "\nlength = " + length + "\n");
    ASSERT_EQ(loaded.describe(), "");
    const RopeShape shape = start_shape(loaded.scene.ropes[0], UpAxis::z);
    const Vec3 chord = shape.places.back();
    for (std::size_t i = 0; i < shape.places.size(); ++i)
      EXPECT_LT(
          (shape.places[i] - static_cast<double>(i) / static_cast<double>(shape.places.size() - 1) * chord).norm(),
          1e-6)
          << i;
  }
}

TEST(RopeScenes, PiecesAreEvenAlongPoints) {
  const LoadResult loaded = load_rope("points = [[0, 0, 0], [1, 0, 0], [1, 1, 0]]\nsegments = 20\ndiameter = 0.01\n");
  ASSERT_EQ(loaded.describe(), "");
  const RopeShape shape = start_shape(loaded.scene.ropes[0], UpAxis::z);
  ASSERT_EQ(shape.places.size(), 21U);
  for (const double piece : shape.lengths) EXPECT_NEAR(piece, 0.1, 1e-12);
}

TEST(RopeScenes, MaterialsGiveFiguresForTheDiameter) {
  // Polyester rope of 10 mm: 68 g/m in the data sheet of Robline's Rapallo, 80 g/m by the formula.
  const LoadResult loaded = load_rope("from = [0, 0, 0]\nto = [1, 0, 0]\ndiameter = 0.01\nmaterial = \"polyester\"\n");
  ASSERT_EQ(loaded.describe(), "");
  EXPECT_NEAR(numbers_of(loaded.scene.ropes[0]).mass, 0.0798, 1e-6);
  EXPECT_NEAR(numbers_of(loaded.scene.ropes[0]).stretch, 109e3, 1);
}

TEST(RopeScenes, MistakesNameTheKeyAndWhatIsExpected) {
  const auto message = [](const std::string& keys) { return load_rope(keys).describe(); };
  const auto expect = [&](const std::string& keys, const std::string& part) {
    EXPECT_NE(message(keys).find(part), std::string::npos) << message(keys);
  };
  expect("from = [0, 0, 0]\n", "rope.line.to: expected points, or from and to, got none");
  expect("points = [[0, 0, 0]]\n", "rope.line.points: expected at least 2 points, got 1");
  expect("points = [[0, 0, 0], [0, 0]]\n",
         "rope.line.points: expected [[x, y, z], ...], each from -100000 to 100000 m");
  expect("points = [[0, 0, 0], [1, 0, 0]]\nfrom = [0, 0, 0]\n", "expected either from or points, got both");
  expect("from = [0, 0, 0]\nto = [1, 0, 0]\nsegments = 200\n",
         "rope.line.segments: expected pieces between particles of at least 0.012 m, 1.5 diameters");
  const std::string drawn_in = "from = [0, 0, 0]\nto = [1, 0, 0]\nsegments = 40\nkeys = [{ time = 0, length = 1 }, ";
  expect(drawn_in + "{ time = 1, length = 0.4 }]\n",
         "rope.line.keys.1.length: expected at least 0.48 m, at which the shortest of 40 pieces between particles has "
         "1.5 diameters, got 0.4");
  EXPECT_EQ(message(drawn_in + "{ time = 1, length = 0.48 }]\n"), "");
  expect("from = [0, 0, 0]\nto = [0, 0, 1]\nlength = 2\n",
         "expected a place at least 0.032 m (4 diameters) beside `from`");
  expect("from = [0, 0, 0]\nto = [1, 0, 0]\nmaterial = \"nylom\"\n", "did you mean nylon?");
  expect("from = [0, 0, 0]\nto = [1, 0, 0]\npin = [{}]\n", "rope.line.pin.0.at: expected");
  expect("from = [0, 0, 0]\nto = [1, 0, 0]\npin = [{ at = [0.7, 0.2] }]\n", "expected the lower end first");
  expect("from = [0, 0, 0]\nto = [1, 0, 0]\n[[cloth]]\nname = \"line\"\n", "which a cloth has");
  expect(
      "from = [0, 0, 0]\nto = [1, 0, 0]\n[[cloth]]\nname = \"flag\"\n[[attach]]\nname = \"a\"\ncloth = \"flag\"\n"
      "to = \"line\"\nat = 0.5\n",
      "attach.a.at: expected none for a cloth that is not a rope");
  const std::string tied =
      "from = [0, 0, 0]\nto = [1, 0, 0]\n[[obstacle]]\nname = \"post\"\nshape = \"box\"\n"
      "position = [0, 0, 2]\n[[attach]]\nname = \"a\"\ncloth = \"line\"\nto = \"post\"\n";
  expect(tied + "at = 0.5\nlow = [0.2, 0]\n", "attach.a.low: expected none beside at, which gives the part");
  EXPECT_EQ(load_rope(tied + "low = [0.2, 0]\n").describe(), "");
}

}  // namespace
}  // namespace weft::scene
