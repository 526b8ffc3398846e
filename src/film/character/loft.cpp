#include "film/character/loft.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace weft::character {
namespace {

/// |x|^n. For ellipses (n = 2), avoids std::pow, which is slow.
double power(double x, double n) {
  return n == 2 ? x * x : std::pow(std::abs(x), n);
}

/// Slopes at the knots of a cubic spline whose slope is zero at both ends. The slopes s at the inner knots i solve this
/// tridiagonal system, where h and d are the lengths and slopes of the chords:
/// h[i] s[i-1] + 2 (h[i-1] + h[i]) s[i] + h[i-1] s[i+1] = 3 (h[i] d[i-1] + h[i-1] d[i]).
std::vector<double> spline_slopes(const std::vector<double>& at, const std::vector<double>& value) {
  const std::size_t n = at.size();
  std::vector<double> slope(n, 0.0), upper(n, 0.0);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double h0 = at[i] - at[i - 1], h1 = at[i + 1] - at[i];
    const double d0 = (value[i] - value[i - 1]) / h0, d1 = (value[i + 1] - value[i]) / h1;
    const double diagonal = 2 * (h0 + h1) - h1 * upper[i - 1];
    upper[i] = h0 / diagonal;
    slope[i] = (3 * (h1 * d0 + h0 * d1) - h1 * slope[i - 1]) / diagonal;
  }
  for (std::size_t i = n - 1; i-- > 1;) slope[i] -= upper[i] * slope[i + 1];
  return slope;
}

}  // namespace

// The cubic smooth minimum of Quilez ("Smooth minimum", 2013), which is twice continuously differentiable.
double smooth_min(double a, double b, double width) {
  const double h = std::max(width - std::abs(a - b), 0.0) / width;
  return std::min(a, b) - h * h * h * width / 6;
}

Loft::Loft(const LoftFrame& frame, const std::vector<Section>& sections, double first_cap, double last_cap)
    : frame_(frame), first_cap_(first_cap), last_cap_(last_cap) {
  for (const Section& s : sections) {
    at_.push_back(s.at);
    sizes_.push_back({s.u, s.v, s.side, s.front, s.back, s.exponent});
  }
  slopes_.assign(at_.size(), Sizes{});
  for (std::size_t k = 0; k < kSizes; ++k) {
    std::vector<double> value;
    for (const Sizes& s : sizes_) value.push_back(s[k]);
    const std::vector<double> slope = at_.size() > 1 ? spline_slopes(at_, value) : std::vector<double>{0.0};
    for (std::size_t i = 0; i < slope.size(); ++i) slopes_[i][k] = slope[i];
  }
  // Splines may exceed the values at their knots. The bounds therefore enclose fine samples, with a margin of 1 %.
  constexpr int samples = 64;
  for (int i = 0; i <= samples; ++i) {
    const Sizes s = sizes_at(at_.front() + (at_.back() - at_.front()) * i / samples);
    for (const double t : {at_.front() - first_cap, at_.back() + last_cap}) {
      for (const double u : {s[0] - s[2], s[0] + s[2]}) {
        for (const double v : {s[1] - s[4], s[1] + s[3]}) {
          bounds_.extend(frame.origin + t * frame.along + u * frame.u + v * frame.v);
        }
      }
    }
  }
  const Vec3 spare = 0.01 * bounds_.sizes();
  bounds_.extend(Vec3(bounds_.min() - spare));
  bounds_.extend(Vec3(bounds_.max() + spare));
}

Loft::Sizes Loft::sizes_at(double t) const {
  if (t <= at_.front()) return sizes_.front();
  if (t >= at_.back()) return sizes_.back();
  const auto i = static_cast<std::size_t>(std::upper_bound(at_.begin(), at_.end(), t) - at_.begin()) - 1;
  const double h = at_[i + 1] - at_[i], s = (t - at_[i]) / h;
  // Hermite polynomials.
  const double a = (1 + 2 * s) * (1 - s) * (1 - s), b = s * (1 - s) * (1 - s) * h, c = s * s * (3 - 2 * s),
               d = s * s * (s - 1) * h;
  Sizes out{};
  for (std::size_t k = 0; k < kSizes; ++k) {
    out[k] = a * sizes_[i][k] + b * slopes_[i][k] + c * sizes_[i + 1][k] + d * slopes_[i + 1][k];
  }
  return out;
}

double Loft::value(const Vec3& p) const {
  const Vec3 q = p - frame_.origin;
  const double t = q.dot(frame_.along);
  const Sizes s = sizes_at(t);
  const double u = q.dot(frame_.u) - s[0], v = q.dot(frame_.v) - s[1];
  const double beyond = t < at_.front() ? t - at_.front() : std::max(t - at_.back(), 0.0);
  const double cap = beyond < 0 ? beyond / first_cap_ : beyond / last_cap_;
  const double n = s[5];
  const double across = power(u / s[2], n) + power(v / (v > 0 ? s[3] : s[4]), n);
  const double rho_sq = (n == 2 ? across : std::pow(across, 2 / n)) + cap * cap;
  // The value is a distance along the ray from the centre of the section through p. If p is the centre, the ray has no
  // direction, and the value is minus the smallest half width or depth.
  const double rho = std::sqrt(rho_sq), length = std::sqrt(u * u + v * v + beyond * beyond);
  return rho < 1e-9 ? -std::min({s[2], s[3], s[4]}) : length * (1 - 1 / rho);
}

double BlendedBody::Part::value(const Vec3& p) const {
  const double whole = shape.value(p);
  return cut ? -smooth_min(-whole, -cut(p), blend) : whole;
}

void BlendedBody::append(Part part) {
  if (groups_.empty()) begin_group();
  Group& group = groups_.back();
  group.bounds.extend(part.shape.bounds());
  group.max_blend = std::max(group.max_blend, part.blend);
  group.paired = group.paired || part.paired;
  parts_.push_back(std::move(part));
  group.end = parts_.size();
}

double BlendedBody::operator()(const Vec3& p) const {
  constexpr double nothing = std::numeric_limits<double>::max();
  const Vec3 mirrored(-p.x(), p.y(), p.z());
  double f = nothing;
  std::size_t next = 0;
  for (const Group& group : groups_) {
    const std::size_t first = std::exchange(next, group.end);
    // A group is skipped only if all its parts have no effect by the test below. Rounding cannot change this, because
    // rounded sums and distances to boxes are monotonic: no part is nearer than the group, or has a larger limit.
    const double max_group_distance = f == nothing ? nothing : group.max_blend + std::abs(f);
    const auto is_far = [&](const Vec3& at) { return group.bounds.exteriorDistance(at) >= max_group_distance; };
    if (is_far(p) && (!group.paired || is_far(mirrored))) continue;
    for (std::size_t k = first; k < group.end; ++k) {
      const Part& part = parts_[k];
      // A part has no effect if its distance exceeds the blend width plus f (for a carved part, minus f).
      const double max_distance = f == nothing ? nothing : part.blend + (part.carved ? -f : f);
      const auto is_near = [&](const Vec3& at) { return part.shape.bounds().exteriorDistance(at) < max_distance; };
      double value = nothing;
      if (is_near(p)) value = part.value(p);
      // Blends a paired part with its mirror image first, so that the field is symmetric in x.
      if (part.paired && part.shape.bounds().exteriorDistance(mirrored) < std::min(max_distance, value + part.blend)) {
        const double image = part.value(mirrored);
        value = value == nothing ? image : smooth_min(value, image, part.blend);
      }
      if (value == nothing) continue;
      f = part.carved ? -smooth_min(-f, value, part.blend) : f == nothing ? value : smooth_min(f, value, part.blend);
    }
  }
  return f;
}

Box3 BlendedBody::bounds() const {
  Box3 box;
  for (const Part& part : parts_) {
    if (part.carved) continue;
    box.extend(part.shape.bounds());
    if (!part.paired) continue;
    for (const Vec3& p : {part.shape.bounds().min(), part.shape.bounds().max()}) {
      box.extend(Vec3(-p.x(), p.y(), p.z()));
    }
  }
  return box;
}

}  // namespace weft::character
