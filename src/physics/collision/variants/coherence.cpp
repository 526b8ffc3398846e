#include "physics/collision/variants/coherence.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "physics/collision/hierarchy/kdop.hpp"
#include "physics/collision/hierarchy/split.hpp"

namespace weft::collision {

namespace {

/// Maximum number of triangles per group. Cones of smaller groups bound the motion more tightly,
/// but the time of an update grows with the square of the number of groups.
constexpr std::size_t kGroupSize = 128;
/// After every kReferenceUpdates updates, the present step becomes the reference step and all results are deleted, so
/// that the cones stay small.
constexpr int kReferenceUpdates = 64;

std::size_t surface_of(Index vertex, std::span<const Surface> surfaces) {
  const auto holds = [&](const Surface& s) {
    return vertex >= s.first_vertex && vertex < s.first_vertex + s.vertex_count;
  };
  return static_cast<std::size_t>(std::ranges::find_if(surfaces, holds) - surfaces.begin());
}

}  // namespace

CoherentDetection::CoherentDetection(std::span<const Surface> surfaces, std::vector<SurfacePair> surface_pairs,
                                     std::span<const Vec3> x, const CoherenceParameters& parameters)
    : surfaces_(surfaces.begin(), surfaces.end()),
      surface_pairs_(std::move(surface_pairs)),
      parameters_(parameters),
      kept_(surface_pairs_.size()) {
  for (const Surface& surface : surfaces) add_groups(surface, x);
}

// Divides a surface into groups: splits sets of triangles along their longest side until each is small enough.
void CoherentDetection::add_groups(const Surface& surface, std::span<const Vec3> x) {
  std::vector<Group>& groups = groups_.emplace_back();
  if (surface.triangles.empty()) return;
  std::vector<KDop<6>> bounds;
  for (const Triangle& t : surface.triangles) {
    bounds.push_back(swept_point<6>(x[t[0]], x[t[1]], 0));
    bounds.back().join(swept_point<6>(x[t[2]], x[t[2]], 0));
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
    for (const Index t : items)
      vertices.insert(vertices.end(), surface.triangles[t].begin(), surface.triangles[t].end());
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  }
}

int CoherentDetection::update(BroadPhase& broad_phase, ProximityFinder& finder, std::span<const Vec3> x_t0,
                              std::span<const Vec3> x_t1) {
  update_cones(x_t0, x_t1);
  std::vector<std::size_t> outdated;
  for (std::size_t w = 0; w < surface_pairs_.size(); ++w)
    if (!is_still_valid(surface_pairs_[w], kept_[w])) outdated.push_back(w);
  for (std::size_t s = 0; s < surfaces_.size(); ++s)
    broad_phase.refit(s, {x_t0, x_t1}, 0.5 * (parameters_.detection_distance + parameters_.budget));
  if (!outdated.empty()) search_again(outdated, broad_phase, finder, x_t0);
  proximities_.clear();
  largest_motion_ = 0;
  for (const KeptResult& kept : kept_) {
    append_proximities(kept, x_t0);
    largest_motion_ = std::max(largest_motion_, kept.motion);
  }
  return static_cast<int>(outdated.size());
}

// Updates the velocity cones to the step from x_t0 to x_t1.
void CoherentDetection::update_cones(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1) {
  if (updates_++ % kReferenceUpdates == 0) {
    reference_t0_.assign(x_t0.begin(), x_t0.end());
    reference_t1_.assign(x_t1.begin(), x_t1.end());
    for (KeptResult& kept : kept_) kept.valid = false;
  }
  for (std::vector<Group>& groups : groups_) {
    for (Group& group : groups) {
      // Compare the start of the step with the start of the reference step, and the end of the step with the end of the
      // reference step. Thus the motion within a step does not enlarge the cone.
      Vec3 mean = Vec3::Zero();
      group.low.setConstant(INFINITY);
      group.high.setConstant(-INFINITY);
      for (const Index v : group.vertices) {
        mean += x_t0[v] - reference_t0_[v] + x_t1[v] - reference_t1_[v];
        group.low = group.low.cwiseMin(x_t0[v]).cwiseMin(x_t1[v]);
        group.high = group.high.cwiseMax(x_t0[v]).cwiseMax(x_t1[v]);
      }
      mean /= 2.0 * static_cast<double>(group.vertices.size());
      double radius_sq = 0;
      for (const Index v : group.vertices)
        radius_sq = std::max({radius_sq, (x_t0[v] - reference_t0_[v] - mean).squaredNorm(),
                              (x_t1[v] - reference_t1_[v] - mean).squaredNorm()});
      group.cone = {mean, std::sqrt(radius_sq)};
    }
  }
}

bool CoherentDetection::is_still_valid(const SurfacePair& pair, KeptResult& kept) const {
  kept.motion = 0;
  for (std::size_t g = 0; kept.valid && g < kept.groups_a.size(); ++g) {
    for (std::size_t h = pair.a == pair.b ? g : 0; h < kept.groups_b.size(); ++h) {
      const GroupSnapshot &g_then = kept.groups_a[g], &h_then = kept.groups_b[h];
      const double motion =
          relative_motion(groups_[pair.a][g].cone - g_then.cone, groups_[pair.b][h].cone - h_then.cone);
      const double gap = (g_then.low - h_then.high).cwiseMax(h_then.low - g_then.high).maxCoeff();
      if (gap > parameters_.detection_distance + motion) continue;
      if (motion > parameters_.budget) return false;
      kept.motion = std::max(kept.motion, motion);
    }
  }
  return kept.valid;
}

// Searches the outdated pairs of surfaces together, because each call of gather() takes time for
// all vertices. Then assigns each near pair of features to its pair of surfaces.
void CoherentDetection::search_again(const std::vector<std::size_t>& pairs, BroadPhase& broad_phase,
                                     ProximityFinder& finder, std::span<const Vec3> x_t0) {
  CandidatePairs all;
  std::vector<Surface> with_themselves;
  for (const std::size_t w : pairs) {
    const auto& [a, b] = surface_pairs_[w];
    KeptResult& kept = kept_[w];
    kept = {};
    kept.valid = true;
    if (a == b) {
      broad_phase.self_pairs(a, kept.candidates);
      with_themselves.push_back(surfaces_[a]);
    } else {
      broad_phase.pairs(a, b, kept.candidates);
    }
    append(all, kept.candidates);
    for (const Group& group : groups_[a]) kept.groups_a.push_back({group.low, group.high, group.cone});
    for (const Group& group : groups_[b]) kept.groups_b.push_back({group.low, group.high, group.cone});
  }

  const double radius = parameters_.detection_distance + parameters_.budget;
  finder.gather(all, with_themselves, x_t0, radius, parameters_.min_fold);
  std::vector<Proximity> found;
  finder.find(x_t0, radius, found);
  for (const Proximity& proximity : found) {
    const std::size_t one = surface_of(proximity.vertices[0], surfaces_),
                      other = surface_of(proximity.vertices[3], surfaces_);
    const auto is_its = [&](std::size_t w) {
      return surface_pairs_[w].a == std::min(one, other) && surface_pairs_[w].b == std::max(one, other);
    };
    kept_[*std::ranges::find_if(pairs, is_its)].proximities.push_back(proximity);
  }

  candidates_.clear();
  for (const KeptResult& kept : kept_) append(candidates_, kept.candidates);
}

void CoherentDetection::append_proximities(const KeptResult& kept, std::span<const Vec3> x) {
  const double limit = parameters_.detection_distance + 2 * kept.motion;
  for (Proximity p : kept.proximities) {
    Vec3 difference = Vec3::Zero();
    for (std::size_t i = 0; i < 4; ++i) difference += p.weights[i] * x[p.vertices[i]];
    p.distance = difference.norm();
    if (!(p.distance < limit)) continue;
    if (p.distance > 0) p.normal = difference / p.distance;
    proximities_.push_back(p);
  }
}

}  // namespace weft::collision
