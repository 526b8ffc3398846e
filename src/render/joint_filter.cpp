#include "render/joint_filter.hpp"

#include <algorithm>
#include <cmath>

#include "render/drawing_time.hpp"

namespace weft::render {
namespace {

constexpr int kFilterReach = 2;      // points to either side
constexpr float kNarrow = 1.5f;      // like kWide, for shadows, whose edges may be sharp [steps]
constexpr float kAny = 1e9f;         // value of `wide` for which the distance does not matter
constexpr float kNoise = 0.05f;      // difference of values that halves a weight
constexpr float kPlaneSlack = 0.5f;  // distance from the tangent plane that halves a weight [points]
constexpr float kWide = 6;           // distance along it that halves a weight; large for floors seen obliquely [steps]

float square(float a) {
  return a * a;
}

/// Data of one row of points.
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
/// Weight of point k of a row for the mean at point i of another row. `wide`: distance along the surface that halves
/// the weight [points].
float likeness(const Rows& here, int i, const Rows& there, int k, float wide) {
  const float same = here.surface[i] == there.surface[k] ? 1.0f : 0.0f;
  float agree = here.nx[i] * there.nx[k] + here.ny[i] * there.ny[k] + here.nz[i] * there.nz[k];
  agree = std::max(agree, 0.0f);
  agree *= agree;
  const float dx = there.x[k] - here.x[i], dy = there.y[k] - here.y[i], dz = there.z[k] - here.z[i];
  const float off = std::abs(here.nx[i] * dx + here.ny[i] * dy + here.nz[i] * dz) * here.density[i] / kPlaneSlack;
  const float along = (dx * dx + dy * dy + dz * dz) * square(here.density[i] / wide);
  return same * agree * agree / ((1 + off) * (1 + along));
}

template <bool kAlongRows>
void pass(std::span<const Plane> from, std::span<Plane> to, const PixelPoints& points, int step) {
  const int width = points.width(), height = points.height();
  const float wide = kWide * static_cast<float>(step);
  drawing_for(static_cast<std::size_t>(height), std::size_t{8}, [&](std::size_t begin, std::size_t end) {
    std::vector<float> weights(static_cast<std::size_t>(width)), total(weights.size()), differences(weights.size());
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      const Rows here(points, y);
      std::ranges::fill(total, 0.0f);
      for (Plane& plane : to) std::fill_n(plane.row(y), width, 0.0f);
      for (int k = -kFilterReach; k <= kFilterReach; ++k) {
        const int dy = kAlongRows ? 0 : k * step, dx = kAlongRows ? k * step : 0;
        if (y + dy < 0 || y + dy >= height) continue;
        const Rows there(points, y + dy);
        for (int x = 0; x < width; ++x) weights[x] = likeness(here, x, there, x + dx, wide);
        if (step > 1 && k != 0) {
          // After the pass with step 1, a difference larger than the remaining noise is a feature, to be kept.
          std::ranges::fill(differences, 0.0f);
          for (const Plane& plane : from) {
            const float *a = plane.row(y), *b = plane.row(y + dy) + dx;
            for (int x = 0; x < width; ++x) differences[x] += std::abs(a[x] - b[x]);
          }
          for (int x = 0; x < width; ++x) weights[x] /= 1 + square(differences[x] / kNoise);
        }
        for (int x = 0; x < width; ++x) total[x] += weights[x];
        for (std::size_t p = 0; p < from.size(); ++p) {
          const float* values = from[p].row(y + dy) + dx;
          float* sums = to[p].row(y);
          for (int x = 0; x < width; ++x) sums[x] += weights[x] * values[x];
        }
      }
      for (Plane& plane : to) {
        float* sums = plane.row(y);
        for (int x = 0; x < width; ++x) sums[x] /= std::max(total[x], 1e-6f);
      }
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
  drawing_for(static_cast<std::size_t>(height), std::size_t{8}, [&](std::size_t begin, std::size_t end) {
    std::vector<float> sums(static_cast<std::size_t>(width)), totals(sums.size());
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      const Rows here(points, y);
      const float *asked = wanted.row(y), *own = from.row(y);
      // Processes runs of wanted points; a gap shorter than a packet is processed too.
      for (int first = 0; first < width; ++first) {
        if (!(asked[first] > 0)) continue;
        int last = first + 1;
        for (int x = last; x < std::min(last + kLanes, width); ++x)
          if (asked[x] > 0) last = x + 1;
        std::fill(sums.begin() + first, sums.begin() + last, 0.0f);
        std::fill(totals.begin() + first, totals.begin() + last, 0.0f);
        for (int v = std::max(y - reach, y % step); v <= std::min(y + reach, height - 1); v += step) {
          const Rows there(points, v);
          for (int dx = -reach; dx <= reach; dx += step) {
            const float *values = from.row(v) + dx, *counts = known.row(v) + dx;
            for (int x = first; x < last; ++x) {
              const float difference = step > 1 ? (values[x] - own[x]) / kNoise : 0;
              const float weight = counts[x] * likeness(here, x, there, x + dx, wide) / (1 + square(difference));
              sums[x] += weight * values[x];
              totals[x] += weight;
            }
          }
        }
        for (int x = first; x < last; ++x)
          if (asked[x] > 0 && totals[x] > 0) plane.row(y)[x] = sums[x] / totals[x];
        first = last - 1;
      }
    }
  });
}

void interpolate(std::span<const Eigen::Vector4f> values, const PixelPoints& few, const PixelPoints& many, int begin,
                 int end, std::span<Eigen::Vector4f> results) {
  // In both `few` and `many`, point i lies at pixel i * divisor + divisor / 2.
  const int shift = many.divisor() / 2 - few.divisor() / 2;
  struct Place {
    int low, high;  // points to either side
    float up;       // weight of `high`
  };
  const auto place = [&](int i, int count) {
    const int at = i * many.divisor() + shift, low = at < 0 ? -1 : at / few.divisor();
    return Place{std::clamp(low, 0, count - 1), std::clamp(low + 1, 0, count - 1),
                 static_cast<float>(at - low * few.divisor()) / static_cast<float>(few.divisor())};
  };
  std::vector<Place> columns;
  for (int x = 0; x < many.width(); ++x) columns.push_back(place(x, few.width()));
  std::vector<char> alike(static_cast<std::size_t>(few.width()));  // whether four points show one smooth surface
  int known_row = -1;
  for (int y = begin; y < end; ++y) {
    const Place row = place(y, few.height());
    const Rows here(many, y);
    const std::array<Rows, 2> there{Rows(few, row.low), Rows(few, row.high)};
    const std::array<const Eigen::Vector4f*, 2> lines{values.data() + static_cast<std::size_t>(row.low) * few.width(),
                                                      values.data() + static_cast<std::size_t>(row.high) * few.width()};
    if (row.low != known_row) {
      known_row = row.low;
      constexpr float kAlike = 0.95f;
      for (int x = 0; x < few.width(); ++x) {
        const int next = std::min(x + 1, few.width() - 1);
        alike[x] = std::min({likeness(there[0], x, there[0], next, kAny), likeness(there[0], x, there[1], x, kAny),
                             likeness(there[0], x, there[1], next, kAny)}) > kAlike;
      }
    }
    Eigen::Vector4f* result = results.data() + static_cast<std::size_t>(y) * many.width();
    for (int x = 0; x < many.width(); ++x) {
      const Place& column = columns[x];
      const float right = column.up, up = row.up;
      const std::array<float, 4> plain{(1 - right) * (1 - up), right * (1 - up), (1 - right) * up, right * up};
      const std::array<const Eigen::Vector4f*, 4> corners{lines[0] + column.low, lines[0] + column.high,
                                                          lines[1] + column.low, lines[1] + column.high};
      if (alike[column.low] != 0 && here.surface[x] == there[0].surface[column.low]) {
        result[x] = plain[0] * *corners[0] + plain[1] * *corners[1] + plain[2] * *corners[2] + plain[3] * *corners[3];
        continue;
      }
      Eigen::Vector4f sum = Eigen::Vector4f::Zero(), any = sum;
      float total = 0;
      for (int k = 0; k < 4; ++k) {
        constexpr float kLeast = 0.01f;  // least weight: the only point of the surface counts at any distance
        const float weight =
            (plain[k] + kLeast) * likeness(here, x, there[k >> 1], (k & 1) != 0 ? column.high : column.low, kAny);
        sum += weight * *corners[k], total += weight;
        any += 0.25f * *corners[k];
      }
      // Beside nearer objects, it can happen that none of the four points shows this surface.
      result[x] = total > 1e-4f ? Eigen::Vector4f(sum / total) : any;
    }
  }
}

}  // namespace weft::render
