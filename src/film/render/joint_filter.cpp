#include "film/render/joint_filter.hpp"

#include <algorithm>
#include <cassert>

#include "film/render/drawing_time.hpp"

namespace weft::render {
namespace {

constexpr int kFilterReach = 2;      // number of neighbours on either side [steps]
constexpr float kNarrow = 1.5f;      // distance in space that halves a weight in smooth_where() [steps]
constexpr float kAny = 1e9f;         // value of `wide` in neighbor_weights() for weights without distance in space
constexpr float kNoise = 0.05f;      // difference of the values of two points that halves a weight
constexpr float kPlaneSlack = 0.5f;  // distance from the tangent plane that halves a weight [points]

/// Pointers to one row of each array of PixelPoints that neighbor_weights() reads.
struct Rows {
  const float *surface, *x, *y, *z, *nx, *ny, *nz, *density;
  Rows(const PixelPoints& points, int row)
      : surface(points.surfaces(row)),
        x(points.position(0, row)),
        y(points.position(1, row)),
        z(points.position(2, row)),
        nx(points.normal(0, row)),
        ny(points.normal(1, row)),
        nz(points.normal(2, row)),
        density(points.densities(row)) {}
};

/// Values at kCount (eight or one) consecutive points of a row.
template <int kCount>
using Values = Eigen::Array<float, kCount, 1>;

/// Weights of neighbours in means. Entry n: weight of point k + n of row `there` in the mean at point i + n of row
/// `here`. `wide`: distance in space that halves a weight [points].
template <int kCount>
Values<kCount> neighbor_weights(const Rows& here, int i, const Rows& there, int k, float wide) {
  using Real = Values<kCount>;
  const auto own = [&](const float* row) { return Real(Eigen::Map<const Real>(row + i)); };
  const auto other = [&](const float* row) { return Real(Eigen::Map<const Real>(row + k)); };
  const Real same = (own(here.surface) == other(there.surface)).template cast<float>();
  const Real nx = own(here.nx), ny = own(here.ny), nz = own(here.nz), density = own(here.density);
  const Real agree = (nx * other(there.nx) + ny * other(there.ny) + nz * other(there.nz)).max(0.0f);
  const Real dx = other(there.x) - own(here.x), dy = other(there.y) - own(here.y), dz = other(there.z) - own(here.z);
  const Real off = (nx * dx + ny * dy + nz * dz).abs() * density / kPlaneSlack;
  const Real along = (dx * dx + dy * dy + dz * dz) * (density / wide).square();
  return same * agree.square() * agree.square() / ((1 + off) * (1 + along));
}

// Loads eight consecutive values. The filters process eight points at a time explicitly, because compilers do not
// vectorise loops that read so many rows.
Lanes load(const float* from) {
  return Eigen::Map<const Lanes>(from);
}

template <bool kAlongRows>
void pass(std::span<const Plane> from, std::span<Plane> to, const PixelPoints& points, int step) {
  constexpr std::size_t kMaxPlanes = 4;
  assert(from.size() <= kMaxPlanes && to.size() == from.size() && kFilterReach * step <= Plane::kBorder);
  const int width = points.width(), height = points.height();
  drawing_rows(height, [&](int y) {
    const Rows here(points, y);
    for (int x = 0; x < width; x += kLanes) {
      Lanes total = Lanes::Zero();
      std::array<Lanes, kMaxPlanes> sums;
      sums.fill(Lanes::Zero());
      for (int k = -kFilterReach; k <= kFilterReach; ++k) {
        const int dy = kAlongRows ? 0 : k * step, dx = kAlongRows ? k * step : 0;
        if (y + dy < 0 || y + dy >= height) continue;
        Lanes weights = neighbor_weights<kLanes>(here, x, Rows(points, y + dy), x + dx, kAny);
        if (step > 1 && k != 0) {
          // The filter with step 1 has run before and has left little noise. Larger differences are features, which
          // the filter must keep.
          Lanes differences = Lanes::Zero();
          for (const Plane& plane : from)
            differences += (load(plane.row(y) + x) - load(plane.row(y + dy) + x + dx)).abs();
          weights /= 1 + (differences / kNoise).square();
        }
        total += weights;
        for (std::size_t p = 0; p < from.size(); ++p) sums[p] += weights * load(from[p].row(y + dy) + x + dx);
      }
      for (std::size_t p = 0; p < to.size(); ++p) Eigen::Map<Lanes>(to[p].row(y) + x) = sums[p] / total.max(1e-6f);
    }
  });
}

}  // namespace

void smooth(std::span<Plane> planes, std::span<Plane> scratch, const PixelPoints& points, int step) {
  pass<true>(planes, scratch, points, step);
  pass<false>(scratch, planes, points, step);
}

void smooth_where(Plane& plane, Plane& scratch, const Plane& wanted, const Plane& known, const PixelPoints& points,
                  int step) {
  scratch = plane;
  const Plane& from = scratch;
  const int width = points.width(), height = points.height(), reach = kFilterReach * step;
  const float wide = kNarrow * static_cast<float>(step);
  drawing_rows(height, [&](int y) {
    const Rows here(points, y);
    for (int x = 0; x < width; x += kLanes) {
      const Lanes asked = load(wanted.row(y) + x), own = load(from.row(y) + x);
      if (!(asked > 0).any()) continue;
      Lanes sum = Lanes::Zero(), total = sum;
      for (int v = std::max(y - reach, y % step); v <= std::min(y + reach, height - 1); v += step) {
        const Rows there(points, v);
        for (int dx = -reach; dx <= reach; dx += step) {
          const Lanes values = load(from.row(v) + x + dx);
          Lanes weights = load(known.row(v) + x + dx) * neighbor_weights<kLanes>(here, x, there, x + dx, wide);
          if (step > 1) weights /= 1 + ((values - own) / kNoise).square();
          sum += weights * values;
          total += weights;
        }
      }
      Eigen::Map<Lanes> result(plane.row(y) + x);
      result = (asked > 0 && total > 0).select(sum / total, result);
    }
  });
}

void interpolate(std::span<const Eigen::Vector4f> values, const PixelPoints& few, const PixelPoints& many, int begin,
                 int end, std::span<Eigen::Vector4f> results) {
  // In both `few` and `many`, point i is at pixel i * divisor + divisor / 2.
  const int shift = many.divisor() / 2 - few.divisor() / 2;
  struct Place {
    int low, high;  // indices of the points of `few` on both sides
    float up;       // weight of `high`
  };
  const auto place = [&](int i, int count) {
    const int at = i * many.divisor() + shift, low = at < 0 ? -1 : at / few.divisor();
    return Place{std::clamp(low, 0, count - 1), std::clamp(low + 1, 0, count - 1),
                 static_cast<float>(at - low * few.divisor()) / static_cast<float>(few.divisor())};
  };
  std::vector<Place> columns;
  for (int x = 0; x < many.width(); ++x) columns.push_back(place(x, few.width()));
  // One flag per column of `few`, for the 2 x 2 points in this and the next column and in the rows row.low and
  // row.high. `has_equal_values`: the four values are equal. `shows_one_surface` (only set if `has_equal_values` is 0):
  // the four points show the same smooth surface.
  std::vector<char> has_equal_values(static_cast<std::size_t>(few.width())), shows_one_surface(has_equal_values.size());
  int known_low = -1, known_high = -1;  // rows to which the flags refer; both are 0 below the first row of `few`
  for (int y = begin; y < end; ++y) {
    const Place row = place(y, few.height());
    const Rows here(many, y);
    const std::array<Rows, 2> there{Rows(few, row.low), Rows(few, row.high)};
    const std::array<const Eigen::Vector4f*, 2> lines{values.data() + static_cast<std::size_t>(row.low) * few.width(),
                                                      values.data() + static_cast<std::size_t>(row.high) * few.width()};
    if (row.low != known_low || row.high != known_high) {
      known_low = row.low, known_high = row.high;
      constexpr float kMinSameSurfaceWeight = 0.95f;
      for (int x = 0; x < few.width(); ++x) {
        const int next = std::min(x + 1, few.width() - 1);
        const Eigen::Vector4f& value = lines[0][x];
        has_equal_values[x] = lines[0][next] == value && lines[1][x] == value && lines[1][next] == value;
        if (has_equal_values[x] != 0) continue;
        const auto weight_of = [&](const Rows& at, int k) {
          return neighbor_weights<1>(there[0], x, at, k, kAny).value();
        };
        shows_one_surface[x] = std::min({weight_of(there[0], next), weight_of(there[1], x),
                                         weight_of(there[1], next)}) > kMinSameSurfaceWeight;
      }
    }
    Eigen::Vector4f* result = results.data() + static_cast<std::size_t>(y) * many.width();
    for (int x = 0; x < many.width(); ++x) {
      const Place& column = columns[x];
      if (has_equal_values[column.low] != 0) {
        result[x] = lines[0][column.low];
        continue;
      }
      const float right = column.up, up = row.up;
      const std::array<float, 4> plain{(1 - right) * (1 - up), right * (1 - up), (1 - right) * up, right * up};
      const std::array<const Eigen::Vector4f*, 4> corners{lines[0] + column.low, lines[0] + column.high,
                                                          lines[1] + column.low, lines[1] + column.high};
      if (shows_one_surface[column.low] != 0 && here.surface[x] == there[0].surface[column.low]) {
        result[x] = plain[0] * *corners[0] + plain[1] * *corners[1] + plain[2] * *corners[2] + plain[3] * *corners[3];
        continue;
      }
      Eigen::Vector4f sum = Eigen::Vector4f::Zero(), any = sum;
      float total = 0;
      for (int k = 0; k < 4; ++k) {
        constexpr float kLeast = 0.01f;  // thus the only point that shows the surface counts even if `plain` is 0
        const float weight =
            (plain[k] + kLeast) *
            neighbor_weights<1>(here, x, there[k >> 1], (k & 1) != 0 ? column.high : column.low, kAny).value();
        sum += weight * *corners[k], total += weight;
        any += 0.25f * *corners[k];
      }
      // If none of the four points shows the surface of the pixel, the result is the mean of the four.
      result[x] = total > 1e-4f ? Eigen::Vector4f(sum / total) : any;
    }
  }
}

}  // namespace weft::render
