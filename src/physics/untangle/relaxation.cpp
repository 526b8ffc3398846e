#include "physics/untangle/relaxation.hpp"

#include <algorithm>
#include <cmath>

#include "core/parallel.hpp"

namespace weft::untangle {
namespace {

constexpr int kSweepsPerRaise = 5;  // number of sweeps between calls of raise()
// relax() corrects this fraction of the error of a bending link (UntangleInput::Link::is_bend).
constexpr double kBendFraction = 0.2;

}  // namespace

void raise(const UntangleInput& input, std::span<const ForbiddenRegion> solids, std::span<Vec3> x) {
  parallel_for(static_cast<std::size_t>(input.particles()), kFineGrainSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (!input.movable[i]) continue;
      const double height = input.min_height[input.bodies.body_of(static_cast<Index>(i))];
      for (const ForbiddenRegion& solid : solids) {
        if (!solid.is_near(x[i], height)) continue;
        const ForbiddenRegion::Exit exit = solid.find_exit(x[i]);
        if (exit.height < height) x[i] = exit.place + height * exit.normal;
      }
    }
  });
}

void relax(const UntangleInput& input, std::span<const ForbiddenRegion> solids, int sweeps, std::span<Vec3> x) {
  for (int sweep = 1; sweep <= sweeps; ++sweep) {
    for (const UntangleInput::Link& link : input.links) {
      const Vec3 between = x[link.j] - x[link.i];
      const double sq = between.squaredNorm();
      if (sq <= link.max_length * link.max_length && sq >= link.min_length * link.min_length) continue;
      const int ends = (input.movable[link.i] ? 1 : 0) + (input.movable[link.j] ? 1 : 0);
      if (ends == 0 || sq == 0) continue;
      const double length = std::sqrt(sq);
      const double error = length - std::clamp(length, link.min_length, link.max_length);
      const Vec3 push = (link.is_bend ? kBendFraction : 1.0) * error / (length * ends) * between;
      if (input.movable[link.i]) x[link.i] += push;
      if (input.movable[link.j]) x[link.j] -= push;
    }
    if (sweep % kSweepsPerRaise == 0 || sweep == sweeps) raise(input, solids, x);
  }
}

void smooth(const UntangleInput& input, std::span<const Index> particles, int rings, int times, std::span<Vec3> x) {
  std::vector<std::uint8_t> in_region(static_cast<std::size_t>(input.particles()), 0);
  std::vector<Index> region;
  const auto take = [&](Index i) {
    if (!input.is_cloth(i) || in_region[i]) return;
    in_region[i] = 1;
    region.push_back(i);
  };
  for (const Index i : particles) take(i);
  std::size_t begin = 0;
  for (int ring = 0; ring < rings; ++ring)
    for (const std::size_t end = region.size(); begin < end; ++begin)
      for (const Index j : input.neighbours[region[begin]]) take(j);
  std::ranges::sort(region);
  for (int time = 0; time < times; ++time) {
    for (const Index i : region) {
      if (!input.movable[i]) continue;
      Vec3 sum = Vec3::Zero();
      int count = 0;
      for (const Index j : input.neighbours[i]) {
        if (input.on_border[i] && !input.on_border[j]) continue;
        sum += x[j];
        ++count;
      }
      if (count > (input.on_border[i] ? 1 : 0)) x[i] = sum / count;
    }
  }
}

}  // namespace weft::untangle
