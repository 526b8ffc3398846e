#include "collision/candidate_cache.hpp"

#include <algorithm>

namespace weft::collision {
namespace {

// Bounds of slow steps are enlarged by this much more, in reaches, so that the candidates hold for several steps.
constexpr double kSkin = 0.5;

}  // namespace

CandidateCache::CandidateCache(const Bodies& bodies, const SearchParameters& parameters, std::span<const Vec3> x,
                               double reach)
    : bodies_(bodies),
      parameters_(parameters),
      reach_(reach),
      broad_phase_(bodies.surfaces(), x, parameters.broad_phase),
      from_(x.begin(), x.end()),
      to_(from_) {}

CandidatePairs& CandidateCache::collect(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1) {
  double motion = 0;
  for (std::size_t i = 0; i < x_t0.size(); ++i) motion = std::max(motion, (x_t1[i] - x_t0[i]).cwiseAbs().maxCoeff());
  const double margin = (0.5 + (parameters_.reuse && motion < kSkin * reach_ ? kSkin : 0.0)) * reach_;
  refit(x_t0, x_t1, margin);
  pairs_.clear();
  for (std::size_t a = 0; a < bodies_.size(); ++a) {
    if (!bodies_[a].deformable) continue;
    if (parameters_.self) broad_phase_.self_pairs(a, pairs_);
    for (std::size_t b = a + 1; b < bodies_.size(); ++b)
      if (bodies_[b].deformable ? parameters_.self : parameters_.obstacles) broad_phase_.pairs(a, b, pairs_);
  }
  from_.assign(x_t0.begin(), x_t0.end());
  to_.assign(x_t1.begin(), x_t1.end());
  margin_ = margin;
  return pairs_;
}

// A still obstacle keeps the bounds it has.
void CandidateCache::refit(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1, double margin) {
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const auto same = [&](std::span<const Vec3> x, std::span<const Vec3> y) {
      return x.size() == y.size() && std::ranges::equal(bodies_.part(b, x), bodies_.part(b, y));
    };
    const bool still =
        !bodies_[b].deformable && margin == margin_ && same(x_t0, x_t1) && same(x_t0, from_) && same(x_t0, to_);
    if (!still) broad_phase_.refit(b, x_t0, x_t1, margin);
  }
}

bool CandidateCache::covers_start(std::span<const Vec3> x) const {
  if (margin_ < 0) return false;
  const double skin = margin_ - 0.5 * reach_;
  for (std::size_t i = 0; i < x.size(); ++i)
    if (!((x[i] - from_[i]).squaredNorm() <= skin * skin)) return false;
  return true;
}

bool CandidateCache::covers_end(std::span<const Vec3> x) const {
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Vec3 out = (x[i] - from_[i].cwiseMax(to_[i])).cwiseMax(from_[i].cwiseMin(to_[i]) - x[i]);
    if (!(out.maxCoeff() <= margin_)) return false;
  }
  return true;
}

void CandidateCache::forget() {
  if (!BroadPhase::remembers(parameters_.broad_phase)) return;
  broad_phase_.forget();
  margin_ = -1;
}

}  // namespace weft::collision
