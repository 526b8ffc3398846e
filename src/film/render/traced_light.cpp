#include "film/render/traced_light.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "film/render/drawing_time.hpp"
#include "film/render/joint_filter.hpp"

namespace weft::render {
namespace {

using Eigen::Vector2f, Eigen::Vector3f;
using Kind = PixelPoints::Kind;

constexpr float kGoldenAngle = 2.39996323f;  // [rad]
constexpr int kRotations = 64;    // number of rotations of the points on a lamp, a power of 2 (rotation_index())
constexpr int kFirstRays = 1;     // rays per point of the first pass, which finds penumbrae
constexpr int kFloorTile = 16;    // side of a tile of shaded floor [pixels]
constexpr int kPenumbraTile = 8;  // side of a tile in which penumbrae are searched [points]
constexpr int kMirrorRays = 4;    // rays per point for reflections of surfaces
// Shadow rays are traced only if the cosine between normal and light is above this value (on the floor: above 0). The
// value is negative, because skin is lit slightly beyond the terminator (surface.frag). For cloth, shadow rays are
// always traced, because light passes through it.
constexpr float kMinShadowCosine = -0.2f;
// Changes of the floor's light up to this value are ignored, because they change colours by less than half a level of
// 255.
constexpr float kMinFloorChange = 0.002f;

constexpr float kFloorKind = static_cast<float>(Kind::floor), kClothKind = static_cast<float>(Kind::cloth);

/// A rotation for each pixel, from 0 to kRotations - 1. Both factors are odd, so that each row and each column has all
/// rotations: the filter of step 2, which never mixes even and odd ones, leaves no stripes. Of such factors, these
/// leave the least noise (tests/bench/history.md, section "Rays").
int rotation_index(int x, int y) {
  return (11 * x + 17 * y) & (kRotations - 1);
}

/// Point k of n points that are evenly spread over a disc of radius 1 (Vogel 1979). `turn`: rotation of all points
/// [turns]. `along` in [0, 1): radial position of each point within its annulus, one of n with equal areas.
Vector2f on_disc(float k, int n, float turn, float along) {
  const float radius = std::sqrt((k + along) / static_cast<float>(n));
  const float angle = kGoldenAngle * k + 2 * std::numbers::pi_v<float> * turn;
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

/// Two unit vectors orthogonal to a unit vector (Duff et al., "Building an Orthonormal Basis, Revisited", 2017).
void across(const Vector3f& n, Vector3f& first, Vector3f& second) {
  const float sign = std::copysign(1.0f, n.z()), a = -1 / (sign + n.z()), b = n.x() * n.y() * a;
  first = {1 + sign * n.x() * n.x() * a, sign * b, -sign * n.x()};
  second = {b, sign + n.y() * n.y() * a, -n.y()};
}
void across(const Lanes3& n, Lanes3& first, Lanes3& second) {
  const Lanes sign = (n.z < 0).select(Lanes::Constant(-1), Lanes::Constant(1));
  const Lanes a = -1 / (sign + n.z), b = n.x * n.y * a;
  first = {1 + sign * n.x * n.x * a, sign * b, -sign * n.x};
  second = {b, sign + n.y * n.y * a, -n.y};
}

/// jitter_pair(jitter_index(x, y)) is a pair of numbers in [0, 1) for point (x, y). The 25 pairs of a block of 5 x 5
/// points are evenly spread. Each block shifts its pairs by one of 64 terms of the R2 sequence (Roberts, "The
/// Unreasonable Effectiveness of Quasirandom Sequences", 2018). Without shifts, the same 25 directions would cause the
/// same error in all blocks.
constexpr int kJitterPairs = 25 * 64;
int jitter_index(int x, int y) {
  const int block = (x / 5 + 19 * (y / 5)) % 64;  // 19 steps of the sequence: a large change of both numbers
  return block * 25 + (x + 2 * y) % 5 + 5 * ((y + 2 * x) % 5);
}
Vector2f jitter_pair(int number) {
  const int a = number % 5, b = number / 5 % 5;
  const int block = number / 25;
  const auto shift = static_cast<float>(block);
  const Vector2f at((static_cast<float>(5 * a + b) + 0.5f) / 25 + 0.7548777f * shift,
                    (static_cast<float>(5 * b + a) + 0.5f) / 25 + 0.5698403f * shift);
  return at - Vector2f(at.array().floor());
}

/// Directions about +z with a density proportional to their cosine: `rays` of them for each argument of jitter_pair().
std::vector<Vector3f> cosine_directions(int rays) {
  std::vector<Vector3f> all;
  for (int number = 0; number < kJitterPairs; ++number) {
    for (int k = 0; k < rays; ++k) {
      const Vector2f jitter = jitter_pair(number), at = on_disc(static_cast<float>(k), rays, jitter.x(), jitter.y());
      all.emplace_back(at.x(), at.y(), std::sqrt(std::max(1 - at.squaredNorm(), 0.0f)));
    }
  }
  return all;
}

/// Sets `wanted` to `known` in the tiles that may contain penumbrae, and to 0 elsewhere. A tile may contain a penumbra
/// if, in it or in a neighbour, two known values differ or a value is between 0 and 1. The unit is a tile and not a
/// point, because near the rim of a penumbra the single rays of most points have the same result.
void find_penumbrae(const Plane& lit, const Plane& known, const PixelPoints& points, Plane& wanted) {
  const int width = points.width(), height = points.height();
  const int columns = (width + kPenumbraTile - 1) / kPenumbraTile, rows = (height + kPenumbraTile - 1) / kPenumbraTile;
  std::vector<char> mixed(static_cast<std::size_t>(columns) * rows);
  const auto for_rows = [&](const auto& visit) {
    const auto visit_row = [&](int row) {
      for (int column = 0; column < columns; ++column) visit(row, column);
    };
    drawing_rows(rows, visit_row, 1);
  };
  for_rows([&](int row, int column) {
    float least = 2, most = -1;
    for (int y = row * kPenumbraTile; y < std::min((row + 1) * kPenumbraTile, height); ++y)
      for (int x = column * kPenumbraTile; x < std::min((column + 1) * kPenumbraTile, width); ++x) {
        if (!(known.row(y)[x] > 0)) continue;
        least = std::min(least, lit.row(y)[x]);
        most = std::max(most, lit.row(y)[x]);
      }
    mixed[static_cast<std::size_t>(row) * columns + column] = least < most || (most > 0 && most < 1);
  });
  for_rows([&](int row, int column) {
    bool near = false;
    for (int v = std::max(row - 1, 0); v <= std::min(row + 1, rows - 1); ++v)
      for (int u = std::max(column - 1, 0); u <= std::min(column + 1, columns - 1); ++u)
        near |= mixed[static_cast<std::size_t>(v) * columns + u] != 0;
    for (int y = row * kPenumbraTile; y < std::min((row + 1) * kPenumbraTile, height); ++y)
      for (int x = column * kPenumbraTile; x < std::min((column + 1) * kPenumbraTile, width); ++x)
        wanted.row(y)[x] = near ? known.row(y)[x] : 0;
  });
}

/// Keeps a point in `wanted` only if, among the known points at most two rows and columns away
/// (including itself), two values differ or a value is between 0 and 1. `low`, `high`: scratch,
/// overwritten.
void keep_mixed(const Plane& lit, const Plane& known, const PixelPoints& points, Plane& wanted, Plane& low,
                Plane& high) {
  constexpr int kNeighbors = 2;
  const int width = points.width(), height = points.height();
  drawing_rows(height, [&](int y) {
    float *least = low.row(y), *most = high.row(y);
    std::fill_n(least, width, 2.0f);
    std::fill_n(most, width, -1.0f);
    for (int dx = -kNeighbors; dx <= kNeighbors; ++dx) {
      const float *value = lit.row(y) + dx, *counts = known.row(y) + dx;
      for (int x = 0; x < width; ++x) {
        least[x] = std::min(least[x], counts[x] > 0 ? value[x] : 2.0f);
        most[x] = std::max(most[x], counts[x] > 0 ? value[x] : -1.0f);
      }
    }
  });
  drawing_rows(height, [&](int y) {
    std::vector<float> least(low.row(y), low.row(y) + width), most(high.row(y), high.row(y) + width);
    for (int v = std::max(y - kNeighbors, 0); v <= std::min(y + kNeighbors, height - 1); ++v) {
      for (int x = 0; x < width; ++x) least[x] = std::min(least[x], low.row(v)[x]);
      for (int x = 0; x < width; ++x) most[x] = std::max(most[x], high.row(v)[x]);
    }
    float* flags = wanted.row(y);
    for (int x = 0; x < width; ++x) flags[x] = most[x] > least[x] || (most[x] > 0 && least[x] < 1) ? flags[x] : 0;
  });
}

}  // namespace

TracedLight::Surface TracedLight::Surface::of(const frame::Appearance& look, bool cloth) {
  const bool mirrors = !cloth && (look.metal > 0 || look.coat > 0);
  const double alpha = look.coat > 0 ? 0 : look.roughness * look.roughness;
  return {cloth ? Kind::cloth : Kind::solid, mirrors ? static_cast<float>(alpha) : -1.0f};
}

TracedLight::TracedLight(const Gl& gl, const QualitySettings& quality, int width, int height)
    : gl_(&gl),
      quality_(quality),
      width_(width),
      height_(height),
      pixels_(width, height, 1),
      open_points_(width, height, quality.ambient_divisor),
      open_(4, Plane(open_points_.width(), open_points_.height(), 0)),
      open_scratch_(open_),
      directions_(cosine_directions(quality.ambient_rays)),
      lit_texture_(make_texture(gl, GL_RGBA32F, width, height, GL_NEAREST)),
      open_texture_(make_texture(gl, GL_RGBA32F, width, height, GL_NEAREST)) {
  if (quality.shadow_divisor > 1) lit_points_.emplace(width, height, quality.shadow_divisor);
  const Plane plane(lit_points().width(), lit_points().height(), 1);
  lit_.assign(kMaxLights, plane);
  scratch_.fill(plane);
}

void TracedLight::draw(const ReflectedLight& light, const GeometryBuffer& geometry, std::span<const Seen> seen,
                       std::span<const Surface> surfaces, const View& view, const std::optional<Floor>& floor) {
  geometry.read_normals(normals_);
  std::vector<Kind> kinds;
  for (const Surface& surface : surfaces) kinds.push_back(surface.kind);
  pixels_.read(seen, normals_, kinds, view, floor);
  if (lit_points_) lit_points_->read(seen, normals_, kinds, view, floor);
  open_points_.read(seen, normals_, kinds, view, floor);
  shaded_.assign(
      static_cast<std::size_t>((width_ + kFloorTile - 1) / kFloorTile) * ((height_ + kFloorTile - 1) / kFloorTile), 0);
  trace_shadows(light);
  trace_surroundings(light);
  if (std::ranges::any_of(surfaces, [](const Surface& surface) { return surface.mirror_alpha >= 0; }))
    trace_mirrors(light, surfaces, view.eye.cast<float>());
}

void TracedLight::trace_shadows(const ReflectedLight& light) {
  const PixelPoints& points = lit_points();
  for (std::size_t i = 0; i < lit_.size(); ++i) {
    lit_[i].fill(1);
    if (i < light.lamps().size()) trace_lamp(light, light.lamps()[i], lit_[i]);
  }
  upload(lit_, points, lit_texture_, 0, Eigen::Vector4f::Ones());
}

/// Traces rays from each point to the lamp: one ray to find penumbrae, half of quality_.shadow_rays if the point may be
/// in a penumbra, and all of them if the point is in a penumbra.
void TracedLight::trace_lamp(const ReflectedLight& light, const Lamp& lamp, Plane& lit) {
  const PixelPoints& points = lit_points();
  const int width = points.width(), height = points.height(), rays = quality_.shadow_rays;
  // `places`: target of each ray for each rotation: a direction toward the sun, or a position on the spot lamp.
  const Vector3f axis = lamp.packed.toward_light.head<3>();
  const Vector3f center = lamp.is_spot() ? Vector3f(lamp.packed.position.head<3>()) : axis;
  const float radius = lamp.source_tangent * (lamp.is_spot() ? lamp.target_distance() : 1);
  Vector3f first, second;
  across(axis, first, second);
  std::vector<Vector3f> places;
  for (int turn = 0; turn < kRotations; ++turn) {
    for (int k = 0; k < rays; ++k) {
      // In this order, the first half of the rays is already spread over the disc. The distance of the first ray from
      // the centre depends on the rotation: if it were the same for all points, no first ray would find the rims of
      // wide penumbrae.
      const auto order = static_cast<float>((k * 5 + turn) % rays);
      const Vector2f at = on_disc(order, rays, static_cast<float>(turn) / kRotations, 0.5f);
      places.emplace_back(center + radius * (at.x() * first + at.y() * second));
    }
  }
  Plane &known = scratch_[0], &wanted = scratch_[1], &smoothed = scratch_[2], &scratch = scratch_[3];
  known.fill(0);
  wanted.fill(1);
  const auto trace = [&](int first_ray, int last_ray) {
    drawing_rows(height, [&](int y) {
      for (int x = 0; x < width; x += kLanes) {
        const Lanes kinds = points.kinds(x, y), asked = Eigen::Map<const Lanes>(wanted.row(y) + x);
        if (!(kinds * asked > 0).any()) continue;
        const LampSample sample = sample_lamp(lamp, points.positions(x, y));
        const Lanes3 normal = points.normals(x, y);
        const Lanes side = dot(normal, sample.direction);
        const Lanes least = (kinds == kFloorKind).select(Lanes::Zero(), Lanes::Constant(kMinShadowCosine));
        Rays packet;
        packet.wanted = mask(kinds * asked > 0 && sample.intensity > 0 && (kinds == kClothKind || side > least));
        if ((packet.wanted == 0).all()) continue;
        // Rays start at the smooth surface, on the side that faces the lamp. If they started at the flat triangle,
        // neighbouring triangles would block them.
        const Lanes facing = (side < 0).select(Lanes::Constant(-1), Lanes::Constant(1));
        const Lanes3 positions = points.positions(x, y);
        const Lanes lift = facing * (light.ray_start(positions) + (facing * points.rises(x, y)).max(0.0f));
        packet.origin = positions + lift * normal;
        if (lamp.is_spot()) packet.end.setOnes();
        Lanes hits = Lanes::Zero();
        for (int k = first_ray; k < last_ray; ++k) {
          for (int lane = 0; lane < kLanes; ++lane)
            packet.direction.set(lane, places[static_cast<std::size_t>(rotation_index(x + lane, y) * rays + k)]);
          if (lamp.is_spot()) packet.direction = packet.direction + Lanes::Constant(-1) * packet.origin;
          packet.seed = static_cast<unsigned>((k * height + y) * width + x);
          hits += light.rays().blocked(packet);
        }
        Eigen::Map<Lanes> fractions(lit.row(y) + x), knowns(known.row(y) + x);
        const Lanes before = (1 - fractions) * static_cast<float>(first_ray);
        const auto traced = packet.wanted != 0;
        fractions = traced.select(1 - (before + hits) / static_cast<float>(last_ray), fractions);
        knowns = traced.select(Lanes::Ones(), knowns);
      }
    });
  };
  trace(0, kFirstRays);
  find_penumbrae(lit, known, points, wanted);
  smoothed = wanted;
  trace(kFirstRays, rays / 2);
  keep_mixed(lit, known, points, wanted, scratch, scratch_[4]);
  trace(rays / 2, rays);
  smooth_where(lit, scratch, smoothed, known, points, 1);
  smooth_where(lit, scratch, wanted, known, points, 2);
}

void TracedLight::trace_surroundings(const ReflectedLight& light) {
  const PixelPoints& points = open_points_;
  const int rays = quality_.ambient_rays;
  const std::vector<Vector3f>& directions = directions_;
  drawing_rows(points.height(), [&](int y) {
    for (int x = 0; x < points.width(); x += kLanes) {
      Rays packet;
      packet.wanted = mask(points.kinds(x, y) > 0);
      Lanes open = Lanes::Zero();
      Lanes3 sum;
      if ((packet.wanted != 0).any()) {
        const Lanes3 normal = points.normals(x, y);
        Lanes3 first, second;
        across(normal, first, second);
        const Lanes3 positions = points.positions(x, y);
        packet.origin = positions + (light.ray_start(positions) + points.rises(x, y).max(0.0f)) * normal;
        for (int k = 0; k < rays; ++k) {
          Lanes3 local;
          for (int lane = 0; lane < kLanes; ++lane)
            local.set(lane, directions[static_cast<std::size_t>(jitter_index(x + lane, y) * rays + k)]);
          packet.direction = local.x * first + local.y * second + local.z * normal;
          packet.seed = static_cast<unsigned>((k * points.height() + y) * points.width() + x);
          const ReflectedLight::Arriving arriving = light.arriving(packet);
          open += arriving.open;
          sum = sum + arriving.light;
        }
      } else {
        open.setConstant(static_cast<float>(rays));
      }
      const float each = 1 / static_cast<float>(rays);
      Eigen::Map<Lanes>(open_[0].row(y) + x) = each * sum.x;
      Eigen::Map<Lanes>(open_[1].row(y) + x) = each * sum.y;
      Eigen::Map<Lanes>(open_[2].row(y) + x) = each * sum.z;
      Eigen::Map<Lanes>(open_[3].row(y) + x) = each * open;
    }
  });
  for (const int step : {1, 2, 4}) smooth(open_, open_scratch_, points, step);
  upload(open_, points, open_texture_, 1, {0, 0, 0, 1});
}

/// Traces rays around the mirrored direction of view. The rougher the surface, the wider the rays are spread.
void TracedLight::trace_mirrors(const ReflectedLight& light, std::span<const Surface> surfaces, const Vector3f& eye) {
  const PixelPoints& points = open_points_;
  mirrored_.resize(4, Plane(points.width(), points.height(), 0));
  for (Plane& plane : mirrored_) plane.fill(0);
  drawing_rows(points.height(), [&](int y) {
    for (int x = 0; x < points.width(); x += kLanes) {
      Rays packet;
      std::array<float, kLanes> alpha{};
      for (int lane = 0; lane < kLanes; ++lane) {
        const int number = static_cast<int>(points.surfaces(y)[x + lane]) - kFirstSurface;
        if (number < 0) continue;
        alpha[lane] = surfaces[static_cast<std::size_t>(number)].mirror_alpha;
        packet.wanted[lane] = alpha[lane] >= 0 ? -1 : 0;
      }
      if ((packet.wanted == 0).all()) continue;
      const Lanes3 positions = points.positions(x, y);
      packet.origin = positions + (light.ray_start(positions) + points.rises(x, y).max(0.0f)) * points.normals(x, y);
      for (int k = 0; k < kMirrorRays; ++k) {
        for (int lane = 0; lane < kLanes; ++lane) {
          if (packet.wanted[lane] == 0) continue;
          const Vector3f normal = points.normals(x, y).at(lane);
          const Vector3f seen = (points.positions(x, y).at(lane) - eye).normalized();
          const Vector3f mirrored = seen - 2 * normal.dot(seen) * normal;
          Vector3f first, second;
          across(mirrored, first, second);
          const Vector2f jitter = jitter_pair(jitter_index(x + lane, y));
          const Vector2f at = alpha[lane] * on_disc(static_cast<float>(k), kMirrorRays, jitter.x(), jitter.y());
          packet.direction.set(lane, (mirrored + at.x() * first + at.y() * second).normalized());
        }
        packet.seed = static_cast<unsigned>((k * points.height() + y) * points.width() + x);
        const ReflectedLight::Arriving arriving = light.arriving(packet);
        for (int lane = 0; lane < kLanes; ++lane) {
          if (packet.wanted[lane] == 0) continue;
          const Vector3f each = arriving.light.at(lane) / kMirrorRays;
          for (int c = 0; c < 3; ++c) mirrored_[c].row(y)[x + lane] += each[c];
          mirrored_[3].row(y)[x + lane] += (1 - arriving.open[lane]) / kMirrorRays;
        }
      }
    }
  });
  smooth(mirrored_, open_scratch_, points, 1);
  if (!mirrored_texture_) mirrored_texture_ = make_texture(*gl_, GL_RGBA32F, width_, height_, GL_NEAREST);
  upload(mirrored_, points, mirrored_texture_, 2, Eigen::Vector4f::Zero());
}

/// Interpolates four planes at all pixels and uploads them as a texture. Marks the tiles in which a
/// value of a floor pixel differs from `on_open_floor` by more than kMinFloorChange.
void TracedLight::upload(std::span<const Plane> planes, const PixelPoints& points, const Texture& texture, GLuint unit,
                         const Eigen::Vector4f& on_open_floor) {
  texels_.resize(static_cast<std::size_t>(width_) * height_);
  if (points.divisor() > 1) {
    values_.resize(static_cast<std::size_t>(points.width()) * points.height());
    for (int y = 0; y < points.height(); ++y)
      for (int x = 0; x < points.width(); ++x)
        for (std::size_t k = 0; k < 4; ++k)
          values_[static_cast<std::size_t>(y) * points.width() + x][k] = planes[k].row(y)[x];
  }
  const int tiles = (width_ + kFloorTile - 1) / kFloorTile;
  drawing_for(static_cast<std::size_t>(height_), std::size_t{kFloorTile}, [&](std::size_t begin, std::size_t end) {
    if (points.divisor() > 1)
      interpolate(values_, points, pixels_, static_cast<int>(begin), static_cast<int>(end), texels_);
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      const std::span<Eigen::Vector4f> row(texels_.data() + static_cast<std::size_t>(y) * width_,
                                           static_cast<std::size_t>(width_));
      for (int x = 0; x < width_ && points.divisor() == 1; ++x)
        for (std::size_t k = 0; k < 4; ++k) row[x][k] = planes[k].row(y)[x];
      for (int x = 0; x < width_; ++x) {
        if (pixels_.kind(x, y) != Kind::floor) continue;
        const bool shaded = (row[x] - on_open_floor).cwiseAbs().maxCoeff() > kMinFloorChange;
        if (shaded) shaded_[static_cast<std::size_t>(y / kFloorTile) * tiles + x / kFloorTile] = 1;
      }
    }
  });
  gl_->TextureSubImage2D(texture.name(), 0, 0, 0, width_, height_, GL_RGBA, GL_FLOAT, texels_.data());
  gl_->BindTextureUnit(unit, texture.name());
}

std::vector<PixelArea> TracedLight::shaded_floor() const {
  const int columns = (width_ + kFloorTile - 1) / kFloorTile, rows = (height_ + kFloorTile - 1) / kFloorTile;
  std::vector<PixelArea> areas;
  for (int row = 0; row < rows; ++row) {
    const char* flags = shaded_.data() + static_cast<std::size_t>(row) * columns;
    for (int begin = 0; begin < columns; ++begin) {
      if (flags[begin] == 0) continue;
      int end = begin;
      while (end < columns && flags[end] != 0) ++end;
      const int x = begin * kFloorTile, y = row * kFloorTile;
      areas.push_back({x, y, std::min(end * kFloorTile, width_) - x, std::min(y + kFloorTile, height_) - y});
      begin = end;
    }
  }
  return areas;
}

}  // namespace weft::render
