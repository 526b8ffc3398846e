#include "physics/collision/hierarchy/broad_phase.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "physics/collision/hierarchy/traversal.hpp"
#include "physics/collision/variants/normal_cones.hpp"

namespace weft::collision {

namespace {

template <int K>
class TreesOf final : public BroadPhase::Trees {
 public:
  TreesOf(std::span<const Surface> surfaces, std::span<const Vec3> x, const BroadPhaseOptions& options)
      : options_(options) {
    trees_.reserve(surfaces.size());
    for (const Surface& surface : surfaces) {
      trees_.emplace_back(surface, x, TreeShape{options.children, options.leaf});
      if (options.normal_cones) cones_.emplace_back(trees_.back());
    }
  }

  void refit(std::size_t surface, const Motion& motion, double margin) override {
    if (options_.velocity_cones)
      trees_[surface].refit_lazily(motion, margin);
    else
      trees_[surface].refit(motion, margin);
    if (!options_.normal_cones) return;
    // Normal cones need one end position per vertex. If the ends are boxes, pass an infinite distance, so that no
    // region counts as flat.
    const bool is_known = std::ranges::equal(motion.low_t1, motion.high_t1);
    const double detection_distance = is_known ? 2 * margin : std::numeric_limits<double>::infinity();
    cones_[surface].update(trees_[surface], motion.x_t0, motion.low_t1, detection_distance);
  }

  void self_pairs(std::size_t surface, CandidatePairs& out) override {
    collision::self_pairs(trees_[surface], out, traversal(surface, surface));
  }

  void pairs(std::size_t a, std::size_t b, CandidatePairs& out) override {
    collision::pairs(trees_[a], trees_[b], out, traversal(a, b));
  }

  void nearest_triangles(std::size_t surface, const Vec3& p, const DistanceSq& distance_sq,
                         std::vector<Index>& out) const override {
    collision::nearest_triangles(trees_[surface], p, distance_sq, out);
  }

  void triangles_in_box(std::size_t surface, const Vec3& low, const Vec3& high,
                        std::vector<Index>& out) const override {
    collision::triangles_in_box(trees_[surface], low, high, out);
  }

  void forget() override {
    for (auto& tree : trees_) tree.forget();
    separation_lists_.clear();
  }

 private:
  Traversal traversal(std::size_t a, std::size_t b) {
    return {options_.open_longer_side, options_.separation_list ? &separation_lists_[{a, b}] : nullptr,
            options_.normal_cones && a == b ? &cones_[a].regions() : nullptr, options_.one_shared};
  }

  BroadPhaseOptions options_;
  std::vector<Tree<K>> trees_;
  std::vector<NormalCones<K>> cones_;                                               // by surface, if enabled
  std::map<std::pair<std::size_t, std::size_t>, SeparationList> separation_lists_;  // by pair of surfaces
};

std::unique_ptr<BroadPhase::Trees> make_trees(std::span<const Surface> surfaces, std::span<const Vec3> x,
                                              const BroadPhaseOptions& options) {
  switch (options.directions) {
    case 6:
      return std::make_unique<TreesOf<6>>(surfaces, x, options);
    case 18:
      return std::make_unique<TreesOf<18>>(surfaces, x, options);
    case 26:
      return std::make_unique<TreesOf<26>>(surfaces, x, options);
    default:
      throw Error(ExitCode::internal, "broad phase: expected 6, 18 or 26 directions, got {}", options.directions);
  }
}

}  // namespace

BroadPhase::BroadPhase(std::span<const Surface> surfaces, std::span<const Vec3> x, const BroadPhaseOptions& options)
    : surfaces_(surfaces.begin(), surfaces.end()), trees_(make_trees(surfaces, x, options)) {}

}  // namespace weft::collision
