// Known shapes in known places; the expected pictures are computed by hand.
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <numbers>
#include <thread>

#include "core/error.hpp"
#include "core/timer.hpp"
#include "film/image/color.hpp"
#include "film/render/renderer.hpp"
#include "render/snapshots.hpp"
#include "support/test_folder.hpp"

namespace weft::render {
namespace {

constexpr int kPictureWidth = 320, kPictureHeight = 200;

Settings settings(Quality quality = Quality::final) {
  Settings result;
  result.width = kPictureWidth;
  result.height = kPictureHeight;
  result.quality = quality;
  return result;
}

const Vec3 kRed(0.7, 0.1, 0.1), kBlue(0.1, 0.2, 0.7);

bool reddish(const std::uint8_t* pixel) {
  return pixel[0] > 2 * pixel[2];
}
bool bluish(const std::uint8_t* pixel) {
  return pixel[2] > 2 * pixel[0];
}

template <class Predicate>
int count(const image::Image& image, const Predicate& predicate) {
  int pixels = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) pixels += predicate(image.pixel(x, y));
  }
  return pixels;
}

/// A square seen from the front at 2 m, with frontal light.
frame::FrameSnapshot facing_square(frame::ObjectKind kind, double half, const Vec3& color) {
  frame::FrameSnapshot snapshot;
  snapshot.stage = stage_without_sky();
  add_square(snapshot, kind, Vec3::Zero(), -Vec3::UnitY(), Vec3::UnitX(), half).appearance.color = color;
  snapshot.cameras = {camera_at(Vec3(0, -2, 0), Vec3::Zero(), 40)};
  snapshot.lights = {sun(Vec3::UnitY())};
  return snapshot;
}

// A side of 2 h at distance d is h / (d tan(fov / 2)) of the height of the picture: 200 * 0.3 / (2 tan 20) = 82.4
// pixels. Tolerance of the number of pixels: half a pixel along each of the four sides.
TEST(Picture, SquareCoversThePixelsThatPerspectiveGives) {
  const double side = kPictureHeight * 0.3 / (2 * std::tan(20 * std::numbers::pi / 180));
  for (const Quality quality : {Quality::draft, Quality::preview, Quality::final}) {
    Renderer renderer(settings(quality));
    const image::Image image = renderer.draw(facing_square(frame::ObjectKind::obstacle, 0.3, kRed));
    EXPECT_NEAR(count(image, reddish), side * side, 2 * side) << static_cast<int>(quality);
    // The square is centred. Tests the middles of its left and lower sides, 1.2 pixels inside and 1.8 pixels outside.
    const int reach = static_cast<int>(side / 2);
    EXPECT_TRUE(reddish(image.pixel(kPictureWidth / 2 - reach + 1, kPictureHeight / 2)));
    EXPECT_FALSE(reddish(image.pixel(kPictureWidth / 2 - reach - 3, kPictureHeight / 2)));
    EXPECT_TRUE(reddish(image.pixel(kPictureWidth / 2, kPictureHeight / 2 + reach - 2)));
    EXPECT_FALSE(reddish(image.pixel(kPictureWidth / 2, kPictureHeight / 2 + reach + 2)));
  }
}

TEST(Picture, TopRowComesFirst) {
  frame::FrameSnapshot snapshot = facing_square(frame::ObjectKind::obstacle, 0.1, kRed);
  for (Vec3& position : snapshot.states[0].positions) position += Vec3(-0.5, 0, 0.4);
  const image::Image image = Renderer(settings()).draw(snapshot);
  // 100 pixels are 0.728 m at a distance of 2 m: the centre is 68.7 pixels to the left of the middle and 54.9 above it.
  EXPECT_TRUE(reddish(image.pixel(160 - 69, 100 - 55)));
  EXPECT_FALSE(reddish(image.pixel(160 - 69, 100 + 55)));
}

TEST(Picture, NearerHidesFartherInEitherOrder) {
  for (const bool near_first : {true, false}) {
    frame::FrameSnapshot snapshot = facing_square(frame::ObjectKind::obstacle, 0.3, near_first ? kRed : kBlue);
    add_square(snapshot, frame::ObjectKind::cloth, Vec3::Zero(), -Vec3::UnitY(), Vec3::UnitX(), 0.3).appearance.color =
        near_first ? kBlue : kRed;
    // The red square is 2 mm nearer and must hide the blue one.
    for (Vec3& position : snapshot.states[near_first ? 0 : 1].positions) position.y() -= 0.002;
    const image::Image image = Renderer(settings()).draw(snapshot);
    EXPECT_TRUE(reddish(image.pixel(160, 100)));
    EXPECT_EQ(count(image, bluish), 0);
  }
}

// A tetrahedron, seen from outside and from inside, with faces that point outward or inward. Light from the viewer's
// side reaches only the near side; behind the tetrahedron is the light grey backdrop.
TEST(Picture, ClosedSurfacesAreSeenFromWithinAsWell) {
  for (const bool outward : {true, false}) {
    for (const bool within : {true, false}) {
      frame::FrameSnapshot snapshot;
      snapshot.stage = stage_without_sky();
      std::vector<std::array<Index, 3>> triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
      if (!outward) {
        for (auto& triangle : triangles) std::swap(triangle[0], triangle[1]);
      }
      add_surface(snapshot, frame::ObjectKind::obstacle, {{-9, -5, -5}, {9, -5, -5}, {0, 8, -5}, {0, 0, 9}}, triangles)
          .appearance.color = kRed;
      snapshot.cameras = {camera_at(within ? Vec3(0, 0, 0) : Vec3(0, -40, 0), Vec3(0, 10, 0), 40)};
      snapshot.lights = {sun(Vec3::UnitY())};
      const image::Image image = Renderer(settings(Quality::draft)).draw(snapshot);
      const std::uint8_t* middle = image.pixel(160, 100);
      EXPECT_LT(middle[1], 60) << outward << within;
      if (!within) {
        EXPECT_GT(middle[0], 100) << outward;
      }
    }
  }
}

// A matte surface that faces a light of intensity 1 shows its own colour. Tolerance: the highlight of a rough surface
// (f0 = 0.004) adds less than 1 level; dithering and the fitted sRGB curve add less than 1 level.
TEST(Picture, MatteSurfaceFacingTheLightShowsItsOwnColor) {
  const Vec3 color(0.65, 0.35, 0.2);
  for (const auto kind : {frame::ObjectKind::obstacle, frame::ObjectKind::character, frame::ObjectKind::cloth}) {
    const image::Image image = Renderer(settings()).draw(facing_square(kind, 0.3, color));
    for (int channel = 0; channel < 3; ++channel) {
      EXPECT_NEAR(image.pixel(160, 100)[channel], 255 * color[channel], 2.5) << channel;
    }
  }
}

// At 60 degrees, half of the light arrives in each channel.
TEST(Picture, ObliqueLightFallsWithTheCosine) {
  frame::FrameSnapshot snapshot = facing_square(frame::ObjectKind::obstacle, 0.3, kRed);
  snapshot.lights = {sun(Vec3(std::sqrt(3.0), 1, 0))};
  const image::Image image = Renderer(settings()).draw(snapshot);
  const Vec3 expected = image::srgb_from_linear(Vec3(0.5 * image::linear_from_srgb(kRed)));
  for (int channel = 0; channel < 3; ++channel) {
    EXPECT_NEAR(image.pixel(160, 100)[channel], 255 * expected[channel], 3) << channel;
  }
}

TEST(Picture, SkyAloneGivesASurfaceThatFacesItsColor) {
  frame::FrameSnapshot snapshot;
  auto stage = std::make_shared<frame::Stage>();
  stage->sky_intensity = 1;
  stage->sky_color = Vec3(1, 1, 1);
  snapshot.stage = stage;
  const Vec3 color(0.5, 0.6, 0.3);
  add_square(snapshot, frame::ObjectKind::obstacle, Vec3::Zero(), Vec3::UnitZ(), Vec3::UnitX(), 0.3).appearance.color =
      color;
  snapshot.cameras = {camera_at(Vec3(0, 0, 2), Vec3::Zero(), 40)};
  const image::Image image = Renderer(settings()).draw(snapshot);
  for (int channel = 0; channel < 3; ++channel) {
    EXPECT_NEAR(image.pixel(160, 100)[channel], 255 * color[channel], 3) << channel;
  }
}

TEST(Picture, ClothShowsItsTwoColorsOnItsTwoSides) {
  frame::FrameSnapshot snapshot = facing_square(frame::ObjectKind::cloth, 0.3, kRed);
  auto cloth = std::make_shared<frame::Surface>(*snapshot.surfaces[0]);
  cloth->appearance.back_color = kBlue;
  snapshot.surfaces[0] = cloth;
  Renderer renderer(settings());
  EXPECT_TRUE(reddish(renderer.draw(snapshot).pixel(160, 100)));
  snapshot.cameras = {camera_at(Vec3(0, 2, 0), Vec3::Zero(), 40)};
  snapshot.lights = {sun(-Vec3::UnitY())};
  const image::Image back = renderer.draw(snapshot);
  EXPECT_TRUE(bluish(back.pixel(160, 100)));
  EXPECT_EQ(count(back, reddish), 0);
}

/// A square of 0.4 m, 0.5 m above a floor, seen vertically from 4 m above the floor. Field of view 40 degrees: half the
/// height of the picture is 4 tan 20 = 1.456 m of the floor.
frame::FrameSnapshot box_over_floor(const frame::Light& light) {
  frame::FrameSnapshot snapshot;
  snapshot.stage = stage_without_sky();
  add_floor(snapshot);
  add_square(snapshot, frame::ObjectKind::obstacle, Vec3(0, 0, 0.5), Vec3::UnitZ(), Vec3::UnitX(), 0.2);
  snapshot.cameras = {camera_at(Vec3(0, 0, 4), Vec3::Zero(), 40)};
  snapshot.lights = {light};
  return snapshot;
}

/// Green level of the place `across` [m] to the right of the middle of the floor and `along` [m] above it.
int brightness(const image::Image& image, double across, double along) {
  const double scale = 0.5 * image.height / (4 * std::tan(20 * std::numbers::pi / 180));
  const int x = static_cast<int>(std::lround(0.5 * image.width + scale * across));
  const int y = static_cast<int>(std::lround(0.5 * image.height - scale * along));
  return image.pixel(x, y)[1];
}

// Light at 45 degrees displaces the shadow of an object 0.5 m above the floor by 0.5 m. In a vertical view, the roll is
// undefined, so the test accepts any direction: the shadow must be on exactly one of four sides.
TEST(Picture, ShadowLiesWhereTheLightPutsIt) {
  for (const Quality quality : {Quality::draft, Quality::preview, Quality::final}) {
    // 1 cm of the floor is 2.7 pixels. In preview quality, light is computed at a quarter of the width and height,
    // which blurs edges over 8 pixels of the picture.
    Settings large = settings(quality);
    large.width = 1280;
    large.height = 800;
    const image::Image image = Renderer(large).draw(box_over_floor(sun(Vec3(1, 0, -1))));
    int dark_sides = 0;
    for (const auto& [x, y] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
      const int center = brightness(image, 0.5 * x, 0.5 * y);
      const int just_inside = brightness(image, 0.66 * x, 0.66 * y),
                just_outside = brightness(image, 0.76 * x, 0.76 * y);
      if (center < 40) {
        ++dark_sides;
        EXPECT_LT(just_inside, 60);
        EXPECT_GT(just_outside, 150);
      } else {
        EXPECT_GT(center, 150);
      }
    }
    EXPECT_EQ(dark_sides, 1) << static_cast<int>(quality);
  }
}

// A spot 2 m above the middle. The shadow of the square, 0.5 m above the floor, has a half side of 0.2 * 2 / 1.5 =
// 0.267 m.
TEST(Picture, SpotShadowGrowsWithDistance) {
  frame::Light spot;
  spot.kind = frame::Light::Kind::spot;
  spot.position = Vec3(0, 0, 2);
  spot.target = Vec3::Zero();
  spot.cone_angle = 90;
  spot.softness = 0.5;
  frame::FrameSnapshot snapshot = box_over_floor(spot);
  Settings large = settings();
  large.width = 1280;
  large.height = 800;
  const image::Image image = Renderer(large).draw(snapshot);
  // For the camera, the square hides the floor up to 0.2 * 4 / 3.5 = 0.229 m from the middle.
  EXPECT_LT(brightness(image, 0.248, 0), 60);
  EXPECT_GT(brightness(image, 0.30, 0), 120);
  EXPECT_LT(brightness(image, 0, 0.248), 60);
  EXPECT_GT(brightness(image, 0, 0.30), 120);
  // At the floor, the cone has a radius of 2 m. There is no light outside.
  EXPECT_LT(brightness(image, 2.05, 0), 5);
}

// A vertical strip, 2 cm wide and 2 m tall, with its lower end 2 cm above the floor. From floor at least 0.5 m away, it
// hides almost no sky (form factor below 0.3 %).
TEST(Picture, ThinStripAboveTheFloorLeavesTheSkyOpenAllRound) {
  for (const Quality quality : {Quality::draft, Quality::preview, Quality::final}) {
    frame::FrameSnapshot snapshot = box_over_floor(sun(-Vec3::UnitZ()));
    auto stage = std::make_shared<frame::Stage>();
    stage->sky_intensity = 1;
    stage->sky_color = Vec3(1, 1, 1);
    snapshot.stage = stage;
    const double x = 0.01;
    snapshot.states[1].positions = {Vec3(-x, 0, 0.02), Vec3(x, 0, 0.02), Vec3(x, 0, 2.02), Vec3(-x, 0, 2.02)};
    snapshot.cameras = {camera_at(Vec3(0, -3, 5), Vec3::Zero(), 40)};
    const image::Image image = Renderer(settings(quality)).draw(snapshot);
    for (const int x_pixel : {20, 80, 120, 200, 240, 300}) {
      // Tolerance [levels]: at the borders of the picture, 2.4 m from the middle, the studio light is 4 levels darker.
      const double tolerance = std::abs(x_pixel - 160) > 100 ? 5 : 3;
      EXPECT_NEAR(image.pixel(x_pixel, 100)[1], 255 * snapshot.surfaces[0]->appearance.color[1], tolerance) << x_pixel;
    }
  }
}

// The sky gives the floor 0.6 of its colour, and the sun 0.4 with cosine 0.6: together 0.84. The program increases
// direct light until the floor shows its own colour. Three times the sun is too much, but the program does not reduce
// it. Tolerance 4 levels: half a metre from the middle, the square hides 5 % of the sky, and the studio is 1 level
// darker, together 3 levels; dithering adds 1 level.
TEST(Picture, FloorIsExposedToItsOwnColorAndNeverDarkened) {
  auto stage = std::make_shared<frame::Stage>();
  stage->sky_color = Vec3(1, 1, 1);
  stage->sky_intensity = 0.6;
  const auto draw = [&](double intensity) {
    frame::FrameSnapshot snapshot = box_over_floor(sun(Vec3(0.8, 0, -0.6)));
    snapshot.stage = stage;
    auto floor = std::make_shared<frame::Surface>(*snapshot.surfaces[0]);
    floor->appearance.color = Vec3(0.7, 0.6, 0.5);
    snapshot.surfaces[0] = floor;
    snapshot.lights[0].intensity = intensity;
    const image::Image image = Renderer(settings()).draw(snapshot);
    const std::uint8_t* pixel = image.pixel(185, 75);
    return Vec3(pixel[0], pixel[1], pixel[2]);
  };
  // A gain of 1.67 increases the light of the sun from 0.4 * 0.6 = 0.24 to 0.4.
  EXPECT_LE((draw(1) - 255 * Vec3(0.7, 0.6, 0.5)).cwiseAbs().maxCoeff(), 4) << draw(1).transpose();
  // Sky and three times the sun: 0.6 + 3 * 0.24 = 1.32.
  const Vec3 bright = image::srgb_from_linear(Vec3(1.32 * image::linear_from_srgb(Vec3(0.7, 0.6, 0.5))));
  EXPECT_LE((draw(3) - 255 * bright).cwiseAbs().maxCoeff(), 4) << draw(3).transpose();
}

TEST(Picture, ThinSheetDoesNotShadeItself) {
  frame::FrameSnapshot snapshot = facing_square(frame::ObjectKind::cloth, 0.3, Vec3(0.6, 0.6, 0.6));
  snapshot.lights = {sun(Vec3(1, 0.35, -0.4))};  // 18 degrees between light and sheet
  const image::Image image = Renderer(settings()).draw(snapshot);
  int lowest = 255, highest = 0;
  for (int y = 70; y < 130; ++y) {
    for (int x = 130; x < 190; ++x) {
      lowest = std::min<int>(lowest, image.pixel(x, y)[1]);
      highest = std::max<int>(highest, image.pixel(x, y)[1]);
    }
  }
  // Tolerance [levels]: across the sheet, the highlight changes by one or two levels with the viewing angle. Shadow
  // acne would change tens of levels.
  EXPECT_LE(highest - lowest, 6);
  EXPECT_GT(lowest, 60);
}

TEST(Picture, LayerTwoMillimetresAboveShadesTheOneBelow) {
  for (const double scale : {1.0, 0.03}) {
    frame::FrameSnapshot snapshot;
    snapshot.stage = stage_without_sky();
    add_square(snapshot, frame::ObjectKind::cloth, Vec3::Zero(), Vec3::UnitZ(), Vec3::UnitX(), 0.3 * scale);
    snapshot.cameras = {camera_at(scale * Vec3(0, -0.15, 0.15), Vec3::Zero(), 40)};
    snapshot.lights = {sun(Vec3(0.2, 0.95, -0.3))};
    Renderer renderer(settings());
    const int open = renderer.draw(snapshot).pixel(160, 100)[1];
    // For scale 1: the upper layer ends at y = -3 mm, on the side of the light. Light descends by 0.3 per 0.95 along y,
    // so the shadow extends 6.3 mm further, past the middle.
    add_square(snapshot, frame::ObjectKind::cloth, scale * Vec3(0, -0.103, 0.002), Vec3::UnitZ(), Vec3::UnitX(),
               0.1 * scale);
    const int shaded = renderer.draw(snapshot).pixel(160, 100)[1];
    EXPECT_GT(open, 90) << scale;
    EXPECT_LT(shaded, 0.6 * open) << scale;
  }
}

TEST(Picture, HeatShowsTheEndsAndTheMiddleOfTheScale) {
  auto stage = stage_without_sky();
  stage->heat = frame::Stage::Heat::strain;
  stage->heat_max = 0.5;
  Renderer renderer(settings());
  for (const double share : {0.0, 0.5, 1.0, 3.0}) {
    frame::FrameSnapshot snapshot = facing_square(frame::ObjectKind::cloth, 0.3, kRed);
    snapshot.stage = stage;
    snapshot.states[0].heat.assign(4, static_cast<float>(share * stage->heat_max));
    const image::Image image = renderer.draw(snapshot);
    const Vec3 expected = image::srgb_from_linear(image::heat_color(share));
    for (int channel = 0; channel < 3; ++channel) {
      // The tone curve compresses linear light above 0.8, so the test compares only darker values.
      if (image::linear_from_srgb(expected.maxCoeff()) > 0.8) continue;
      EXPECT_NEAR(image.pixel(160, 100)[channel], 255 * expected[channel], 4) << share << " " << channel;
    }
    if (share >= 1) {
      EXPECT_GT(image.pixel(160, 100)[1], 200);
    }
  }
}

TEST(Picture, HeatScaleFollowsTheHottestWhereNoneIsGiven) {
  auto stage = stage_without_sky();
  stage->heat = frame::Stage::Heat::speed;
  frame::FrameSnapshot snapshot = facing_square(frame::ObjectKind::cloth, 0.3, kRed);
  snapshot.stage = stage;
  snapshot.states[0].heat.assign(4, 0.01f);
  EXPECT_GT(Renderer(settings()).draw(snapshot).pixel(160, 100)[1], 200);
}

frame::FrameSnapshot busy_scene() {
  frame::FrameSnapshot snapshot;
  add_floor(snapshot);
  add_sphere(snapshot, Vec3(0, 0, 0.5), 0.5, 16);
  add_square(snapshot, frame::ObjectKind::cloth, Vec3(0, 0, 1.2), Vec3(0.2, 0, 1), Vec3::UnitY(), 0.6);
  return snapshot;
}

TEST(Picture, SameSnapshotGivesSameBytesWhateverWasDrawnBefore) {
  const frame::FrameSnapshot snapshot = busy_scene();
  frame::FrameSnapshot other = facing_square(frame::ObjectKind::cloth, 0.3, kRed);
  Renderer first(settings()), second(settings());
  CameraPath path("", settings().aspect());
  path.add_frame(snapshot);
  path.compute_cameras();
  second.set_camera_path(path);
  second.draw(other);
  const image::Image a = first.draw(snapshot), b = second.draw(snapshot), c = first.draw(snapshot);
  EXPECT_EQ(a.rgb, b.rgb);
  EXPECT_EQ(a.rgb, c.rgb);
}

/// FNV-1a hash of the picture of busy_scene().
std::uint64_t picture_hash() {
  std::uint64_t hash = 1469598103934665603ull;
  for (const std::uint8_t byte : Renderer(settings()).draw(busy_scene()).rgb) hash = (hash ^ byte) * 1099511628211ull;
  return hash;
}

TEST(PictureChild, DISABLED_PrintsItsHash) {
  std::printf("hash=%016llx\n", static_cast<unsigned long long>(picture_hash()));
}

std::string hash_with_threads(int threads) {
  // The driver reads the number of threads once per process.
  const std::string command = "LP_NUM_THREADS=" + std::to_string(threads) +
                              " /proc/self/exe --gtest_also_run_disabled_tests "
                              "--gtest_filter=PictureChild.DISABLED_PrintsItsHash";
  char path[4096];
  const ssize_t length = readlink("/proc/self/exe", path, sizeof path);
  std::string whole = command;
  // Quoted, because the name of the folder may contain a space.
  whole.replace(whole.find("/proc/self/exe"), 14, "'" + std::string(path, static_cast<std::size_t>(length)) + "'");
  FILE* pipe = popen(whole.c_str(), "r");
  std::string found;
  char line[512];
  while (pipe && std::fgets(line, sizeof line, pipe)) {
    if (std::string(line).rfind("hash=", 0) == 0) found = line;
  }
  if (pipe) pclose(pipe);
  return found;
}

TEST(Picture, SameBytesWithOneAndTwoThreads) {
  const std::string one = hash_with_threads(1), two = hash_with_threads(2);
  EXPECT_EQ(one.size(), 22u);
  EXPECT_EQ(one, two);
}

TEST(Picture, OddSnapshotsAreDrawn) {
  Renderer renderer(settings());
  frame::FrameSnapshot nothing;
  EXPECT_EQ(renderer.draw(nothing).rgb.size(), 3u * kPictureWidth * kPictureHeight);
  frame::FrameSnapshot odd;
  add_surface(odd, frame::ObjectKind::cloth, {}, {});
  add_surface(odd, frame::ObjectKind::obstacle, {Vec3::Zero()}, {{0, 0, 0}});
  add_surface(odd, frame::ObjectKind::cloth, {Vec3::Zero(), Vec3::UnitX(), 2 * Vec3::UnitX()}, {{0, 1, 2}});
  add_floor(odd).triangles.clear();
  odd.lights.assign(6, frame::Light{});
  odd.lights[1].kind = frame::Light::Kind::spot;
  odd.lights[1].target = odd.lights[1].position;
  odd.lights[2].direction = Vec3::Zero();
  odd.cameras = {camera_at(Vec3::Zero(), Vec3::Zero(), 40)};
  EXPECT_EQ(renderer.draw(odd).rgb.size(), 3u * kPictureWidth * kPictureHeight);
  frame::FrameSnapshot broken = busy_scene();
  broken.states.pop_back();
  EXPECT_THROW(renderer.draw(broken), Error);
}

// A second thread is busy, and its CPU time must not count. Expected: CPU time of the process minus that of this
// thread. Tolerance: idle TBB threads that search for work add a few percent.
TEST(Picture, TimesAreThoseOfDrawingAlone) {
  Renderer renderer(settings());
  renderer.draw(busy_scene());  // compiles the shaders
  std::atomic<bool> stop = false;
  std::atomic<double> burnt = 0;
  std::thread beside([&] {
    while (!stop) burnt = thread_cpu_seconds();
  });
  while (burnt == 0) std::this_thread::yield();
  const double whole_before = process_cpu_seconds(), burnt_before = burnt;
  renderer.draw(busy_scene());
  const double whole = process_cpu_seconds() - whole_before, others = burnt - burnt_before;
  stop = true;
  beside.join();
  EXPECT_NEAR(renderer.last_time().cpu_s, whole - others, 0.2 * (whole - others) + 2e-3) << others;
}

TEST(Picture, OneByOnePixelIsAPicture) {
  Settings tiny = settings();
  tiny.width = tiny.height = 1;
  EXPECT_EQ(Renderer(tiny).draw(busy_scene()).rgb.size(), 3u);
}

TEST(Picture, SizesOutsideTheDriversRangeAreErrors) {
  for (const auto& [width, height] : {std::pair{0, 10}, {10, -1}, {1 << 20, 10}}) {
    Settings wrong = settings();
    wrong.width = width;
    wrong.height = height;
    support::expect_error(ExitCode::usage, "--size: expected 1x1 to ", [&] { Renderer renderer(wrong); });
  }
}

/// A renderer with this backend; nullptr if its library is missing.
std::unique_ptr<Renderer> renderer_by(Backend backend, const char* library) {
  Settings wanted = settings();
  wanted.backend = backend;
  try {
    return std::make_unique<Renderer>(wanted);
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find(library), std::string::npos) << error.what();
    return nullptr;
  }
}

// A machine may have only one of the backends; then, the test is skipped.
TEST(Backend, EglDrawsTheSamePictureAsOSMesaWhereBothAreThere) {
  const auto osmesa = renderer_by(Backend::osmesa, "libOSMesa.so.8"), egl = renderer_by(Backend::egl, "libEGL.so.1");
  if (!osmesa || !egl) GTEST_SKIP() << "only one of OSMesa and EGL is there";
  EXPECT_EQ(osmesa->description().rfind("OSMesa (libOSMesa.so.8)", 0), 0u) << osmesa->description();
  EXPECT_EQ(egl->description().rfind("EGL surfaceless (libEGL.so.1)", 0), 0u) << egl->description();
  EXPECT_EQ(osmesa->draw(busy_scene()).rgb, egl->draw(busy_scene()).rgb);
}

}  // namespace
}  // namespace weft::render
