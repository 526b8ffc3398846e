#include "physics/collision/candidate_cache.hpp"

#include <algorithm>

#include "core/numerics.hpp"
#include "core/parallel_append.hpp"

namespace weft::collision {
namespace {

// With coherence, the pairs must include those with one common vertex. Without coherence,
// ProximityFinder adds these pairs itself.
BroadPhaseOptions options_of(const SearchParameters& parameters) {
  BroadPhaseOptions options = parameters.broad_phase;
  options.one_shared = parameters.coherence;
  return options;
}

}  // namespace

CandidateCache::CandidateCache(const Bodies& bodies, const SearchParameters& parameters, std::span<const Vec3> x,
                               double detection_distance)
    : bodies_(bodies),
      parameters_(parameters),
      detection_distance_(detection_distance),
      broad_phase_(bodies.surfaces(), x, options_of(parameters)),
      from_(x.begin(), x.end()),
      low_(from_),
      clear_(bodies.size()) {
  for (std::size_t a = 0; a < bodies.size(); ++a) {
    if (!bodies[a].deformable) continue;
    const auto is_cloth = [&](std::size_t body) { return bodies[body].deformable && !bodies[body].rigid; };
    if (parameters.self && is_cloth(a)) surface_pairs_.push_back({a, a});
    for (std::size_t b = a + 1; b < bodies.size(); ++b)
      if (is_cloth(a) && is_cloth(b) ? parameters.self : parameters.obstacles) surface_pairs_.push_back({a, b});
  }
}

CandidatePairs& CandidateCache::collect(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1) {
  return collect(x_t0, x_t1, x_t1);
}

CandidatePairs& CandidateCache::collect_more(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1, bool all) {
  std::vector<Vec3> low = low_, high = high_.empty() ? low_ : high_;
  parallel_for(x_t1.size(), kGrainSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      if (!all && is_at_end(v, x_t1[v], margin_)) continue;
      low[v] = low[v].cwiseMin(x_t0[v]).cwiseMin(x_t1[v]);
      high[v] = high[v].cwiseMax(x_t0[v]).cwiseMax(x_t1[v]);
    }
  });
  return collect(x_t0, low, high);
}

CandidatePairs& CandidateCache::collect(std::span<const Vec3> x_t0, std::span<const Vec3> low_t1,
                                        std::span<const Vec3> high_t1) {
  const Motion motion(x_t0, low_t1, high_t1);
  find_clear_bodies(motion);
  const double largest_motion = parallel_max(x_t0.size(), kGrainSize, 0.0, [&](std::size_t begin, std::size_t end) {
    double largest = 0;
    for (std::size_t i = begin; i < end; ++i)
      if (!is_clear(bodies_.body_of(static_cast<Index>(i))))
        largest = std::max(largest, (high_t1[i] - x_t0[i]).cwiseMax(x_t0[i] - low_t1[i]).maxCoeff());
    return largest;
  });
  // In a slow step, add the Verlet margin so that the pairs last for several steps.
  const double verlet_margin = 2 * numerics.contact.verlet_margin * detection_distance_;
  const double margin =
      0.5 * detection_distance_ + (parameters_.reuse && largest_motion < verlet_margin ? verlet_margin : 0.0);
  refit(motion, margin);
  pairs_.clear();
  for (const auto& [a, b] : surface_pairs_)
    a == b ? broad_phase_.self_pairs(a, pairs_) : broad_phase_.pairs(a, b, pairs_);
  cover(motion, margin);
  return pairs_;
}

void CandidateCache::cover(const Motion& motion, double margin) {
  from_.assign(motion.x_t0.begin(), motion.x_t0.end());
  low_.assign(motion.low_t1.begin(), motion.low_t1.end());
  high_.clear();
  if (motion.high_t1.data() != motion.low_t1.data()) high_.assign(motion.high_t1.begin(), motion.high_t1.end());
  margin_ = margin;
}

// Finds the clear obstacles (see CandidateCache) by bounding boxes. Two detection distances are at
// least the sum of the margins of an obstacle and a particle.
void CandidateCache::find_clear_bodies(const Motion& motion) {
  const auto extend = [&](std::size_t body, Box3& box) {
    for (std::span<const Vec3> x : {motion.x_t0, motion.low_t1, motion.high_t1})
      for (const Vec3& place : bodies_.part(body, x)) box.extend(place);
  };
  Box3 cloth;
  for (std::size_t b = 0; b < bodies_.size(); ++b)
    if (bodies_[b].deformable) extend(b, cloth);
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    clear_[b] = {};
    if (bodies_[b].deformable) continue;
    Box3 box;
    extend(b, box);
    for (int axis = 0; axis < 3; ++axis)
      for (const double sign : {1.0, -1.0}) {
        const double from = 2 * detection_distance_ + (sign > 0 ? cloth.max()[axis] : -cloth.min()[axis]);
        if ((sign > 0 ? box.min()[axis] : -box.max()[axis]) >= from) clear_[b] = {axis, sign, from};
      }
  }
}

// Refits the bounds of all bodies. Skips an obstacle if its bounds are still the same: it stands
// still in this step, it stood still at the same place in the step of the last refit, and the
// margin is unchanged.
void CandidateCache::refit(const Motion& motion, double margin) {
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const auto stays = [&](std::span<const Vec3> x) {
      return x.size() == motion.x_t0.size() && std::ranges::equal(bodies_.part(b, motion.x_t0), bodies_.part(b, x));
    };
    const bool still = !bodies_[b].deformable && margin == margin_ && stays(motion.low_t1) && stays(motion.high_t1) &&
                       stays(from_) && stays(low_end()) && stays(high_end());
    if (!still) broad_phase_.refit(b, motion, margin);
  }
}

bool CandidateCache::covers_start(std::span<const Vec3> x) const {
  if (margin_ < 0) return false;
  const double verlet_margin = margin_ - 0.5 * detection_distance_;
  return parallel_all_of(x.size(), [&](std::size_t i) {
    return (x[i] - from_[i]).squaredNorm() <= verlet_margin * verlet_margin || is_kept_clear(i, x[i]);
  });
}

bool CandidateCache::is_kept_clear(std::size_t vertex, const Vec3& x) const {
  return clear_[bodies_.body_of(static_cast<Index>(vertex))].holds(x);
}

// Whether x is within the margin of the vertex's end box (low_ to high_), or in the half-space of its obstacle.
bool CandidateCache::is_at_end(std::size_t vertex, const Vec3& x, double margin) const {
  const Vec3 beyond = (x - high_end()[vertex]).cwiseMax(low_[vertex] - x);
  // Bounds with 6 directions contain all points within the margin along each axis. Bounds with more directions contain
  // only those within the margin in Euclidean distance.
  const bool boxes = parameters_.broad_phase.directions == 6;
  const double distance = boxes ? beyond.maxCoeff() : beyond.cwiseMax(0).norm();
  return distance <= margin || is_kept_clear(vertex, x);
}

bool CandidateCache::are_at_end(std::span<const Vec3> x, double margin) const {
  return margin_ >= 0 && parallel_all_of(x.size(), [&](std::size_t i) { return is_at_end(i, x[i], margin); });
}

bool CandidateCache::bounds_contain(std::span<const Vec3> x) const {
  return margin_ >= 0 &&
         parallel_all_of(x.size(), [&](std::size_t i) { return (x[i] - from_[i]).squaredNorm() <= margin_ * margin_; });
}

void CandidateCache::forget() {
  if (!BroadPhase::remembers(parameters_.broad_phase)) return;
  broad_phase_.forget();
  margin_ = -1;
}

}  // namespace weft::collision
