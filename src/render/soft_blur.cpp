#include "render/soft_blur.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "render/drawing_time.hpp"
#include "render/seen.hpp"

namespace weft::render {
namespace {

// Filter radius and number of taps.
constexpr int kRadius = 2, kTaps = 2 * kRadius + 1;
// Weight of a neighbour's light fraction, relative to a texel's own.
constexpr float kNeighbourWeight = 0.5f;
// Steps of light fraction between texels beyond these limits stay sharp. On curved surfaces the limit is higher,
// because half of a step may be noise of the faces.
constexpr float kCrispFloor = 0.25f, kCrispCurved = 0.45f;
// Relative distance from which texels begin to count as another fold; at twice that they have no weight.
constexpr float kFoldDistance = 0.01f;
// Texels with a weight below 1 / kSteepnessGain hardly contribute to the steepness of light.
constexpr float kSteepnessGain = 100;
constexpr std::size_t kRowsPerTask = 16;  // rows of one task

using Lanes = Eigen::Array<float, 8, 1>;
constexpr int kLanes = 8;

Lanes load(const float* from) {
  return Eigen::Map<const Lanes>(from);
}
void store(const Lanes& lanes, float* to) {
  Eigen::Map<Lanes>{to} = lanes;
}

// For whole numbers: 1 if equal, else 0.
Lanes equal(const Lanes& a, const Lanes& b) {
  return (1 - (a - b).abs()).max(0.0f);
}

// Minmod: the smaller of two changes if they have the same sign, else 0.
Lanes minmod(const Lanes& a, const Lanes& b) {
  return a.min(b).max(0.0f) + a.max(b).min(0.0f);
}

}  // namespace

SoftBlur::SoftBlur(int width, int height)
    : width_(width), height_(height), stride_((width + kLanes - 1) / kLanes * kLanes + 2 * kRadius) {
  for (Plane* plane : {&surface_, &distance_}) plane->assign(stride_ * height, 1.0f);
  for (Planes* planes : {&planes_, &other_}) {
    planes->open.assign(stride_ * height, 1.0f);
    for (auto& [lit, too_crisp] : planes->lights) lit = too_crisp = planes->open;
  }
}

/// Index of the first texel of a row.
std::size_t SoftBlur::row_start(int y) const {
  return stride_ * y + kRadius;
}

void SoftBlur::extend(Plane& plane, int y) const {
  float* first = plane.data() + row_start(y);
  std::fill(first - kRadius, first, *first);
  std::fill(first + width_, first - kRadius + stride_, first[width_ - 1]);
}

template <bool kWithLights>
void SoftBlur::pass(const Planes& from, Planes& to, bool across) const {
  drawing_for(static_cast<std::size_t>(height_), kRowsPerTask, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      std::array<std::size_t, kTaps> taps;
      for (int i = 0; i < kTaps; ++i)
        taps[i] = across ? row_start(y) + i - kRadius : row_start(std::clamp(y + i - kRadius, 0, height_ - 1));
      for (int x = 0; x < width_; x += kLanes) {
        const auto at = [&](const Plane& plane, int i) { return load(plane.data() + taps[i] + x); };
        const Lanes surface = at(surface_, kRadius), distance = at(distance_, kRadius);
        // Slope of distance over the surface, so that slanted surfaces have full weight and the noise of all taps
        // cancels out.
        const Lanes slope = minmod(distance - at(distance_, kRadius - 1), at(distance_, kRadius + 1) - distance);
        Lanes open = at(from.open, kRadius), weight = Lanes::Ones(), weight_beside = Lanes::Ones();
        std::array<Lanes, kSoftLights> lit, steepest;
        for (std::size_t light = 0; kWithLights && light < kSoftLights; ++light) {
          lit[light] = at(from.lights[light].lit, kRadius);
          steepest[light].setZero();
        }
        for (int i = 0; i < kTaps; ++i) {
          if (i == kRadius) continue;
          const Lanes depth_error = (at(distance_, i) - distance - static_cast<float>(i - kRadius) * slope).abs();
          const Lanes same =
              equal(at(surface_, i), surface) * (2 - depth_error / (kFoldDistance * distance)).max(0.0f).min(1.0f);
          open += same * at(from.open, i);
          weight += same;
          if (!kWithLights || std::abs(i - kRadius) != 1) continue;
          const Lanes beside = kNeighbourWeight * same, is_counted = (kSteepnessGain * same).min(1.0f);
          weight_beside += beside;
          for (std::size_t light = 0; light < kSoftLights; ++light) {
            const Plane& shares = from.lights[light].lit;
            const Lanes there = at(shares, i);
            lit[light] += beside * there;
            steepest[light] = steepest[light].max(is_counted * (there - at(shares, kRadius)).abs());
          }
        }
        const std::size_t here = row_start(y) + x;
        store(open / weight, to.open.data() + here);
        const Lanes limit = kCrispCurved + (kCrispFloor - kCrispCurved) * equal(surface, Lanes::Constant(kFloor));
        for (std::size_t light = 0; kWithLights && light < kSoftLights; ++light) {
          store(lit[light] / weight_beside, to.lights[light].lit.data() + here);
          // Neighbours of sharp shadow edges also search at full size: a blurred value would show as a second line
          // along the edge.
          store(at(from.lights[light].too_crisp, kRadius).max(steepest[light] - limit),
                to.lights[light].too_crisp.data() + here);
        }
      }
      extend(to.open, y);
      for (std::size_t light = 0; kWithLights && light < kSoftLights; ++light) {
        extend(to.lights[light].lit, y);
        extend(to.lights[light].too_crisp, y);
      }
    }
  });
}

void SoftBlur::smooth(std::vector<SoftTexel>& texels) {
  const auto each_row = [&](const auto& body) {
    drawing_for(static_cast<std::size_t>(height_), kRowsPerTask, [&](std::size_t begin, std::size_t end) {
      for (std::size_t y = begin; y < end; ++y) body(static_cast<int>(y), texels.data() + y * width_);
    });
  };
  // Packed as in shaders/soft_light.glsl.
  constexpr float kOpen = 0.9375f, kCrisp = 2, kCrispFrom = -0.5f;
  each_row([&](int y, const SoftTexel* row) {
    for (int x = 0; x < width_; ++x) {
      const std::size_t at = row_start(y) + x;
      surface_[at] = std::floor(row[x].surface_open);
      planes_.open[at] = (row[x].surface_open - surface_[at]) / kOpen;
      distance_[at] = row[x].distance;
      for (std::size_t light = 0; light < kSoftLights; ++light) {
        auto& [lit, too_crisp] = planes_.lights[light];
        const bool crisp = row[x].lit[light] <= kCrispFrom;
        too_crisp[at] = crisp ? 1.0f : -1.0f;
        lit[at] = row[x].lit[light] + (crisp ? kCrisp : 0.0f);
      }
    }
    for (Plane* plane : {&surface_, &distance_, &planes_.open}) extend(*plane, y);
    for (auto& [lit, too_crisp] : planes_.lights) {
      extend(lit, y);
      extend(too_crisp, y);
    }
  });
  pass<true>(planes_, other_, true);
  pass<true>(other_, planes_, false);
  // A second pass removes streaks where an outline cuts the filter window, for example right under a ball.
  pass<false>(planes_, other_, true);
  pass<false>(other_, planes_, false);
  each_row([&](int y, SoftTexel* row) {
    for (int x = 0; x < width_; ++x) {
      const std::size_t at = row_start(y) + x;
      row[x].surface_open = surface_[at] + kOpen * planes_.open[at];
      for (std::size_t light = 0; light < kSoftLights; ++light) {
        const auto& [lit, too_crisp] = planes_.lights[light];
        row[x].lit[light] = lit[at] - (too_crisp[at] >= 0 ? kCrisp : 0.0f);
      }
    }
  });
}

}  // namespace weft::render
