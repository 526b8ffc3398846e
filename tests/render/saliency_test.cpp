#include "film/render/saliency.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numbers>

#include "core/memory.hpp"
#include "render/snapshots.hpp"

namespace weft::render {
namespace {

constexpr auto kCloth = frame::ObjectKind::cloth, kObstacle = frame::ObjectKind::obstacle;

/// A camera 10 m in front of the origin; at the origin, it sees a height of 4 m.
frame::FrameSnapshot seen_from_before() {
  frame::FrameSnapshot snapshot;
  snapshot.stage = std::make_shared<frame::Stage>();
  frame::Camera camera;
  camera.position = {0, -10, 0};
  camera.target = {0, 0, 0};
  camera.field_of_view = 2 * std::atan(0.2) * 180 / std::numbers::pi;
  snapshot.cameras = {camera};
  return snapshot;
}

void add_upright(frame::FrameSnapshot& snapshot, frame::ObjectKind kind, const Vec3& center, double half) {
  add_square(snapshot, kind, center, -Vec3::UnitY(), Vec3::UnitX(), half);
}

Saliency compute_saliency(const frame::FrameSnapshot& snapshot, const frame::FrameSnapshot* previous = nullptr) {
  return saliency_of(snapshot, previous, 0.1, "", 2);
}

TEST(Saliency, CoverageIsTheShareOfThePictureThatShowsCloth) {
  frame::FrameSnapshot snapshot = seen_from_before();
  EXPECT_EQ(compute_saliency(snapshot).score(), 0);
  add_upright(snapshot, kCloth, {1, 0, 0.5}, 1);
  // The cloth is 2 m by 2 m of the visible 8 m by 4 m. Its edges coincide with edges of raster cells.
  EXPECT_NEAR(compute_saliency(snapshot).coverage, 4.0 / 32, 1e-12);
  add_upright(snapshot, kCloth, {-4, 0, 0}, 1);  // half of it is outside the picture
  EXPECT_NEAR(compute_saliency(snapshot).coverage, 6.0 / 32, 1e-12);
}

TEST(Saliency, OfAVeryWidePictureNeedsLittleMemory) {
  frame::FrameSnapshot snapshot = seen_from_before();
  add_upright(snapshot, kCloth, {0, 0, 0}, 1);
  const std::int64_t before = peak_memory_bytes();
  EXPECT_NEAR(saliency_of(snapshot, nullptr, 0.1, "", 16384).coverage, 0.5 * 2 / (4.0 * 16384), 1e-8);
  EXPECT_LT(peak_memory_bytes() - before, 100'000'000);
}

TEST(Saliency, ClothBehindSomethingOrBehindTheCameraDoesNotCount) {
  frame::FrameSnapshot snapshot = seen_from_before();
  add_upright(snapshot, kCloth, {0, 0, 0}, 1);
  add_upright(snapshot, kObstacle, {0, -5, 0}, 0.25);  // at half the distance, so it hides 1 m by 1 m of the cloth
  EXPECT_NEAR(compute_saliency(snapshot).coverage, 3.0 / 32, 1e-12);
  add_upright(snapshot, kObstacle, {0, 5, 0}, 3);  // behind the cloth
  EXPECT_NEAR(compute_saliency(snapshot).coverage, 3.0 / 32, 1e-12);
  add_upright(snapshot, kCloth, {0, -20, 0}, 1);
  EXPECT_NEAR(compute_saliency(snapshot).coverage, 3.0 / 32, 1e-12);
}

TEST(Saliency, WithoutACameraTheFrameIsFramedByItself) {
  frame::FrameSnapshot snapshot = seen_from_before();
  snapshot.cameras.clear();
  add_square(snapshot, kCloth, {100, 0, 0}, -Vec3::UnitY(), Vec3::UnitX(), 0.01);
  EXPECT_GT(compute_saliency(snapshot).coverage, 0.1);
}

TEST(Saliency, FoldingIsNoneForFlatClothAndThatOfAnAngleForABentOne) {
  frame::FrameSnapshot snapshot = seen_from_before();
  add_surface(snapshot, kCloth, {{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}}, {{0, 1, 2}, {0, 2, 3}});
  EXPECT_NEAR(compute_saliency(snapshot).folding, 0, 1e-12);
  frame::FrameSnapshot bent = seen_from_before();
  add_surface(bent, kCloth, {{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}, {1, 1, 0}, {1, 1, 1}},
              {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}});
  EXPECT_NEAR(compute_saliency(bent).folding, 1 - std::numbers::sqrt2 / 2, 1e-12);
}

TEST(Saliency, MotionIsThatOfTheShapeNotOfTheWhole) {
  frame::FrameSnapshot before = seen_from_before();
  add_surface(before, kCloth, {{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}}, {{0, 1, 2}, {0, 2, 3}});
  frame::FrameSnapshot after = before;
  for (Vec3& x : after.states[0].positions) x += Vec3(0.3, 0.2, -0.5);
  EXPECT_NEAR(compute_saliency(after, &before).motion, 0, 1e-12) << "it only falls";
  // In 0.1 s, two opposite corners move by 5 cm along +y, the others along -y: per second, half the size of the cloth.
  after = before;
  for (const std::size_t v : {0u, 2u}) after.states[0].positions[v].y() += 0.05;
  for (const std::size_t v : {1u, 3u}) after.states[0].positions[v].y() -= 0.05;
  EXPECT_NEAR(compute_saliency(after, &before).motion, 0.5, 5e-3);  // tolerance: the bent surface is 1 % larger
  EXPECT_EQ(compute_saliency(after).motion, 0) << "nothing is known of the motion in the first frame";
}

}  // namespace
}  // namespace weft::render
