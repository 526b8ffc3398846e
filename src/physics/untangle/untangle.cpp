#include "physics/untangle/untangle.hpp"

#include <algorithm>
#include <cmath>

#include "physics/collision/proximity/surface_point.hpp"
#include "physics/collision/response/separating_plane.hpp"
#include "physics/untangle/contours.hpp"
#include "physics/untangle/crossings.hpp"
#include "physics/untangle/forbidden_region.hpp"
#include "physics/untangle/relaxation.hpp"

namespace weft::untangle {
namespace {

// Minimum gap between surfaces, relative to the larger thickness of the two: far above Numerics::Separation::least_gap.
constexpr double kGapInThicknesses = 0.1;
constexpr int kMaxRounds = 400;
// After kPatience rounds in which the number of crossing pairs does not reach a new minimum, the
// cloth around the remaining crossings is smoothed, each time over a larger area, at most
// kMaxSmoothings times.
constexpr int kPatience = 12, kMaxSmoothings = 12;
// Maximum number of islands of a CrossedPair that are tried one by one.
constexpr std::size_t kMaxSingleIslands = 12;
constexpr int kSweepsAfterMove = 120, kSweeps = 8;
// Maximum displacement that takes a region (InsideRegion) out of a body, relative to the region's size. A region that
// needs more is locked (it has no way out), unless it is shallow (kShallowDepth).
constexpr double kMaxDisplacementRatio = 1.5;
// Maximum number of passes over all bodies. One pass is not enough, because a region that leaves one body may enter
// another.
constexpr int kMaxPasses = 3;
// A region is shallow if its displacement is less than this multiple of the height to which cloth is moved
// (UntangleInput::min_height). Shallow regions always move; only strain after the move can lock them.
constexpr double kShallowDepth = 4;
// Maximum strain of a thread after the move. If a thread is strained more, the body probably goes through the cloth,
// and the region is locked. Measured strains: 0.44 for a tube 4 cm too small (the largest of all valid starts); 4.9 for
// trousers with a leg through the seat.
constexpr double kMaxStrain = 1.5;
// Maximum fraction of a region's threads that may still go through the body after the move. It is not 0, because
// relax() takes threads at the region's border out of the body.
constexpr double kMaxBlockedFraction = 0.2;
// Maximum displacement per round by shorten_contours(), relative to the mean of the maximum lengths
// of threads.
constexpr double kStep = 0.12;
constexpr int kMaxGapRounds = 60;

class Untangling {
 public:
  Untangling(const UntangleInput& input, bool self, std::span<Vec3> x)
      : input_(input), x_(x), start_(x.begin(), x.end()), finder_(input, x, self) {
    for (std::size_t b = 0; b < input.bodies.size(); ++b) {
      if (input.kinds[b] == SurfaceKind::solid || input.kinds[b] == SurfaceKind::floor)
        solids_.emplace_back(finder_.surfaces(), b, input.kinds[b], x);
    }
    const std::vector<ForbiddenRegion> bodies = solids_;
    for (std::size_t b = 0; b < input.bodies.size(); ++b)
      if (input.kinds[b] == SurfaceKind::layer) solids_.emplace_back(finder_.surfaces(), b, x, input.on_border, bodies);
    double sum = 0;
    std::size_t count = 0;
    for (const UntangleInput::Link& link : input.links) {
      if (link.is_bend) continue;
      sum += link.max_length;
      ++count;
    }
    step_ = kStep * sum / static_cast<double>(std::max<std::size_t>(count, 1));
  }

  Report run() {
    finder_.find(x_);
    report_.pairs_before = finder_.pairs();
    separate_touching();
    if (move_out_of_solids()) {
      reduce_crossings();
      if (report_.pairs_after == 0) restore_gaps();
    }
    measure();
    return report_;
  }

 private:
  // Moves the regions of cloth that are inside solids out of them. If a region is locked, restores
  // the start and returns false.
  bool move_out_of_solids() {
    for (int pass = 0; pass < kMaxPasses && report_.locked_regions.empty(); ++pass) {
      std::vector<InsideRegion> regions;
      for (const ForbiddenRegion& solid : solids_) {
        for (InsideRegion& region : find_inside(input_, solid, x_)) {
          const bool shallow = region.farthest < kShallowDepth * input_.min_height[region.cloth];
          const bool free = !region.moves.empty() && region.farthest <= kMaxDisplacementRatio * region.size &&
                            region.blocked <= kMaxBlockedFraction;
          (shallow || free ? regions : report_.locked_regions).push_back(std::move(region));
        }
      }
      if (regions.empty() || !report_.locked_regions.empty()) break;
      for (const InsideRegion& region : regions) apply(region.moves);
      relax(input_, solids_, kSweepsAfterMove, x_);
      for (InsideRegion& region : regions)
        if (is_overstretched(region)) report_.locked_regions.push_back(std::move(region));
    }
    if (report_.locked_regions.empty()) return true;
    std::ranges::copy(start_, x_.begin());
    report_.pairs_after = report_.pairs_before;
    return false;
  }

  bool is_overstretched(const InsideRegion& region) const {
    std::vector<std::uint8_t> in(static_cast<std::size_t>(input_.particles()), 0);
    for (const Move& move : region.moves) in[move.particle] = 1;
    return std::ranges::any_of(input_.links, [&](const UntangleInput::Link& link) {
      return !link.is_bend && (in[link.i] || in[link.j]) &&
             (x_[link.i] - x_[link.j]).norm() > (1 + kMaxStrain) * link.max_length;
    });
  }

  bool apply(std::span<const Move> moves) {
    bool any = false;
    for (const Move& move : moves) {
      if (!input_.movable[move.particle]) continue;
      x_[move.particle] = move.target;
      any = true;
    }
    return any;
  }

  // Separates surfaces that coincide (are at most kRoundoff [m] apart), so that each is on a definite side of the
  // other. Of two triangles a and b of different bodies, let b be that of the later body. Moves b to the front of a
  // (the side to which the normal of a points). If b has held particles, also moves a against its own normal. If the
  // body of b cannot move at all, moves only a: to the front of b or, if b is a piece of rope and has no front, against
  // its own normal.
  void separate_touching() {
    std::vector<Vec3> normals(static_cast<std::size_t>(input_.particles()), Vec3::Zero());
    const auto normal = [&](const collision::Triangle& of) { return collision::face_normal(of, x_); };
    const auto move = [&](const collision::Triangle& corners, const Vec3& along) {
      for (const Index v : corners) normals[v] += along;
    };
    for (const collision::TrianglePair& pair : finder_.find_near_pairs(x_, kRoundoff)) {
      const collision::CornerPair corners{input_.bodies.triangles()[pair.a], input_.bodies.triangles()[pair.b]};
      if (input_.bodies.body_of(corners.a[0]) == input_.bodies.body_of(corners.b[0])) continue;
      if (collision::closest_features(corners, x_).points.distance_sq > kRoundoff * kRoundoff) continue;
      if (input_.can_move[input_.bodies.body_of(corners.b[0])] == 0) {
        const Vec3 front = normal(corners.b);
        move(corners.a, front.isZero() ? Vec3(-normal(corners.a)) : front);
        continue;
      }
      move(corners.b, normal(corners.a));
      if (std::ranges::any_of(corners.b, [&](Index v) { return input_.movable[v] == 0; }))
        move(corners.a, -normal(corners.a));
    }
    for (Index i = 0; i < input_.particles(); ++i)
      if (input_.movable[i])
        x_[i] +=
            1.1 * kGapInThicknesses * input_.bodies[input_.bodies.body_of(i)].thickness * normals[i].stableNormalized();
  }

  // Moves islands, shortens lines of crossing and smooths, until nothing crosses or kMaxSmoothings or kMaxRounds is
  // reached. Then restores the best state.
  void reduce_crossings() {
    find();
    best_x_.assign(x_.begin(), x_.end());
    fewest_pairs_ = finder_.pairs();
    for (int waited = 0, smoothings = 0; report_.rounds < kMaxRounds && fewest_pairs_ > 0; ++report_.rounds) {
      if (waited == 0 && move_islands()) continue;
      push_out_of_solids(input_, crossings_, solids_, x_);
      shorten_contours(input_, crossings_, step_, x_);
      relax(input_, solids_, kSweeps, x_);
      find();
      waited = keep_if_better() ? 0 : waited + 1;
      if (waited < kPatience) continue;
      if (++smoothings > kMaxSmoothings) break;
      smooth_around(smoothings);
      waited = 0;
    }
    std::ranges::copy(best_x_, x_.begin());
    report_.pairs_after = fewest_pairs_;
  }

  // Tries to move cut-off islands: first all at once; then, for each CrossedPair, all islands of the pair at once, then
  // up to kMaxSingleIslands of them one by one. Keeps the first try after which fewer pairs of triangles cross than
  // ever before, and returns true. If there is none, changes nothing and returns false.
  bool move_islands() {
    const std::vector<Vec3> before(x_.begin(), x_.end());
    const auto try_moves = [&](std::span<const std::vector<Move>> islands) {
      bool any = false;
      for (const std::vector<Move>& moves : islands) any = apply(moves) || any;
      if (!any) return false;
      relax(input_, solids_, kSweepsAfterMove, x_);
      find();
      if (keep_if_better()) return true;
      std::ranges::copy(before, x_.begin());
      find();
      return false;
    };
    const auto islands_of = [&](const std::optional<CrossedPair>& only) {
      return move_cut_off_islands(input_, crossings_, finder_.surfaces(), only, x_);
    };
    if (try_moves(islands_of(std::nullopt))) return true;
    for (const CrossedPair& only : list_crossed_pairs(input_, crossings_)) {
      const auto islands = islands_of(only);
      if (try_moves(islands)) return true;
      for (std::size_t p = 0; islands.size() > 1 && p < std::min(islands.size(), kMaxSingleIslands); ++p)
        if (try_moves(std::span(islands).subspan(p, 1))) return true;
    }
    return false;
  }

  // Smooths cloth around its crossings, over an area that grows with `smoothings`. Ignores crossings with solids,
  // because smoothing would move cloth back into the solids.
  void smooth_around(int smoothings) {
    std::vector<Index> around;
    for (const Crossing& c : crossings_) {
      if (involves_solid(input_, c)) continue;
      const auto& edge = input_.edges.edges[c.edge].vertices;
      const auto& t = input_.bodies.triangles()[c.triangle];
      around.insert(around.end(), {edge[0], edge[1], t[0], t[1], t[2]});
    }
    smooth(input_, around, 1 + smoothings, 4 * smoothings, x_);
    relax(input_, solids_, kSweepsAfterMove, x_);
    find();
    keep_if_better();
  }

  void find() {
    const std::span<const Crossing> found = finder_.find(x_);
    crossings_.assign(found.begin(), found.end());
  }
  // If fewer pairs cross than ever before, stores the present state as the best one, and returns true.
  bool keep_if_better() {
    if (finder_.pairs() >= fewest_pairs_) return false;
    fewest_pairs_ = finder_.pairs();
    best_x_.assign(x_.begin(), x_.end());
    return true;
  }

  // Call if nothing crosses, but gaps may be too small: pushes close pairs apart until all gaps are
  // large enough, in at most kMaxGapRounds rounds. If this makes triangles cross, restores the last
  // state without crossings.
  void restore_gaps() {
    std::vector<Vec3> good(x_.begin(), x_.end());
    double max_gap = 0;
    for (std::size_t b = 0; b < input_.bodies.size(); ++b)
      max_gap = std::max(max_gap, kGapInThicknesses * input_.bodies[b].thickness);
    for (int round = 0; round < kMaxGapRounds; ++round) {
      int close = 0;
      for (const collision::TrianglePair& pair : finder_.find_near_pairs(x_, max_gap)) {
        const collision::CornerPair corners{input_.bodies.triangles()[pair.a], input_.bodies.triangles()[pair.b]};
        close += push(corners);
      }
      if (close == 0) break;
      finder_.find(x_);
      if (finder_.pairs() > 0) break;
      std::ranges::copy(x_, good.begin());
    }
    std::ranges::copy(good, x_.begin());
  }

  // If the gap between two triangles is too small, pushes them apart to 1.1 times the minimum gap.
  // Returns whether any particle has moved.
  bool push(const collision::CornerPair& pair) {
    const double wanted = kGapInThicknesses * std::max(input_.bodies[input_.bodies.body_of(pair.a[0])].thickness,
                                                       input_.bodies[input_.bodies.body_of(pair.b[0])].thickness);
    const collision::ClosestFeatures closest = collision::closest_features(pair, x_);
    const double distance = std::sqrt(closest.points.distance_sq);
    if (distance >= wanted) return false;
    const Vec3 n = distance > 0 ? Vec3(closest.points.difference / distance) : collision::face_normal(pair.b, x_);
    double sum_sq = 0;
    for (std::size_t k = 0; k < 4; ++k)
      if (input_.movable[closest.vertices[k]]) sum_sq += closest.points.weights[k] * closest.points.weights[k];
    if (sum_sq == 0) return false;
    for (std::size_t k = 0; k < 4; ++k)
      if (input_.movable[closest.vertices[k]])
        x_[closest.vertices[k]] += (1.1 * wanted - distance) * closest.points.weights[k] / sum_sq * n;
    return true;
  }

  void measure() {
    for (Index i = 0; i < input_.particles(); ++i)
      report_.farthest = std::max(report_.farthest, (x_[i] - start_[i]).norm());
    for (const UntangleInput::Link& link : input_.links)
      if (!link.is_bend)
        report_.stretch = std::max(report_.stretch, (x_[link.i] - x_[link.j]).norm() / link.max_length - 1);
  }

  const UntangleInput& input_;
  std::span<Vec3> x_;
  std::vector<Vec3> start_;
  CrossingFinder finder_;
  std::vector<ForbiddenRegion> solids_;
  double step_ = 0;  // maximum displacement by shorten_contours() [m]
  std::vector<Crossing> crossings_;
  std::vector<Vec3> best_x_;  // state with the fewest crossing pairs
  int fewest_pairs_ = 0;      // number of these pairs
  Report report_;
};

}  // namespace

Report untangle(const UntangleInput& input, bool self, std::span<Vec3> x) {
  return Untangling(input, self, x).run();
}

}  // namespace weft::untangle
