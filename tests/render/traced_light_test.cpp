// Traced light: which surfaces rays hit, what these surfaces reflect, and how the noise of few rays is removed.
#include "film/render/traced_light.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "film/image/color.hpp"
#include "film/render/joint_filter.hpp"
#include "film/render/renderer.hpp"
#include "film/render/shading.hpp"
#include "render/scaled_pictures.hpp"
#include "render/snapshots.hpp"

namespace weft::render {
namespace {

using Eigen::Vector3f;

/// A mesh with its own vertices and triangles.
struct Mesh {
  std::vector<Vec3> positions;
  std::vector<Triangle> triangles;
  DrawnMesh drawn(float opacity = 1) const { return {positions, triangles, nullptr, opacity}; }
};

/// A horizontal rectangle of 2a x 2b at height c that faces down.
Mesh rectangle(double a, double b, double c) {
  return {{Vec3(-a, -b, c), Vec3(-a, b, c), Vec3(a, b, c), Vec3(a, -b, c)}, {{0, 1, 2}, {0, 2, 3}}};
}

/// Distance to the nearest triangle along a ray, as a multiple of the length of `way`; infinity if there is none
/// (Moeller and Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", 1997).
double nearest_by_brute_force(const Mesh& mesh, const Vec3& start, const Vec3& way) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3 u = mesh.positions[b] - mesh.positions[a], v = mesh.positions[c] - mesh.positions[a], p = way.cross(v);
    const Vec3 from = start - mesh.positions[a], q = from.cross(u);
    const double det = u.dot(p), to_b = from.dot(p) / det, to_c = way.dot(q) / det, t = v.dot(q) / det;
    if (to_b >= 0 && to_c >= 0 && to_b + to_c <= 1 && t > 0) nearest = std::min(nearest, t);
  }
  return nearest;
}

TEST(RayScene, FindsWhatBruteForceFinds) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-1, 1);
  const auto anywhere = [&] { return Vec3(place(random), place(random), place(random)); };
  Mesh mesh;
  for (Index t = 0; t < 200; ++t) {
    const Vec3 corner = anywhere();
    for (int k = 0; k < 3; ++k) mesh.positions.emplace_back(corner + 0.2 * anywhere());
    mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  RayScene scene;
  const DrawnMesh drawn = mesh.drawn();
  scene.build({&drawn, 1});
  int met = 0;
  for (int packet = 0; packet < 100; ++packet) {
    Rays rays;
    rays.wanted = Mask::Constant(-1);
    rays.wanted[3] = 0;
    for (int lane = 0; lane < kLanes; ++lane) {
      rays.origin.set(lane, anywhere().cast<float>());
      rays.direction.set(lane, anywhere().cast<float>());
    }
    const Hits hits = scene.nearest(rays);
    const Lanes blocked = scene.blocked(rays);
    for (int lane = 0; lane < kLanes; ++lane) {
      if (lane == 3) {
        EXPECT_EQ(hits.mesh[lane], Hits::kNone);
        EXPECT_EQ(blocked[lane], 0);
        continue;
      }
      const double expected =
          nearest_by_brute_force(mesh, rays.origin.at(lane).cast<double>(), rays.direction.at(lane).cast<double>());
      ASSERT_EQ(hits.mesh[lane] == 0, std::isfinite(expected)) << packet << ", " << lane;
      EXPECT_EQ(blocked[lane], std::isfinite(expected) ? 1 : 0);
      if (!std::isfinite(expected)) continue;
      EXPECT_NEAR(hits.distance[lane], expected, 1e-4 * (1 + expected));
      ++met;
    }
  }
  EXPECT_GT(met, 100);
}

TEST(RayScene, TranslucentClothStopsItsFractionOfRays) {
  const Mesh mesh = rectangle(1, 1, 1);
  const DrawnMesh drawn = mesh.drawn(0.3f);
  RayScene scene;
  scene.build({&drawn, 1});
  double blocked = 0;
  constexpr int kPackets = 2000;
  for (int packet = 0; packet < kPackets; ++packet) {
    Rays rays;
    rays.wanted = Mask::Constant(-1);
    rays.direction.z.setOnes();
    rays.origin.x.setConstant(0.3f);  // not on the edge that two triangles share
    rays.seed = static_cast<unsigned>(packet);
    blocked += scene.blocked(rays).sum();
  }
  // Tolerance: four standard deviations of 16,000 rays.
  EXPECT_NEAR(blocked / (kLanes * kPackets), 0.3, 4 * std::sqrt(0.3 * 0.7 / (kLanes * kPackets)));
}

/// Fraction of a cosine lobe that a rectangle of 2a x 2b at distance c covers, seen from below its middle: four times
/// that of a quarter, seen from below its corner (Howell, "A Catalog of Radiation Heat Transfer Configuration Factors",
/// B-4).
double form_factor(double a, double b, double c) {
  const double x = a / c, y = b / c, p = std::sqrt(1 + x * x), q = std::sqrt(1 + y * y);
  return 4 / (2 * std::numbers::pi) * (x / p * std::atan(y / p) + y / q * std::atan(x / q));
}

/// White on both sides of the two triangles of a rectangle.
const ReflectingSurface kWhiteRectangle{{{2, Vector3f::Ones(), Vector3f::Ones()}}};

Irradiance no_light() {
  Irradiance irradiance;
  irradiance.fill(Vec3::Zero());
  return irradiance;
}

/// The mean over `count` rays from the origin, distributed about +z in proportion to their cosine.
ReflectedLight::Arriving mean_arriving(const ReflectedLight& light, int count) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> uniform(0, 1);
  float open = 0;
  Vector3f sum = Vector3f::Zero();
  for (int packet = 0; packet < count / kLanes; ++packet) {
    Rays rays;
    rays.wanted = Mask::Constant(-1);
    for (int lane = 0; lane < kLanes; ++lane) {
      const float r = std::sqrt(uniform(random)), turn = 2 * std::numbers::pi_v<float> * uniform(random);
      rays.direction.set(lane, {r * std::cos(turn), r * std::sin(turn), std::sqrt(1 - r * r)});
    }
    const ReflectedLight::Arriving arriving = light.arriving(rays);
    open += arriving.open.sum();
    for (int lane = 0; lane < kLanes; ++lane) sum += arriving.light.at(lane);
  }
  ReflectedLight::Arriving mean;
  mean.open[0] = open / static_cast<float>(count);
  mean.light.set(0, sum / static_cast<float>(count));
  return mean;
}

TEST(ReflectedLight, OfARectangleIsItsFormFactor) {
  constexpr int kRays = 80000;
  // A sun from below lights the rectangle fully.
  const Lamp lamp = make_lamp(sun(Vec3::UnitZ()), Vec3::Ones());
  for (const double height : {0.2, 0.5, 2.0}) {
    const Mesh mesh = rectangle(0.5, 0.3, height);
    const DrawnMesh drawn = mesh.drawn();
    RayScene scene;
    scene.build({&drawn, 1});
    const ReflectedLight light(scene, {{{{2, Vector3f(1, 0.5f, 0), Vector3f::Zero()}}}}, {lamp}, no_light(), {},
                               Vector3f::Zero());
    const ReflectedLight::Arriving found = mean_arriving(light, kRays);
    const double expected = form_factor(0.5, 0.3, height);
    const double noise = 4 * std::sqrt(expected * (1 - expected) / kRays);
    EXPECT_NEAR(1 - found.open[0], expected, noise) << height;
    EXPECT_NEAR(found.light.at(0).x(), expected, noise) << height;
    EXPECT_NEAR(found.light.at(0).y(), 0.5 * expected, noise) << height;
  }
}

TEST(Lamps, ASpotHasTheConeOfItsScene) {
  frame::Light spot;
  spot.kind = frame::Light::Kind::spot;
  for (const double angle : {1.0, 45.0, 170.0}) {
    spot.cone_angle = angle;
    EXPECT_NEAR(make_lamp(spot, Vec3::Ones()).packed.position.w(), std::cos(radians(angle) / 2), 1e-6) << angle;
  }
}

TEST(ReflectedLight, SurfacesAreShadedByOthers) {
  // The second mesh, a plate, is between the sun and the first.
  std::vector<Mesh> meshes{rectangle(0.5, 0.5, 1), rectangle(1, 1, -1)};
  std::vector<DrawnMesh> drawn;
  for (const Mesh& mesh : meshes) drawn.push_back(mesh.drawn());
  RayScene scene;
  scene.build(drawn);
  const ReflectedLight light(scene, {kWhiteRectangle, kWhiteRectangle}, {make_lamp(sun(Vec3::UnitZ()), Vec3::Ones())},
                             no_light(), {}, Vector3f::Zero());
  EXPECT_EQ(mean_arriving(light, 8000).light.at(0), Vector3f::Zero());
}

TEST(ReflectedLight, TheFloorHidesWhatIsBelowIt) {
  // Seen from the origin, the floor is in front of a plate that the sun would light.
  const Mesh mesh = rectangle(10, 10, 1.5);
  const DrawnMesh drawn = mesh.drawn();
  RayScene scene;
  scene.build({&drawn, 1});
  const ReflectedLight light(scene, {kWhiteRectangle}, {make_lamp(sun(Vec3::UnitZ()), Vec3::Ones())}, no_light(),
                             Floor{Vec3(0, 0, 1), Vec3(0, 0, -1), {}}, Vector3f::Ones());
  const ReflectedLight::Arriving found = mean_arriving(light, 8000);
  EXPECT_EQ(found.open[0], 1);
  EXPECT_EQ(found.light.at(0), Vector3f::Zero());
}

// The surroundings already contain a floor that is lit by suns but not by spots. Thus a spot adds its light on the
// floor, and a shadow on the floor subtracts the light of a sun. A white floor is 1 m above the origin; the lamp is far
// below it, in the second case behind a plate.
TEST(ReflectedLight, FloorInTheLightOfASpotAddsThisLight) {
  frame::Light spot;
  spot.kind = frame::Light::Kind::spot;
  spot.position = Vec3(0, 0, -1000);
  spot.target = Vec3(0, 0, 1);
  spot.cone_angle = 90;
  const Mesh plate = rectangle(1000, 1000, -0.5);
  for (const bool shaded : {false, true}) {
    const std::vector<DrawnMesh> drawn(shaded ? 1 : 0, plate.drawn());
    RayScene scene;
    scene.build(drawn);
    const auto reflected = [&](const frame::Light& light) {
      const ReflectedLight reflection(scene, {kWhiteRectangle}, {make_lamp(light, Vec3::Ones())}, no_light(),
                                      Floor{Vec3(0, 0, 1), Vec3(0, 0, -1), {}}, Vector3f::Ones());
      return mean_arriving(reflection, 8000).light.at(0).x();
    };
    EXPECT_NEAR(reflected(sun(Vec3::UnitZ())), shaded ? -1 : 0, 0.01);
    EXPECT_NEAR(reflected(spot), shaded ? 0 : 1, 0.01);
  }
}

TEST(ReflectedLight, HolesOfPicturesDoNotDarkenTheirColor) {
  frame::Texture lace{2, 1, {255, 0, 0, 255, 0, 0, 0, 0}};
  frame::Appearance look;
  look.color = Vec3::Ones();
  look.paint.texture = std::make_shared<const frame::Texture>(lace);
  MeanColors colors;
  look.paint.alpha = frame::Paint::Alpha::ignored;
  EXPECT_EQ(colors.of(look, false), Vector3f(0.5f, 0, 0));
  look.paint.alpha = frame::Paint::Alpha::cutout;
  EXPECT_EQ(colors.of(look, false), Vector3f(1, 0, 0));
}

TEST(ReflectedLight, OfClayHasNoColorOfPictures) {
  frame::Surface lace, bare;
  lace.appearance.paint.texture =
      std::make_shared<const frame::Texture>(frame::Texture{2, 1, {255, 0, 0, 255, 0, 0, 0, 0}});
  lace.appearance.paint.alpha = frame::Paint::Alpha::cutout;
  MeanColors colors;
  for (const bool back : {false, true})
    EXPECT_EQ(colors.of(material_of(lace, true).appearance, back), colors.of(material_of(bare, true).appearance, back));
}

// A quarter of the surface shows the whole picture; around it, the surface shows its colour.
TEST(ReflectedLight, PictureThatLiesOnceHidesTheColorOnlyWhereItLies) {
  frame::Surface surface;
  surface.triangles = {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}};
  surface.uv = {Vec2(0, 0), Vec2(1, 0), Vec2(1, 1), Vec2(0, 1), Vec2(4, 0), Vec2(4, 1)};
  std::vector<Vec3> positions;
  for (const Vec2& uv : surface.uv) positions.emplace_back(uv.x(), uv.y(), 0);
  frame::Appearance& look = surface.appearance;
  look.color = Vec3(0, 0, 1);
  look.paint.texture = std::make_shared<const frame::Texture>(frame::Texture{1, 1, {255, 0, 0, 255}});
  ShadedMesh mesh = make_shaded_mesh(surface.triangles, CornerMap(surface.triangles, positions.size()), positions, 180);
  const PaintedMesh painted = make_painted_mesh(surface, mesh);
  ASSERT_EQ(painted.ranges.size(), 1u);
  const auto color = [&] {
    const double covered = covered_fraction(painted, painted.ranges[0], mesh.triangles, positions);
    return Vector3f(MeanColors().of(look, false, covered));
  };
  EXPECT_EQ(color(), Vector3f(0, 0, 0)) << "repeated: multiplied by the colour everywhere";
  look.paint.wrap_u = frame::Paint::Wrap::once;
  EXPECT_TRUE(color().isApprox(Vector3f(0.25f, 0, 0.75f))) << color().transpose();
  look.paint.alpha = frame::Paint::Alpha::over_color;
  EXPECT_TRUE(color().isApprox(Vector3f(0.25f, 0, 0.75f))) << color().transpose();
}

/// Points of two planes that face the viewer: at 1 m in the left half of the picture, at 1.1 m in the right half.
struct TwoPlanes {
  static constexpr int kWidth = 40, kHeight = 24;
  std::vector<Seen> seen;
  std::vector<Eigen::Vector4f> normals;
  View view;

  TwoPlanes() {
    view.tan_half_width = view.tan_half_height = 0.5;
    for (int i = 0; i < kWidth * kHeight; ++i) {
      const bool left = i % kWidth < kWidth / 2;
      seen.push_back({left ? 1.0f : 1.1f, static_cast<float>(left ? kFirstSurface : kFirstSurface + 1)});
      normals.emplace_back(0, 0, 1, 0);
    }
  }
  PixelPoints points(int divisor) const {
    PixelPoints result(kWidth, kHeight, divisor);
    const PixelPoints::Kind kinds[] = {PixelPoints::Kind::solid, PixelPoints::Kind::solid};
    result.read(seen, normals, kinds, view, {});
    return result;
  }
};

TEST(JointFilter, AveragesNoiseButNotTwoSurfaces) {
  const PixelPoints points = TwoPlanes().points(1);
  std::vector<Plane> planes(1, Plane(points.width(), points.height(), 0)), scratch = planes;
  std::mt19937 random(5);
  std::uniform_real_distribution<float> noise(-0.1f, 0.1f);
  const auto level = [&](int x) { return x < points.width() / 2 ? 0.2f : 0.8f; };
  for (int y = 0; y < points.height(); ++y)
    for (int x = 0; x < points.width(); ++x) planes[0].row(y)[x] = level(x) + noise(random);
  for (const int step : {1, 2}) smooth(planes, scratch, points, step);
  for (int y = 0; y < points.height(); ++y)
    for (int x = 0; x < points.width(); ++x)
      // Noise of 0.058 rms is averaged over 25 points (over 9 in corners). Tolerance: four standard deviations of 9.
      EXPECT_NEAR(planes[0].row(y)[x], level(x), 4 * 0.058 / 3) << x << ", " << y;
}

TEST(JointFilter, AveragesAsManyPointsOfAnObliquePlaneAsOfAFacingOne) {
  constexpr int kPoints = 48;
  const auto remaining_noise = [](bool oblique) {
    View view;
    view.tan_half_width = view.tan_half_height = 0.1;
    std::vector<Seen> seen;
    for (int i = 0; i < kPoints * kPoints; ++i) {
      // The rays of view meet the oblique plane at angles of 4 to 15 degrees.
      const float high = 0.1f * (2 * (static_cast<float>(i / kPoints) + 0.5f) / kPoints - 1);
      seen.push_back({oblique ? 0.2f / (0.05f - 0.3f * high) : 1.0f, static_cast<float>(kFirstSurface)});
    }
    const Vector3f normal = oblique ? Vector3f(0, 0.3f, 0.05f).normalized() : Vector3f(0, 0, 1);
    const std::vector<Eigen::Vector4f> normals(seen.size(), {normal.x(), normal.y(), normal.z(), 0});
    PixelPoints points(kPoints, kPoints, 1);
    const PixelPoints::Kind kinds[] = {PixelPoints::Kind::solid};
    points.read(seen, normals, kinds, view, {});
    std::vector<Plane> planes(1, Plane(kPoints, kPoints, 0)), scratch = planes;
    std::mt19937 random(5);
    std::uniform_real_distribution<float> noise(-0.05f, 0.05f);
    for (int y = 0; y < kPoints; ++y)
      for (int x = 0; x < kPoints; ++x) planes[0].row(y)[x] = noise(random);
    for (const int step : {1, 2, 4}) smooth(planes, scratch, points, step);
    float sum = 0;
    for (int y = 8; y < kPoints - 8; ++y)
      for (int x = 8; x < kPoints - 8; ++x) sum += planes[0].row(y)[x] * planes[0].row(y)[x];
    return std::sqrt(sum);
  };
  EXPECT_LT(remaining_noise(true), 1.2f * remaining_noise(false));
}

TEST(JointFilter, InterpolationKeepsSurfacesApartAndFollowsSlopes) {
  const TwoPlanes picture;
  for (const int divisor : {2, 4}) {
    const PixelPoints few = picture.points(divisor), many = picture.points(1);
    const auto value = [&](float pixel, bool left) { return left ? 0.01f * pixel : 5.0f; };
    std::vector<Eigen::Vector4f> values, results(picture.seen.size());
    for (int y = 0; y < few.height(); ++y)
      for (int x = 0; x < few.width(); ++x) {
        const int pixel = x * divisor + divisor / 2;
        values.push_back(Eigen::Vector4f::Constant(value(static_cast<float>(pixel), pixel < TwoPlanes::kWidth / 2)));
      }
    interpolate(values, few, many, 0, many.height(), results);
    for (int y = 0; y < many.height(); ++y)
      for (int x = 0; x < many.width(); ++x) {
        const bool left = x < TwoPlanes::kWidth / 2;
        // Tolerance: at the borders of a surface and of the picture, the value of the nearest point is kept, which is
        // less than `divisor` pixels away.
        EXPECT_NEAR(results[static_cast<std::size_t>(y) * many.width() + x][0], value(static_cast<float>(x), left),
                    left ? 0.01 * divisor : 1e-3)
            << divisor << ": " << x << ", " << y;
      }
  }
}

TEST(JointFilter, InterpolationFollowsSlopesFromTheLowestRowOn) {
  const TwoPlanes picture;
  for (const int divisor : {2, 4}) {
    const PixelPoints few = picture.points(divisor), many = picture.points(1);
    std::vector<Eigen::Vector4f> values, results(picture.seen.size());
    for (int y = 0; y < few.height(); ++y)
      for (int x = 0; x < few.width(); ++x) values.push_back(Eigen::Vector4f::Constant(static_cast<float>(y)));
    interpolate(values, few, many, 0, many.height(), results);
    const int first = divisor / 2, last = first + divisor * (few.height() - 1);
    for (int y = first; y <= last; ++y)
      EXPECT_NEAR(results[static_cast<std::size_t>(y) * many.width()][0], 1.0 * (y - first) / divisor, 1e-5)
          << divisor << ": " << y;
  }
}

/// Fraction of a disc of radius 1 that is beyond a line at distance d from its centre; d is negative if the centre is
/// beyond the line.
double beyond_line(double d) {
  if (d <= -1) return 1;
  if (d >= 1) return 0;
  return (std::acos(d) - d * std::sqrt(1 - d * d)) / std::numbers::pi;
}

/// A plate 1 m above the floor, with an edge at x = 0. The sun is overhead, and 8 degrees wide.
frame::FrameSnapshot plate_above_floor() {
  frame::FrameSnapshot snapshot;
  snapshot.stage = stage_without_sky();
  add_floor(snapshot).appearance.color = Vec3::Constant(0.5);
  add_square(snapshot, frame::ObjectKind::obstacle, Vec3(-1.5, 0, 1), Vec3::UnitZ(), Vec3::UnitX(), 1.5)
      .appearance.color = Vec3::Zero();
  snapshot.lights = {sun(Vec3(0, 0, -1))};
  snapshot.lights[0].softness = 8;
  return snapshot;
}

TEST(TracedLight, PenumbraOfAnEdgeIsThatOfTheSunsDisc) {
  frame::FrameSnapshot snapshot = plate_above_floor();
  constexpr int kPixels = 200, kRows = 20;
  const double radius = std::tan(4 * std::numbers::pi / 180);
  const double lit = image::linear_from_srgb(Vec3::Constant(0.5)).x();
  // First view: the whole penumbra, 100 pixels wide. Second view: the lit half of the penumbra, which is 300 pixels
  // wide.
  for (const auto& [field_of_view, aim] : {std::pair(12.0, 0.0), std::pair(4.0, 0.05)}) {
    const Vec3 target(aim, 0, 0), away(0, -1.2, 0.6);
    snapshot.cameras = {camera_at(target + away, target, field_of_view)};
    const double tangent = std::tan(0.5 * field_of_view * std::numbers::pi / 180);
    const Vec3 forward = -away.normalized(), up = Vec3::UnitX().cross(forward);
    for (const Quality quality : {Quality::draft, Quality::preview, Quality::final}) {
      Settings settings;
      settings.width = settings.height = kPixels;
      settings.quality = quality;
      const image::Image image = Renderer(settings).draw(snapshot);
      for (int x = 0; x < kPixels; ++x) {
        double found = 0, expected = 0;
        for (int y = kPixels / 2 - kRows / 2; y < kPixels / 2 + kRows / 2; ++y) {
          const Vec3 ray = forward + tangent * (1 - 2 * (y + 0.5) / kPixels) * up;
          const double place = aim + away.z() / -ray.z() * tangent * (2 * (x + 0.5) / kPixels - 1);
          found += image::linear_from_srgb(Vec3::Constant(image.pixel(x, y)[1] / 255.0)).x() / lit / kRows;
          expected += beyond_line(-place / radius) / kRows;
        }
        // Tolerance: the filter spans at most 25 of 100 pixels; the noise of 4 rays for each of 400 pixels is below
        // 0.01.
        EXPECT_NEAR(found, expected, 0.03) << field_of_view << ", " << static_cast<int>(quality) << ": " << x;
      }
    }
  }
}

// The picture shows the lit half of a penumbra 300 pixels wide. Stripes are measured as second differences, from column
// to column, of means over 16 rows.
TEST(TracedLight, WidePenumbraHasNoStripes) {
  frame::FrameSnapshot snapshot = plate_above_floor();
  const Vec3 target(0.05, 0, 0);
  snapshot.cameras = {camera_at(target + Vec3(0, -1.2, 0.6), target, 4)};
  constexpr int kPixels = 200, kRows = 16, kFirst = 10, kEnd = 130;
  Settings settings;
  settings.width = settings.height = kPixels;
  Renderer renderer(settings);
  renderer.draw(snapshot);
  const image::Image16 image = renderer.image16();
  const double lit = image::linear_from_srgb(0.5);
  double sum = 0;
  int count = 0;
  for (int top = 0; top + kRows <= kPixels; top += kRows) {
    std::vector<double> means(kPixels);
    for (int y = top; y < top + kRows; ++y)
      for (int x = 0; x < kPixels; ++x)
        means[x] += image::linear_from_srgb(image.rgb[3 * (y * kPixels + x)] / 65535.0) / lit / kRows;
    for (int x = kFirst; x < kEnd; ++x, ++count) sum += std::pow(means[x] / 2 - (means[x - 1] + means[x + 1]) / 4, 2);
  }
  // Root mean square, as a fraction of full light. A model of rays and filters gives 0.0004; if the rays were rotated
  // by a Bayer matrix, it would give 0.0024.
  EXPECT_LT(std::sqrt(sum / count), 0.001);
}

// At coordinates of 5 km, numbers in single precision are multiples of 0.5 mm.
TEST(TracedLight, SheetFarFromTheOriginDoesNotShadeItself) {
  const Vec3 normal = Vec3(0.3, -1, 0.4).normalized(), along = normal.cross(Vec3::UnitZ()).normalized();
  const auto draw = [&](const Vec3& place) {
    frame::FrameSnapshot snapshot;
    snapshot.stage = stage_without_sky();
    add_square(snapshot, frame::ObjectKind::cloth, place, normal, along, 0.3).appearance.color = Vec3(0.6, 0.6, 0.6);
    snapshot.cameras = {camera_at(place - 2 * Vec3::UnitY(), place, 40)};
    snapshot.lights = {sun(-0.3 * normal + 0.95 * along)};
    return drawn(snapshot, 2);
  };
  const image::Image near = draw(Vec3::Zero()), far = draw(Vec3(4321.1, -4567.3, 5432.7));
  int largest = 0;
  for (int y = 80; y < 120; ++y)
    for (int x = 140; x < 180; ++x) largest = std::max(largest, std::abs(near.pixel(x, y)[1] - far.pixel(x, y)[1]));
  EXPECT_GT(near.pixel(160, 100)[1], 60);
  EXPECT_LE(largest, 6) << "shadow acne changes tens of levels";
}

}  // namespace
}  // namespace weft::render
