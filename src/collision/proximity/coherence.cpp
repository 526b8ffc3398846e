#include "collision/proximity/coherence.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "collision/hierarchy/kdop.hpp"
#include "collision/hierarchy/split.hpp"

namespace weft::collision {

namespace {

/// Triangles per group: fewer follow the motion more closely, and cost with the square of their number.
constexpr std::size_t kGroupSize = 128;

const Vec3& at(std::span<const Vec3> x, Index v) {
  return x[static_cast<std::size_t>(v)];
}

}  // namespace

CoherentDetection::CoherentDetection(std::span<const Surface> surfaces, std::span<const Vec3> x, double reach,
                                     double budget)
    : reach_(reach), budget_(budget) {
  for (const Surface& surface : surfaces) add_groups(surface, x, groups_.emplace_back());
}

/// Halves by the longest side until a group is small.
void CoherentDetection::add_groups(const Surface& surface, std::span<const Vec3> x, std::vector<Group>& groups) const {
  std::vector<KDop<6>> bounds;
  for (const Triangle& t : surface.triangles) {
    bounds.push_back(swept_point<6>(at(x, t[0]), at(x, t[1]), 0));
    bounds.back().join(swept_point<6>(at(x, t[2]), at(x, t[2]), 0));
  }
  std::vector<Index> order(bounds.size());
  std::iota(order.begin(), order.end(), Index{0});
  std::vector<std::span<Index>> open{order};
  while (!open.empty()) {
    const std::span<Index> items = open.back();
    open.pop_back();
    if (items.size() > kGroupSize) {
      const std::size_t first = split_longest_side<6>(items, bounds);
      open.push_back(items.first(first));
      open.push_back(items.subspan(first));
      continue;
    }
    std::vector<Index>& vertices = groups.emplace_back().vertices;
    for (const Index t : items) {
      const Triangle& corners = surface.triangles[static_cast<std::size_t>(t)];
      vertices.insert(vertices.end(), corners.begin(), corners.end());
    }
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  }
}

void CoherentDetection::advance(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1) {
  if (steps_++ % kReferenceSteps == 0) {
    reference_t0_.assign(x_t0.begin(), x_t0.end());
    reference_t1_.assign(x_t1.begin(), x_t1.end());
    kept_.clear();
  }
  for (std::vector<Group>& groups : groups_) {
    for (Group& group : groups) {
      // Begin and end of the step each against their own reference, so that a steady motion counts once.
      Vec3 mean = Vec3::Zero();
      group.low.setConstant(INFINITY);
      group.high.setConstant(-INFINITY);
      for (const Index v : group.vertices) {
        mean += at(x_t0, v) - at(reference_t0_, v) + at(x_t1, v) - at(reference_t1_, v);
        group.low = group.low.cwiseMin(at(x_t0, v)).cwiseMin(at(x_t1, v));
        group.high = group.high.cwiseMax(at(x_t0, v)).cwiseMax(at(x_t1, v));
      }
      mean /= 2.0 * static_cast<double>(group.vertices.size());
      double radius_sq = 0;
      for (const Index v : group.vertices)
        radius_sq = std::max({radius_sq, (at(x_t0, v) - at(reference_t0_, v) - mean).squaredNorm(),
                              (at(x_t1, v) - at(reference_t1_, v) - mean).squaredNorm()});
      group.cone = VelocityCone(mean, std::sqrt(radius_sq));
    }
  }
}

bool CoherentDetection::holds(std::size_t a, std::size_t b) {
  const auto found = kept_.find({a, b});
  if (found == kept_.end()) return false;
  Kept& kept = found->second;
  kept.motion = 0;
  for (std::size_t g = 0; g < kept.groups_a.size(); ++g) {
    for (std::size_t h = a == b ? g : 0; h < kept.groups_b.size(); ++h) {
      const Group &g_then = kept.groups_a[g], &h_then = kept.groups_b[h];
      // What has been added to the motions of each since then.
      const VelocityCone &g_now = groups_[a][g].cone, &h_now = groups_[b][h].cone;
      const VelocityCone since_g(g_now.mean() - g_then.cone.mean(), g_now.radius() + g_then.cone.radius());
      const VelocityCone since_h(h_now.mean() - h_then.cone.mean(), h_now.radius() + h_then.cone.radius());
      const double motion = relative_motion(since_g, since_h);
      const double gap = (g_then.low - h_then.high).cwiseMax(h_then.low - g_then.high).maxCoeff();
      if (gap > reach_ + motion) continue;
      if (motion > budget_) return false;
      kept.motion = std::max(kept.motion, motion);
    }
  }
  return true;
}

void CoherentDetection::keep(std::size_t a, std::size_t b, const CandidatePairs& candidates,
                             std::span<const Proximity> proximities) {
  Kept& kept = kept_[{a, b}];
  kept.candidates = candidates;
  kept.proximities.assign(proximities.begin(), proximities.end());
  kept.motion = 0;
  for (auto [groups, surface] : {std::pair(&kept.groups_a, a), std::pair(&kept.groups_b, b)}) {
    groups->clear();
    for (const Group& group : groups_[surface]) groups->push_back({{}, group.low, group.high, group.cone});
  }
}

void CoherentDetection::proximities(std::size_t a, std::size_t b, std::span<const Vec3> x,
                                    std::vector<Proximity>& out) const {
  const Kept& kept = kept_.at({a, b});
  const double limit = reach_ + 2 * kept.motion;
  for (Proximity p : kept.proximities) {
    Vec3 difference = Vec3::Zero();
    for (std::size_t i = 0; i < 4; ++i) difference += p.weights[i] * at(x, p.vertices[i]);
    p.distance = difference.norm();
    if (!(p.distance < limit)) continue;
    if (p.distance > 0) p.normal = difference / p.distance;
    out.push_back(p);
  }
}

}  // namespace weft::collision
