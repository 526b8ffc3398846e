// Motion blur, depth of field, styles for review, and cloth that is refined for drawing.
#include "film/render/instants.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "film/render/refinement.hpp"
#include "film/render/renderer.hpp"
#include "render/snapshots.hpp"

namespace weft::render {
namespace {

using Look = frame::Stage::Look;
constexpr int kInstantWidth = 200, kInstantHeight = 100;

Settings small_settings() {
  Settings settings;
  settings.width = kInstantWidth;
  settings.height = kInstantHeight;
  return settings;
}

/// A white square of 0.2 m in front of black, by default 2 m from the camera, where a pixel is 7.1 mm wide.
frame::FrameSnapshot square_at(double x, double distance = 2) {
  frame::FrameSnapshot snapshot;
  auto stage = stage_without_sky();
  stage->sky_color = Vec3::Zero();
  snapshot.stage = stage;
  add_square(snapshot, frame::ObjectKind::obstacle, Vec3(x, distance, 0), -Vec3::UnitY(), Vec3::UnitX(), 0.1)
      .appearance.color = Vec3::Ones();
  snapshot.cameras = {camera_at(Vec3::Zero(), Vec3(0, 2, 0), 20)};
  snapshot.lights = {sun(Vec3::UnitY())};
  return snapshot;
}

double linear_at(const image::Image16& image, int x) {
  const double encoded =
      image.rgb[3 * (static_cast<std::size_t>(kInstantHeight / 2) * kInstantWidth + x) + 1] / 65535.0;
  return std::pow((encoded + 0.055) / 1.055, 2.4);
}

// A shutter of 180 degrees is open for half of the time between frames, and closes at the time of the frame. A square
// that moves by 40 pixels between frames moves by 20 while the shutter is open. Its edges thus become ramps 20 pixels
// wide.
TEST(Instants, ShutterShowsTheWayOfTheSecondHalf) {
  const double pixel = 2 * 2 * std::tan(10 * std::numbers::pi / 180) / kInstantHeight;
  const frame::FrameSnapshot now = square_at(20 * pixel), before = square_at(-20 * pixel);
  Settings settings = small_settings();
  settings.motion_blur = 180;
  Renderer renderer(settings);
  renderer.draw(now, &before);
  const image::Image16 image = renderer.image16();
  const double white = linear_at(image, 110);
  EXPECT_GT(white, 0.8);
  // Half the square is 14.2 pixels wide. While the shutter is open, its right edge moves from 114.2 to 134.2, and its
  // left edge from 85.8 to 105.8.
  EXPECT_NEAR(linear_at(image, 124) / white, 0.5, 0.06);
  EXPECT_NEAR(linear_at(image, 119) / white, 0.75, 0.06);
  EXPECT_NEAR(linear_at(image, 95) / white, 0.5, 0.06);
  // The right ramp has no steps. A mean of four sharp pictures would differ from the ramp by up to 0.12.
  for (int x = 116; x < 133; ++x) EXPECT_NEAR(linear_at(image, x) / white, (134.2 - x - 0.5) / 20, 0.05) << x;
  EXPECT_LT(linear_at(image, 84), 0.02);
  EXPECT_LT(linear_at(image, 136), 0.02);
}

// While the shutter is open, the camera moves over a striped floor, by the width of a tile with two stripes: 46 pixels.
TEST(Instants, FloorIsBlurredByTheMotionOfTheCamera) {
  frame::FrameSnapshot now;
  now.stage = stage_without_sky();
  frame::Surface& floor = add_floor(now);
  floor.paint_uv = {{Vec2(0, 0), Vec2(10, 0), Vec2(10, 10)}, {Vec2(0, 0), Vec2(10, 10), Vec2(0, 10)}};
  frame::Texture stripes{64, 64, {}};
  for (int i = 0; i < 64 * 64; ++i) {
    const std::uint8_t level = i % 64 < 32 ? 20 : 200;
    stripes.rgba.insert(stripes.rgba.end(), {level, level, level, 255});
  }
  floor.appearance.paint.texture = std::make_shared<const frame::Texture>(std::move(stripes));
  now.cameras = {camera_at(Vec3(0, 0, 3), Vec3::Zero(), 40)};
  now.lights = {sun(-Vec3::UnitZ())};
  frame::FrameSnapshot before = now;
  before.cameras = {camera_at(Vec3(-1, 0, 3), Vec3(-1, 0, 0), 40)};
  Settings settings = small_settings();
  settings.motion_blur = 360;
  Renderer renderer(settings);
  const auto contrast = [&](const frame::FrameSnapshot* earlier) {
    const image::Image image = renderer.draw(now, earlier);
    int darkest = 255, brightest = 0;
    for (int x = 60; x < 140; ++x) {
      darkest = std::min<int>(darkest, image.pixel(x, kInstantHeight / 2)[1]);
      brightest = std::max<int>(brightest, image.pixel(x, kInstantHeight / 2)[1]);
    }
    return brightest - darkest;
  };
  EXPECT_GT(contrast(nullptr), 150);
  EXPECT_LT(contrast(&before), 20);
  EXPECT_GT(contrast(&now), 150);
}

// Between the frames, the camera jumps by 0.5 m. The square stands still.
TEST(Instants, NothingIsBlurredAcrossACut) {
  frame::FrameSnapshot now = square_at(0.1);
  frame::FrameSnapshot before = now;
  before.cameras[0].position.x() -= 0.5;
  Settings settings = small_settings();
  settings.motion_blur = 180;
  Renderer renderer(settings);
  const std::vector<std::uint8_t> still = renderer.draw(now, &now).rgb;
  EXPECT_NE(renderer.draw(now, &before).rgb, still);
  now.cameras[0].shot = 1;
  EXPECT_EQ(renderer.draw(now, &before).rgb, still);
  EXPECT_EQ(interpolate_cameras(now.cameras[0], before.cameras[0], 1).position, now.cameras[0].position);
}

TEST(Instants, NothingIsBlurredUnasked) {
  const frame::FrameSnapshot now = square_at(0.1), before = square_at(-0.1);
  Renderer renderer(small_settings());
  EXPECT_EQ(renderer.draw(now, &before).rgb, renderer.draw(now).rgb);
  EXPECT_TRUE(make_instants(0, false, 16).empty());
}

// For an object at twice the focus distance, the blur of an edge has half the width of the aperture, measured in the
// focus plane.
TEST(Instants, LensBlursWhatIsOutOfFocus) {
  frame::FrameSnapshot snapshot = square_at(0, 4);
  snapshot.cameras[0].aperture = 0.5;  // f-number: 12 mm / tan 10° / 0.5 = 136 mm wide
  const double width = 0.136 / 2 / (2 * 2 * std::tan(10 * std::numbers::pi / 180) / kInstantHeight);  // [pixels]: 9.6
  Renderer renderer(small_settings());
  const auto middle_of_edge = [&] {
    renderer.draw(snapshot);
    const image::Image16 image = renderer.image16();
    int shaded = 0;
    for (int x = kInstantWidth / 2; x < kInstantWidth; ++x)
      shaded += linear_at(image, x) > 0.03 && linear_at(image, x) < 0.97 * linear_at(image, kInstantWidth / 2);
    return shaded;
  };
  EXPECT_NEAR(middle_of_edge(), width, 2.5);
  snapshot.cameras[0].focus = 4;
  EXPECT_LE(middle_of_edge(), 2);
}

// The camera looks straight down, so the up axis of the scene does not define the up direction of the picture. Still,
// the pictures from all points of the lens must have the same up direction. The square is in focus and 28 pixels wide;
// a mean of rotated squares would have no corners.
TEST(Instants, LensDoesNotRotateThePictureFromAbove) {
  frame::FrameSnapshot snapshot;
  snapshot.stage = square_at(0).stage;
  add_square(snapshot, frame::ObjectKind::obstacle, Vec3::Zero(), Vec3::UnitZ(), Vec3::UnitX(), 0.1).appearance.color =
      Vec3::Ones();
  snapshot.cameras = {camera_at(Vec3(0, 0, 2), Vec3::Zero(), 20)};
  snapshot.cameras[0].aperture = 0.5;
  snapshot.lights = {sun(-Vec3::UnitZ())};
  const image::Image image = Renderer(small_settings()).draw(snapshot);
  EXPECT_GT(image.pixel(100, 50)[1], 200);
  EXPECT_GT(image.pixel(112, 38)[1], 0.95 * image.pixel(100, 50)[1]);
}

// The ground extends behind the camera. The diagonal between its two triangles appears as a vertical line, to the right
// of the middle by 0.866 of half the width: at 186.6 pixels.
TEST(Looks, WireShowsThePartOfAnEdgeBeforeTheCamera) {
  frame::FrameSnapshot snapshot;
  snapshot.stage = square_at(0).stage;
  add_square(snapshot, frame::ObjectKind::obstacle, Vec3(0, 0, -0.5), Vec3::UnitZ(), Vec3::UnitX(), 10);
  snapshot.cameras = {camera_at(Vec3::Zero(), Vec3(0, 2, 0), 60)};
  snapshot.lights = {sun(-Vec3::UnitZ())};
  Settings settings = small_settings();
  settings.look = Look::wire;
  const image::Image wire = Renderer(settings).draw(snapshot);
  EXPECT_LT(wire.pixel(186, 80)[1], 0.75 * wire.pixel(180, 80)[1]);
}

TEST(Looks, ClayHasNoColorsAndWireShowsEdges) {
  frame::FrameSnapshot snapshot = square_at(0, 1);
  auto surface = std::make_shared<frame::Surface>(*snapshot.surfaces[0]);
  surface->appearance.color = Vec3(1, 0, 0);
  snapshot.surfaces[0] = surface;
  Settings settings = small_settings();
  settings.look = Look::clay;
  const image::Image clay = Renderer(settings).draw(snapshot);
  const std::uint8_t* pixel = clay.pixel(100, 40);
  EXPECT_LT(pixel[0] - pixel[2], 20) << "gray, a little warm";
  EXPECT_GT(pixel[2], 100);
  settings.look = Look::wire;
  const image::Image wire = Renderer(settings).draw(snapshot);
  // The diagonal of the two triangles passes through the middle.
  int darkest = 255;
  for (int x = 95; x < 105; ++x) darkest = std::min<int>(darkest, wire.pixel(x, 50)[1]);
  EXPECT_LT(darkest, 0.75 * clay.pixel(100, 40)[1]);
  EXPECT_NEAR(wire.pixel(90, 20)[1], clay.pixel(90, 20)[1], 2) << "between edges as clay";
}

TEST(Looks, StrainNeedsFramesThatHaveIt) {
  frame::FrameSnapshot snapshot = square_at(0);
  Settings settings = small_settings();
  settings.look = Look::strain;
  Renderer renderer(settings);
  EXPECT_THROW(renderer.draw(snapshot), Error);
}

TEST(Looks, ExposureIsInStops) {
  frame::FrameSnapshot snapshot = square_at(0);
  auto surface = std::make_shared<frame::Surface>(*snapshot.surfaces[0]);
  surface->appearance.color = Vec3(0.5, 0.5, 0.5);
  snapshot.surfaces[0] = surface;
  const auto light = [&](double stops) {
    auto stage = std::make_shared<frame::Stage>(*snapshot.stage);
    stage->exposure = stops;
    snapshot.stage = stage;
    Renderer renderer(small_settings());
    renderer.draw(snapshot);
    return linear_at(renderer.image16(), 100);
  };
  // Tolerance: the error of the fitted sRGB curve is 0.1 levels of 255, 0.2 % of this light.
  EXPECT_NEAR(light(1) / light(0), 2, 0.01);
  EXPECT_NEAR(light(-1) / light(0), 0.5, 0.005);
}

// The middle of a chord must be on the circle. The error is of fourth order in the angle; for 0.26 rad, it is 1.1e-4 of
// the radius.
TEST(Refinement, MiddlesOfChordsLieOnTheCircle) {
  const double angle = std::numbers::pi / 12;
  const double radius = 0.01;  // [m]
  const Vec3 from(1, 0, 0), to(std::cos(angle), std::sin(angle), 0), a = radius * from, b = radius * to;
  const Middle half = middle(a, b, from, to, 1e-3);
  EXPECT_NEAR(half.position.norm(), radius, 1.5e-4 * radius);
  EXPECT_LT((half.normal - half.position.normalized()).norm(), 1e-12);
  // A plane stays plane.
  EXPECT_LT((middle(a, b, Vec3::UnitZ(), Vec3::UnitZ(), 1e-3).position - 0.5 * (a + b)).norm(), 1e-15);
  // Normals that contradict each other move the middle by at most the given 0.3 mm.
  EXPECT_LE((middle(from, to, (b - a).normalized(), Vec3::UnitZ(), 3e-4).position - 0.5 * (from + to)).norm(),
            3.001e-4);
}

TEST(Refinement, NeighboursShareTheirMiddles) {
  Refinement refinement;
  const Triangle triangles[] = {{0, 1, 2}, {2, 1, 3}};
  refinement.update(triangles, 4);
  EXPECT_EQ(refinement.edges().size(), 5u);
  ASSERT_EQ(refinement.triangles().size(), 8u);
  // Edge 1 2 is halved only once: its middle belongs to three small triangles on each side.
  std::array<int, 9> uses{};
  for (const Triangle& triangle : refinement.triangles())
    for (const Index vertex : triangle) ++uses[vertex];
  int shared = 0;
  for (int vertex = 4; vertex < 9; ++vertex) shared += uses[vertex] == 6;
  EXPECT_EQ(shared, 1);
}

// Cloth of 2 cm with cells of 1 mm. A ball with a diameter of 1 mm is 0.1 mm in front of it.
TEST(Refinement, SmallClothDoesNotCoverWhatIsCloseInFrontOfIt) {
  constexpr Index kSide = 21;
  std::vector<Vec3> positions;
  std::vector<std::array<Index, 3>> triangles;
  for (Index i = 0; i < kSide; ++i)
    for (Index j = 0; j < kSide; ++j) positions.emplace_back(1e-3 * (i - 10), 0, 1e-3 * (j - 10));
  for (Index i = 0; i + 1 < kSide; ++i) {
    for (Index j = 0; j + 1 < kSide; ++j) {
      const Index a = i * kSide + j, b = a + kSide;
      triangles.push_back({a, b, a + 1});
      triangles.push_back({a + 1, b, b + 1});
    }
  }
  frame::FrameSnapshot snapshot;
  snapshot.stage = square_at(0).stage;
  frame::Surface& cloth = add_surface(snapshot, frame::ObjectKind::cloth, positions, triangles);
  cloth.appearance.color = cloth.appearance.back_color = Vec3::Ones();
  add_sphere(snapshot, Vec3(0, -0.6e-3, 0), 0.5e-3, 16).appearance.color = Vec3(0.7, 0, 0);
  snapshot.cameras = {camera_at(Vec3(0, -0.1, 0), Vec3::Zero(), 3)};
  snapshot.lights = {sun(Vec3::UnitY())};
  const image::Image image = Renderer(small_settings()).draw(snapshot);
  EXPECT_GT(image.pixel(100, 50)[0], 100);
  EXPECT_LT(image.pixel(100, 50)[1], 60) << "the ball is red";
  EXPECT_GT(image.pixel(60, 50)[1], 100) << "the cloth is white";
}

}  // namespace
}  // namespace weft::render
