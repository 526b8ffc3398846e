#include "film/render/reflected_light.hpp"

#include <algorithm>
#include <utility>

#include "film/image/color.hpp"

namespace weft::render {
namespace {

using Eigen::Vector3f;

// Assumed unoccluded fraction of the surroundings at the point that a ray hits. It is not computed: from this point,
// only rays to lamps are traced.
constexpr float kOpenAtHits = 0.6f;
constexpr float kMinSlope = 0.02f;  // the floor is ignored for rays that descend less steeply [m/m]
// ReflectedLight::ray_start() in usual scenes [m], its largest ratio to the size of the scene, and its smallest ratio
// to the distance from the origin (8 rounding errors of single precision).
constexpr float kRayStart = 3e-4f, kMaxRayStartRatio = 1e-3f, kMinRayStartRatio = 1e-6f;

/// Light of channel k for normals n, from the coefficients of an Irradiance.
Lanes evaluate(const std::array<Vector3f, 9>& c, int k, const Lanes3& n) {
  return (c[0][k] + n.x * c[1][k] + n.y * c[2][k] + n.z * c[3][k] + n.x * n.y * c[4][k] + n.y * n.z * c[5][k] +
          n.z * n.x * c[6][k] + n.z * n.z * c[7][k] + (n.x * n.x - n.y * n.y) * c[8][k])
      .max(0.0f);
}

}  // namespace

double covered_fraction(const PaintedMesh& painted, const PaintedRange& range, std::span<const Triangle> triangles,
                        std::span<const Vec3> positions) {
  const frame::Paint& paint = range.look->paint;
  if (!paint.texture) return 1;
  const auto is_inside = [](double place, frame::Paint::Wrap wrap) {
    return wrap != frame::Paint::Wrap::once || (place >= 0 && place <= 1);
  };
  double all = 0, inside = 0;  // twice the areas [m²]
  for (const auto& [a, b, c] : triangles.subspan(range.first, range.count)) {
    const double area = (positions[b] - positions[a]).cross(positions[c] - positions[a]).norm();
    const Vec2 middle = ((painted.places[a] + painted.places[b] + painted.places[c]) / 3.0f).cast<double>();
    const Vec2 place = paint.texture_from_uv * middle.homogeneous();
    all += area;
    if (is_inside(place.x(), paint.wrap_u) && is_inside(place.y(), paint.wrap_v)) inside += area;
  }
  return all > 0 ? inside / all : 1;
}

Vector3f MeanColors::of(const frame::Appearance& look, bool back, double fraction) {
  const frame::Paint& paint = look.paint;
  if (!paint.texture || (back && !look.back_painted))
    return image::linear_from_srgb(back ? look.back_color : look.color).cast<float>();
  const bool opaque = paint.alpha == frame::Paint::Alpha::ignored;
  const auto [known, added] = means_.try_emplace({paint.texture, opaque});
  Mean& mean = known->second;
  if (added) {
    // Averages a sample of about 500 to 1,000 pixels, which is accurate enough.
    const std::size_t pixels = paint.texture->rgba.size() / 4, step = std::max<std::size_t>(1, pixels / 499);
    Vec3 sum = Vec3::Zero();
    double covered = 0, count = 0;
    for (std::size_t i = 0; i < pixels; i += step) {
      const std::uint8_t* rgba = paint.texture->rgba.data() + 4 * i;
      const double opacity = opaque ? 1 : rgba[3] / 255.0;
      sum += opacity * image::linear_from_srgb(Vec3(rgba[0], rgba[1], rgba[2]) / 255);
      covered += opacity;
      ++count;
    }
    if (covered > 0) mean = {(sum / covered).cast<float>(), static_cast<float>(covered / count)};
  }
  const Vector3f own = image::linear_from_srgb(look.color).cast<float>();
  const float covered = static_cast<float>(fraction) * mean.opacity;
  const Vector3f front = covers_color(paint) ? Vector3f((1 - covered) * own + covered * mean.color)
                                             : Vector3f(mean.color.cwiseProduct(own));
  if (!back) return front;
  // Paler by the formula of geometry.frag, applied to the mean.
  const float pale = static_cast<float>(look.back_paleness);
  return ((1 - pale) * front.array().sqrt() + pale).square().matrix();
}

ReflectingSurface reflecting_surface(const SurfaceBuffers& surface, const frame::Appearance& look, bool plain,
                                     bool dark, MeanColors& colors) {
  const bool cloth = surface.surface().kind == frame::ObjectKind::cloth;
  const auto range = [&](const frame::Appearance& of, std::size_t end, double covered) {
    if (dark) return ReflectingSurface::Range{end, Vector3f::Zero(), Vector3f::Zero()};
    return ReflectingSurface::Range{end, colors.of(of, false, covered), colors.of(of, cloth, covered)};
  };
  if (plain || surface.painted() == nullptr) return {{range(look, 0, 1)}};
  const PaintedMesh& painted = *surface.painted();
  ReflectingSurface result;
  for (const PaintedRange& each : painted.ranges) {
    const double covered =
        covers_color(each.look->paint) ? covered_fraction(painted, each, surface.triangles(), surface.positions()) : 1;
    result.ranges.push_back(range(*each.look, each.first + each.count, covered));
  }
  return result;
}

ReflectedLight::ReflectedLight(const RayScene& rays, std::vector<ReflectingSurface> surfaces, std::vector<Lamp> lamps,
                               const Irradiance& around, const std::optional<Floor>& floor, const Vector3f& floor_color,
                               double scene_size)
    : rays_(&rays),
      surfaces_(std::move(surfaces)),
      lamps_(std::move(lamps)),
      has_floor_(floor.has_value()),
      floor_color_(floor_color),
      least_ray_start_(std::min(kRayStart, kMaxRayStartRatio * static_cast<float>(scene_size))) {
  for (std::size_t k = 0; k < around.size(); ++k) around_[k] = around[k].cast<float>();
  if (floor) {
    floor_normal_ = floor->normal.cast<float>();
    floor_height_ = floor_normal_.dot(floor->point.cast<float>());
  }
}

Lanes ReflectedLight::ray_start(const Lanes3& points) const {
  return (kMinRayStartRatio * dot(points, points).sqrt()).max(least_ray_start_);
}

Lanes3 ReflectedLight::surroundings(const Lanes3& normal) const {
  return {evaluate(around_, 0, normal), evaluate(around_, 1, normal), evaluate(around_, 2, normal)};
}

ReflectedLight::Arriving ReflectedLight::arriving(const Rays& rays) const {
  const Hits hits = rays_->nearest(rays);
  Arriving result;
  enum class End : std::uint8_t { nowhere, surface, floor };
  std::array<End, kLanes> ends{};
  Lanes3 normal, albedo, point;
  bool any = false;
  for (int lane = 0; lane < kLanes; ++lane) {
    normal.set(lane, Vector3f::UnitZ());
    if (rays.wanted[lane] == 0) continue;
    const Vector3f start = rays.origin.at(lane), way = rays.direction.at(lane);
    const float down = -floor_normal_.dot(way), height = floor_normal_.dot(start) - floor_height_;
    const bool meets_floor = has_floor_ && down >= kMinSlope * way.norm() && height >= 2 * least_ray_start_;
    // `rays_` does not contain the floor. A ray that meets the floor first does not reach the surface below it.
    if (hits.mesh[lane] != Hits::kNone && !(meets_floor && height < down * hits.distance[lane])) {
      const auto& ranges = surfaces_[static_cast<std::size_t>(hits.mesh[lane])].ranges;
      auto range = std::ranges::find_if(ranges, [&](const auto& each) { return hits.triangle[lane] < each.end; });
      if (range == ranges.end()) --range;
      const bool back = hits.normal.at(lane).dot(way) > 0;
      const Vector3f facing = back ? Vector3f(-hits.normal.at(lane)) : hits.normal.at(lane);
      ends[lane] = End::surface;
      normal.set(lane, facing);
      albedo.set(lane, back ? range->back : range->front);
      point.set(lane, start + hits.distance[lane] * way);
    } else {
      result.open[lane] = 1;
      if (!meets_floor) continue;
      ends[lane] = End::floor;
      normal.set(lane, floor_normal_);
      albedo.set(lane, floor_color_);
      point.set(lane, start + height / down * way);
    }
    any = true;
  }
  if (!any) return result;
  point = point + ray_start(point) * normal;

  Lanes on_surface, on_floor;  // 1 if the ray ends there, else 0
  for (int lane = 0; lane < kLanes; ++lane) {
    on_surface[lane] = ends[lane] == End::surface ? 1.0f : 0.0f;
    on_floor[lane] = ends[lane] == End::floor ? 1.0f : 0.0f;
  }
  for (const Lamp& lamp : lamps_) {
    const LampSample sample = sample_lamp(lamp, point);
    const Lanes strength = sample.intensity * dot(normal, sample.direction);
    Rays shadow;
    shadow.origin = point, shadow.direction = sample.direction, shadow.end = sample.distance, shadow.seed = rays.seed;
    shadow.wanted = mask(on_surface + on_floor > 0 && strength > 0);
    if ((shadow.wanted == 0).all()) continue;
    const Lanes dark = rays_->blocked(shadow);
    // The surroundings already contain the floor, fully lit by suns (expose()). Therefore, the shadow of a sun on the
    // floor subtracts light.
    const Lanes lit = lamp.is_spot() ? Lanes(on_surface + on_floor) : on_surface;
    const Lanes added = (shadow.wanted != 0).select(strength * (lit - dark * (on_surface + on_floor)), Lanes::Zero());
    result.light.x += added * lamp.packed.color.x();
    result.light.y += added * lamp.packed.color.y();
    result.light.z += added * lamp.packed.color.z();
  }
  const Lanes open = kOpenAtHits * on_surface;
  const Lanes3 around = surroundings(normal);
  result.light.x = albedo.x * (result.light.x + open * around.x);
  result.light.y = albedo.y * (result.light.y + open * around.y);
  result.light.z = albedo.z * (result.light.z + open * around.z);
  return result;
}

}  // namespace weft::render
