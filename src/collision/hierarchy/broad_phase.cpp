#include "collision/hierarchy/broad_phase.hpp"

#include <map>
#include <utility>
#include <vector>

#include "collision/hierarchy/normal_cones.hpp"
#include "collision/hierarchy/traversal.hpp"
#include "core/error.hpp"

namespace weft::collision {

namespace {

template <int K, int Arity>
class TreesOf final : public BroadPhase::Trees {
 public:
  TreesOf(std::span<const Surface> surfaces, std::span<const Vec3> x, const BroadPhaseOptions& options)
      : options_(options) {
    trees_.reserve(surfaces.size());
    for (const Surface& surface : surfaces) {
      trees_.emplace_back(surface, x, options.leaf);
      if (options.normal_cones) cones_.emplace_back(trees_.back());
    }
  }

  void refit(std::size_t surface, std::span<const Vec3> x_t0, std::span<const Vec3> x_t1, double margin) override {
    if (options_.velocity_cones)
      trees_[surface].refit_lazily(x_t0, x_t1, margin);
    else
      trees_[surface].refit(x_t0, x_t1, margin);
    if (options_.normal_cones) cones_[surface].update(trees_[surface], x_t0, x_t1, 2 * margin);
  }

  void self_pairs(std::size_t surface, CandidatePairs& out) override {
    collision::self_pairs(trees_[surface], out, traversal(surface, surface));
  }

  void pairs(std::size_t a, std::size_t b, CandidatePairs& out) override {
    collision::pairs(trees_[a], trees_[b], out, traversal(a, b));
  }

  void forget() override {
    for (auto& tree : trees_) tree.forget();
    lists_.clear();
  }

 private:
  Traversal traversal(std::size_t a, std::size_t b) {
    return {options_.open_longer_side, options_.separation_list ? &lists_[{a, b}] : nullptr,
            options_.normal_cones && a == b ? &cones_[a].regions() : nullptr};
  }

  BroadPhaseOptions options_;
  std::vector<Tree<K, Arity>> trees_;
  std::vector<NormalCones<K, Arity>> cones_;                             // by surface, where wanted
  std::map<std::pair<std::size_t, std::size_t>, SeparationList> lists_;  // by surfaces
};

template <int K>
std::unique_ptr<BroadPhase::Trees> with_directions(std::span<const Surface> surfaces, std::span<const Vec3> x,
                                                   const BroadPhaseOptions& options) {
  switch (options.children) {
    case 2:
      return std::make_unique<TreesOf<K, 2>>(surfaces, x, options);
    case 4:
      return std::make_unique<TreesOf<K, 4>>(surfaces, x, options);
    case 8:
      return std::make_unique<TreesOf<K, 8>>(surfaces, x, options);
    default:
      throw Error(ExitCode::internal, "broad phase: expected 2, 4 or 8 children, got {}", options.children);
  }
}

std::unique_ptr<BroadPhase::Trees> make_trees(std::span<const Surface> surfaces, std::span<const Vec3> x,
                                              const BroadPhaseOptions& options) {
  switch (options.directions) {
    case 6:
      return with_directions<6>(surfaces, x, options);
    case 14:
      return with_directions<14>(surfaces, x, options);
    case 18:
      return with_directions<18>(surfaces, x, options);
    case 26:
      return with_directions<26>(surfaces, x, options);
    default:
      throw Error(ExitCode::internal, "broad phase: expected 6, 14, 18 or 26 directions, got {}", options.directions);
  }
}

}  // namespace

BroadPhase::BroadPhase(std::span<const Surface> surfaces, std::span<const Vec3> x, const BroadPhaseOptions& options)
    : trees_(make_trees(surfaces, x, options)) {}

void BroadPhase::refit(std::size_t surface, std::span<const Vec3> x_t0, std::span<const Vec3> x_t1, double margin) {
  trees_->refit(surface, x_t0, x_t1, margin);
}

void BroadPhase::self_pairs(std::size_t surface, CandidatePairs& out) {
  trees_->self_pairs(surface, out);
}

void BroadPhase::pairs(std::size_t a, std::size_t b, CandidatePairs& out) {
  trees_->pairs(a, b, out);
}

void BroadPhase::forget() {
  trees_->forget();
}

}  // namespace weft::collision
