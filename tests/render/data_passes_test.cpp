// Data layers (depth, position, normal, ids, motion), compared at random pixels with a search through all triangles.
#include "film/render/data_passes.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <optional>
#include <random>
#include <sstream>

#include "film/image/exr.hpp"
#include "film/render/renderer.hpp"
#include "render/snapshots.hpp"
#include "support/test_folder.hpp"

namespace weft::render {
namespace {

constexpr int kPassWidth = 192, kPassHeight = 108;

/// A sheet that intersects a sphere, above a floor. `phase` deforms and moves the sheet, and raises the camera. `same`:
/// another frame of the run, whose surfaces this frame shares; may be null.
frame::FrameSnapshot moment(double phase, const frame::FrameSnapshot* same) {
  frame::FrameSnapshot snapshot;
  snapshot.stage = stage_without_sky();
  snapshot.cameras.push_back(camera_at({1.5, -3, 1.8 + 0.1 * phase}, {0, 0, 0.5}, 40));
  snapshot.lights.push_back(sun({-0.3, 0.4, -1}));
  add_floor(snapshot);
  add_sphere(snapshot, {0.1, 0.2, 0.4}, 0.4, 14);
  constexpr int n = 9;
  std::vector<Vec3> positions;
  std::vector<Vec2> uv;
  std::vector<std::array<Index, 3>> triangles;
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const double u = i / (n - 1.0), v = j / (n - 1.0);
      uv.emplace_back(u, 2 * v);
      positions.emplace_back(u - 0.4 + 0.2 * phase, v - 0.6, 0.5 + 0.4 * std::sin(3 * u + 4 * v + phase));
      const Index k = static_cast<Index>(positions.size()) - 1;
      if (i == 0 || j == 0) continue;
      triangles.push_back({k - n - 1, k - n, k});
      triangles.push_back({k - n - 1, k, k - 1});
    }
  }
  frame::Surface& sheet = add_surface(snapshot, frame::ObjectKind::cloth, positions, triangles);
  sheet.uv = uv;
  sheet.parts = {{"left", sheet.appearance}, {"right", sheet.appearance}};
  for (std::size_t t = 0; t < triangles.size(); ++t) sheet.part_of_triangle.push_back(t % 3 == 0);
  for (std::size_t i = 0; i < positions.size(); ++i) snapshot.states.back().heat.push_back(static_cast<float>(i) / 100);
  if (same) snapshot.surfaces = same->surfaces;
  return snapshot;
}

/// What a ray hits. `object` and `part`: as in the layers, 0 for none. `before`: where the point was in the frame
/// before.
struct Found {
  double depth = 1e9, object = 0, part = 0, heat = 0;
  Vec3 position{0, 0, 0}, before{0, 0, 0}, face{0, 0, 0}, normal{0, 0, 0};
  Vec2 uv{0, 0};
};

/// Area-weighted mean normal at a vertex, normalised.
Vec3 smooth_normal(const frame::Surface& surface, std::span<const Vec3> x, Index vertex) {
  Vec3 sum = Vec3::Zero();
  for (const auto& [a, b, c] : surface.triangles)
    if (a == vertex || b == vertex || c == vertex) sum += (x[b] - x[a]).cross(x[c] - x[a]);
  return sum.normalized();
}

/// The nearest hit of a ray, with barycentric coordinates computed from signed areas.
Found search(const frame::FrameSnapshot& now, const frame::FrameSnapshot& before, const Vec3& eye, const Vec3& along) {
  Found found;
  for (std::size_t s = 0; s < now.surfaces.size(); ++s) {
    const frame::Surface& surface = *now.surfaces[s];
    const auto& x = now.states[s].positions;
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
      const auto& [a, b, c] = surface.triangles[t];
      const Vec3 normal = (x[b] - x[a]).cross(x[c] - x[a]);
      const double depth = normal.dot(x[a] - eye) / normal.dot(along);
      if (!(depth > 0.01 && depth < found.depth)) continue;
      const Vec3 p = eye + depth * along;
      const double at_a = (x[b] - p).cross(x[c] - p).dot(normal) / normal.squaredNorm();
      const double at_b = (x[c] - p).cross(x[a] - p).dot(normal) / normal.squaredNorm(), at_c = 1 - at_a - at_b;
      if (surface.infinite_floor) {
        if (normal.dot(along) < 0) found = {depth, 1, 0, 0, p, p, normal, normal.normalized()};
        continue;
      }
      if (std::min({at_a, at_b, at_c}) < 0) continue;
      const auto& y = before.states[s].positions;
      found = {depth, 1.0 + s, 0, 0, p, at_a * y[a] + at_b * y[b] + at_c * y[c], normal, Vec3::Zero()};
      found.normal = (at_a * smooth_normal(surface, x, a) + at_b * smooth_normal(surface, x, b) +
                      at_c * smooth_normal(surface, x, c))
                         .normalized();
      if (!surface.part_of_triangle.empty()) found.part = 1 + surface.part_of_triangle[t];
      if (!surface.uv.empty()) found.uv = at_a * surface.uv[a] + at_b * surface.uv[b] + at_c * surface.uv[c];
      const auto& heat = now.states[s].heat;
      if (!heat.empty()) found.heat = at_a * heat[a] + at_b * heat[b] + at_c * heat[c];
    }
  }
  return found;
}

struct Viewer {
  ViewAxes axes;
  Vec3 eye;
  double tan_y, tan_x;

  explicit Viewer(const frame::Camera& camera)
      : axes(view_axes(camera.target - camera.position, Vec3::UnitZ())),
        eye(camera.position),
        tan_y(std::tan(radians(camera.field_of_view) / 2)),
        tan_x(tan_y * kPassWidth / kPassHeight) {}
  Vec3 along(const Vec2& pixel) const {
    return axes.forward + (2 * pixel.x() / kPassWidth - 1) * tan_x * axes.right +
           (2 * pixel.y() / kPassHeight - 1) * tan_y * axes.up;
  }
  Vec2 pixel(const Vec3& p) const {
    const Vec3 to = (p - eye) / (p - eye).dot(axes.forward);
    return {(1 + to.dot(axes.right) / tan_x) * kPassWidth / 2, (1 + to.dot(axes.up) / tan_y) * kPassHeight / 2};
  }
};

class DataPassesTest : public support::TestFolder {
 protected:
  static Settings pass_settings() {
    Settings settings;
    settings.width = kPassWidth;
    settings.height = kPassHeight;
    settings.layers = true;
    return settings;
  }
  // Layers of `now`, with the motion since `before`.
  static image::Layers layers_of(const frame::FrameSnapshot& now, const frame::FrameSnapshot& before,
                                 std::optional<frame::Stage::Look> look = {}) {
    Settings settings = pass_settings();
    settings.look = look;
    Renderer renderer(settings);
    renderer.draw(now, &before);
    return renderer.layers();
  }
  static void SetUpTestSuite() {
    Renderer renderer(pass_settings());
    first_ = moment(0, nullptr), second_ = moment(1, &first_);
    renderer.draw(first_);
    still_ = renderer.layers();
    picture_ = renderer.draw(second_, &first_);
    layers_ = renderer.layers();
  }
  static float value(const image::Layers& layers, const std::string& name, int x, int y) {
    for (const image::Layers::Channel& channel : layers.channels)
      if (channel.name == name) return channel.values[static_cast<std::size_t>(kPassHeight - 1 - y) * kPassWidth + x];
    ADD_FAILURE() << "no channel " << name;
    return 0;
  }

  static void expect_exact(const image::Layers& layers, int top, int rows);

  static inline frame::FrameSnapshot first_, second_;
  static inline image::Layers still_, layers_;
  static inline image::Image picture_;
};

/// Checks 1,000 random pixels of `rows` rows.
void DataPassesTest::expect_exact(const image::Layers& layers, int top, int rows) {
  const Viewer viewer(second_.cameras[0]), viewer_before(first_.cameras[0]);
  std::mt19937 random(1);
  int counts[4] = {}, beside = 0;
  for (int k = 0; k < 1000; ++k) {
    const int x = static_cast<int>(random() % kPassWidth),
              y = kPassHeight - 1 - top - static_cast<int>(random() % rows);
    const Vec2 pixel(x + 0.5, y + 0.5);
    const Found found = search(second_, first_, viewer.eye, viewer.along(pixel));
    const auto at = [&](const char* name) { return value(layers, name, x, y); };
    if (at("id.object") != found.object || at("id.part") != found.part) {
      ++beside;  // at an edge, rounding decides which surface the centre shows
      continue;
    }
    ++counts[static_cast<int>(found.object)];
    if (found.object == 0) {
      EXPECT_TRUE(std::isinf(at("depth.Z")));
      continue;
    }
    // Tolerance [m]: the layers are 32-bit floats, whose rounding error grows with the distance.
    const double rounding = 2e-7 * std::max(1.0, found.depth);
    EXPECT_NEAR(at("depth.Z"), found.depth, rounding);
    EXPECT_NEAR(at("position.X"), found.position.x(), rounding);
    EXPECT_NEAR(at("position.Y"), found.position.y(), rounding);
    EXPECT_NEAR(at("position.Z"), found.position.z(), rounding);
    EXPECT_NEAR(at("uv.U"), found.uv.x(), 1e-6);
    EXPECT_NEAR(at("uv.V"), found.uv.y(), 1e-6);
    EXPECT_NEAR(at("heat.V"), found.heat, 1e-6);
    const Vec2 motion = pixel - viewer_before.pixel(found.before);
    EXPECT_NEAR(at("motion.X"), motion.x(), 1e-5);
    EXPECT_NEAR(at("motion.Y"), motion.y(), 1e-5);
    // The normal faces the viewer. No edge is a crease: faces around a vertex of the sphere (object 2) differ by up to
    // 18 degrees, less than its crease angle. At its edges, the layers may show the other one of two triangles.
    const Vec3 normal(at("normal.X"), at("normal.Y"), at("normal.Z"));
    const Vec3 expected = found.normal * (found.face.dot(viewer.along(pixel)) > 0 ? -1 : 1);
    EXPECT_LT((normal - expected).norm(), found.object == 2 ? 1e-5 : 1e-6);
  }
  EXPECT_LE(beside, 2);
  EXPECT_GT(std::min({counts[1], counts[2], counts[3]}), 30) << "floor, sphere and sheet";
}

TEST_F(DataPassesTest, AreThoseOfASearchThroughAllTriangles) {
  expect_exact(layers_, 0, kPassHeight);
}

// Writes some rows of the layers to an OpenEXR file. A program of OpenImageIO prints this file: the channel names in
// order, then one line for each pixel. The printed values are compared with the search.
TEST_F(DataPassesTest, AreReadBackByOpenImageIOAsThoseOfASearch) {
  constexpr int kTop = 44, kRows = 20;
  image::Layers rows{kPassWidth, kRows, layers_.channels};
  for (image::Layers::Channel& channel : rows.channels) {
    channel.values.erase(channel.values.begin(), channel.values.begin() + kTop * kPassWidth);
    channel.values.resize(kRows * kPassWidth);
  }
  const std::string file = (folder_ / "a.exr").string(), out = (folder_ / "out").string();
  image::write_exr(file, rows);
  const int status = std::system(fmt::format("oiiotool --info -v --dumpdata '{}' >'{}'", file, out).c_str());
  if (WEXITSTATUS(status) == 127) GTEST_SKIP() << "oiiotool is not here: apt-get install openimageio-tools";
  ASSERT_EQ(status, 0);
  const std::string printed = support::read_bytes(out);
  image::Layers read{kPassWidth, kPassHeight, {}};
  constexpr std::string_view kList = "channel list: ";
  std::istringstream names(printed.substr(printed.find(kList) + kList.size()));
  for (std::string name, depth = ","; depth.back() == ',' && names >> name >> depth;)
    read.channels.push_back({name, std::vector<float>(std::size_t{kPassWidth} * kPassHeight)});
  ASSERT_EQ(read.channels.size(), layers_.channels.size());
  std::istringstream lines(printed);
  int pixels = 0;
  for (std::string line; std::getline(lines, line);) {
    int x = 0, y = 0, at = 0;
    if (std::sscanf(line.c_str(), " Pixel (%d, %d):%n", &x, &y, &at) < 2 || at == 0) continue;
    const char* text = line.c_str() + at;
    for (image::Layers::Channel& channel : read.channels) {
      char* end = nullptr;
      channel.values[static_cast<std::size_t>(kTop + y) * kPassWidth + x] = std::strtof(text, &end);
      text = end;
    }
    ++pixels;
  }
  EXPECT_EQ(pixels, kPassWidth * kRows);
  expect_exact(read, kTop, kRows);
}

TEST_F(DataPassesTest, NothingMovesWithoutAFrameBefore) {
  const std::vector<float> none(std::size_t{kPassWidth} * kPassHeight, 0.0f);
  int count = 0;
  for (const image::Layers::Channel& channel : still_.channels) {
    if (!channel.name.starts_with("motion")) continue;
    EXPECT_EQ(channel.values, none);
    ++count;
  }
  EXPECT_EQ(count, 2);
}

TEST_F(DataPassesTest, ACutOfTheCameraIsNoMotion) {
  frame::FrameSnapshot now = second_;
  now.cameras[0].shot = 1;
  now.cameras[0].position += Vec3(0.5, 0, 0);
  const image::Layers layers = layers_of(now, second_);
  for (const char* name : {"motion.X", "motion.Y"})
    for (int y = 0; y < kPassHeight; ++y)
      for (int x = 0; x < kPassWidth; ++x) ASSERT_NEAR(value(layers, name, x, y), 0, 1e-5);
}

// The look `strain` refuses to draw frames without heat. The motion needs only the positions of the frame before.
TEST_F(DataPassesTest, MotionNeedsNoHeatOfTheFrameBefore) {
  frame::FrameSnapshot before = first_, now = second_;
  auto stage = std::make_shared<frame::Stage>(*now.stage);
  stage->heat = frame::Stage::Heat::strain;
  before.stage = now.stage = stage;
  for (frame::SurfaceState& state : before.states) state.heat.clear();
  const image::Layers layers = layers_of(now, before, frame::Stage::Look::strain);
  for (const char* name : {"motion.X", "motion.Y"})
    for (int y = 0; y < kPassHeight; ++y)
      for (int x = 0; x < kPassWidth; ++x) ASSERT_EQ(value(layers, name, x, y), value(layers_, name, x, y));
}

// Between the frames, the camera moves backward past a square. In the frame before, the square was behind the camera.
TEST_F(DataPassesTest, WhatWasBehindTheCameraDoesNotMove) {
  frame::FrameSnapshot before;
  before.stage = stage_without_sky();
  add_square(before, frame::ObjectKind::obstacle, Vec3(0.1, -0.5, 0.05), -Vec3::UnitY(), Vec3::UnitX(), 0.05);
  before.cameras = {camera_at(Vec3::Zero(), Vec3(0, 2, 0), 40)};
  frame::FrameSnapshot now = before;
  now.cameras = {camera_at(Vec3(0, -1, 0), Vec3(0, 2, 0), 40)};
  const image::Layers layers = layers_of(now, before);
  int count = 0;
  for (int y = 0; y < kPassHeight; ++y) {
    for (int x = 0; x < kPassWidth; ++x) {
      if (value(layers, "id.object", x, y) != 2) continue;
      ++count;
      EXPECT_EQ(value(layers, "motion.X", x, y), 0);
      EXPECT_EQ(value(layers, "motion.Y", x, y), 0);
    }
  }
  EXPECT_GT(count, 100);
}

TEST_F(DataPassesTest, SurfacesAreThoseOfThePictureTimesTheirCoverage) {
  int whole = 0, same = 0, partly = 0;
  for (int y = 0; y < kPassHeight; ++y) {
    for (int x = 0; x < kPassWidth; ++x) {
      const float alpha = value(layers_, "A", x, y), red = value(layers_, "R", x, y);
      EXPECT_GE(alpha, 0);
      EXPECT_LE(alpha, 1);
      EXPECT_LE(red, alpha) << "times coverage, at " << x << " " << y;
      if (alpha == 1) {
        ++whole;
        same += red == value(layers_, "picture.R", x, y);
      }
      partly += alpha > 0 && alpha < 1;
    }
  }
  EXPECT_GT(whole, 1000);
  // About half of the fully covered pixels are at folds. In these pixels, the picture is a mean of encoded colours, but
  // the layer is a mean of linear colours.
  EXPECT_GT(same, 0.45 * whole);
  EXPECT_GT(partly, 100) << "outlines are smooth";
}

// On open floor, caught.A is the fraction of the light that shadows block. The sun is the only light, so caught.A must
// be near 1 where a ray toward the sun hits something, and near 0 elsewhere. At most 5 % of the pixels may be in
// between: in the penumbra.
TEST_F(DataPassesTest, CaughtShadowsAreWhereNoSunGetsTo) {
  const Vec3 toward_sun = Vec3(0.3, -0.4, 1).normalized();
  int lit = 0, dark = 0, otherwise = 0;
  for (int y = 0; y < kPassHeight; y += 2) {
    for (int x = 0; x < kPassWidth; x += 2) {
      const auto at = [&](const char* name) { return value(layers_, name, x, y); };
      const float caught = at("caught.A"), covered = at("A");
      EXPECT_GE(caught, covered - 1e-3f);
      if (covered > 0 || at("id.object") != 1) continue;
      const Vec3 from(at("position.X"), at("position.Y"), at("position.Z") + 1e-4);
      const bool hidden = search(second_, first_, from, toward_sun).depth < 1e8;
      lit += !hidden && caught < 0.05f;
      dark += hidden && caught > 0.9f;
      otherwise += hidden ? caught <= 0.9f : caught >= 0.05f;
    }
  }
  EXPECT_GT(lit, 500);
  EXPECT_GT(dark, 50);
  EXPECT_LT(otherwise, 0.05 * (lit + dark));
}

}  // namespace
}  // namespace weft::render
