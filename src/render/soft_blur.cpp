#include "render/soft_blur.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "render/drawing_time.hpp"
#include "render/seen.hpp"

namespace weft::render {
namespace {

// Texels that one looks at to each side.
constexpr int kReach = 2, kTaps = 2 * kReach + 1;
// Weight of a share of light beside, against a texel's own.
constexpr float kBeside = 0.5f;
// Change of a light's share from texel to texel beyond which it is not blurred away: on floor, and on what is curved,
// where half of it may be noise of the faces.
constexpr float kCrispFloor = 0.25f, kCrispCurved = 0.45f;
// Another fold is two of these shares of the distance away.
constexpr float kFold = 0.01f;
// Texels beside that are of this surface by less than one in this many are hardly asked for the steepness of light.
constexpr float kCounts = 100;
constexpr std::size_t kRows = 16;  // that a thread takes at once

// Eight texels at once.
using Lanes = Eigen::Array<float, 8, 1>;
constexpr int kLanes = 8;

Lanes load(const float* from) {
  return Eigen::Map<const Lanes>(from);
}
void store(const Lanes& lanes, float* to) {
  Eigen::Map<Lanes>{to} = lanes;
}

// Of whole numbers: 1 where they are equal, else 0.
Lanes equal(const Lanes& a, const Lanes& b) {
  return (1 - (a - b).abs()).max(0.0f);
}

// The smaller of two changes where both are of one sign, else 0.
Lanes agreed(const Lanes& a, const Lanes& b) {
  return a.min(b).max(0.0f) + a.max(b).min(0.0f);
}

}  // namespace

SoftBlur::SoftBlur(int width, int height)
    : width_(width), height_(height), stride_((width + kLanes - 1) / kLanes * kLanes + 2 * kReach) {
  for (Plane* plane : {&surface_, &distance_}) plane->assign(stride_ * height, 1.0f);
  for (Planes* planes : {&planes_, &other_}) {
    planes->open.assign(stride_ * height, 1.0f);
    for (auto& [lit, too_crisp] : planes->lights) lit = too_crisp = planes->open;
  }
}

/// Of the first texel of a row.
std::size_t SoftBlur::place(int y) const {
  return stride_ * y + kReach;
}

void SoftBlur::extend(Plane& plane, int y) const {
  float* first = plane.data() + place(y);
  std::fill(first - kReach, first, *first);
  std::fill(first + width_, first - kReach + stride_, first[width_ - 1]);
}

template <bool kShares>
void SoftBlur::pass(const Planes& from, Planes& to, bool across) const {
  drawing_for(static_cast<std::size_t>(height_), kRows, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      std::array<std::size_t, kTaps> taps;
      for (int i = 0; i < kTaps; ++i)
        taps[i] = across ? place(y) + i - kReach : place(std::clamp(y + i - kReach, 0, height_ - 1));
      for (int x = 0; x < width_; x += kLanes) {
        const auto at = [&](const Plane& plane, int i) { return load(plane.data() + taps[i] + x); };
        const Lanes surface = at(surface_, kReach), distance = at(distance_, kReach);
        // How the surface goes on to both sides, so that slanted ones count in full and the noise of all taps cancels
        // out.
        const Lanes slope = agreed(distance - at(distance_, kReach - 1), at(distance_, kReach + 1) - distance);
        Lanes open = at(from.open, kReach), weight = Lanes::Ones(), weight_beside = Lanes::Ones();
        std::array<Lanes, kSoftLights> lit, steepest;
        for (std::size_t light = 0; kShares && light < kSoftLights; ++light) {
          lit[light] = at(from.lights[light].lit, kReach);
          steepest[light].setZero();
        }
        for (int i = 0; i < kTaps; ++i) {
          if (i == kReach) continue;
          const Lanes off = (at(distance_, i) - distance - static_cast<float>(i - kReach) * slope).abs();
          const Lanes same = equal(at(surface_, i), surface) * (2 - off / (kFold * distance)).max(0.0f).min(1.0f);
          open += same * at(from.open, i);
          weight += same;
          if (!kShares || std::abs(i - kReach) != 1) continue;
          const Lanes beside = kBeside * same, counts = (kCounts * same).min(1.0f);
          weight_beside += beside;
          for (std::size_t light = 0; light < kSoftLights; ++light) {
            const Plane& shares = from.lights[light].lit;
            const Lanes there = at(shares, i);
            lit[light] += beside * there;
            steepest[light] = steepest[light].max(counts * (there - at(shares, kReach)).abs());
          }
        }
        const std::size_t here = place(y) + x;
        store(open / weight, to.open.data() + here);
        const Lanes limit = kCrispCurved + (kCrispFloor - kCrispCurved) * equal(surface, Lanes::Constant(kFloor));
        for (std::size_t light = 0; kShares && light < kSoftLights; ++light) {
          store(lit[light] / weight_beside, to.lights[light].lit.data() + here);
          // Pixels beside what is crisp search for themselves: what is blurred here would lie as a second line along
          // the edge.
          store(at(from.lights[light].too_crisp, kReach).max(steepest[light] - limit),
                to.lights[light].too_crisp.data() + here);
        }
      }
      extend(to.open, y);
      for (std::size_t light = 0; kShares && light < kSoftLights; ++light) {
        extend(to.lights[light].lit, y);
        extend(to.lights[light].too_crisp, y);
      }
    }
  });
}

void SoftBlur::smooth(std::vector<SoftTexel>& texels) {
  const auto each_row = [&](const auto& body) {
    drawing_for(static_cast<std::size_t>(height_), kRows, [&](std::size_t begin, std::size_t end) {
      for (std::size_t y = begin; y < end; ++y) body(static_cast<int>(y), texels.data() + y * width_);
    });
  };
  // Packed as in shaders/soft_light.glsl.
  constexpr float kOpen = 0.9375f, kCrisp = 2, kCrispFrom = -0.5f;
  each_row([&](int y, const SoftTexel* row) {
    for (int x = 0; x < width_; ++x) {
      const std::size_t at = place(y) + x;
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
  // A second time, for where an outline cuts the window within which taps make up for each other: right under a ball
  // the first leaves streaks.
  pass<false>(planes_, other_, true);
  pass<false>(other_, planes_, false);
  each_row([&](int y, SoftTexel* row) {
    for (int x = 0; x < width_; ++x) {
      const std::size_t at = place(y) + x;
      row[x].surface_open = surface_[at] + kOpen * planes_.open[at];
      for (std::size_t light = 0; light < kSoftLights; ++light) {
        const auto& [lit, too_crisp] = planes_.lights[light];
        row[x].lit[light] = lit[at] - (too_crisp[at] >= 0 ? kCrisp : 0.0f);
      }
    }
  });
}

}  // namespace weft::render
