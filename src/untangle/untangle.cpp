#include "untangle/untangle.hpp"

#include <algorithm>
#include <cmath>

#include "collision/response/certificate.hpp"
#include "untangle/contours.hpp"
#include "untangle/crossings.hpp"
#include "untangle/relaxation.hpp"
#include "untangle/solid.hpp"

namespace weft::untangle {
namespace {

// Height of cloth over an obstacle and over cloth that it is moved to, in thicknesses.
constexpr double kAbove = 0.75;
// Of cloth with nothing in between, in thicknesses: far above what counts as touching.
constexpr double kApart = 0.1;
// Nearer than this cloth is on no side of the other [m].
constexpr double kTouch = 1e-9;
constexpr int kMostRounds = 400;
// Rounds without fewer crossings after which the cloth around those left is smoothed, each time farther around; and
// times that this is done.
constexpr int kPatience = 12, kMostSmoothings = 12;
// Parts that are tried one by one.
constexpr std::size_t kSingleParts = 12;
constexpr int kSweepsAfterMove = 120, kSweeps = 8;
// A region in a body that would have to move farther, in its own sizes, has the body go through it.
constexpr double kLongestWay = 1.5;
// Times that this is done: what leaves one body can get into another.
constexpr int kPasses = 3;
// Regions no deeper than this, in heights over the obstacle, are not asked.
constexpr double kShallow = 4;
// Threads that would be longer by more than this share of their length show that the body goes through: of starts that
// could be meant up to 0.44 (a tube 4 cm too small), of trousers with a leg through their seat 4.9.
constexpr double kMostStretch = 1.5;
// Share of its threads that the body may still block: those around its border find their way.
constexpr double kMostBlocked = 0.2;
// Step along the gradients of contours, in mean lengths of the threads.
constexpr double kStep = 0.12;
constexpr int kApartRounds = 60;

class Untangling {
 public:
  Untangling(const Fabric& fabric, const Options& options, std::span<Vec3> x)
      : fabric_(fabric), x_(x), start_(x.begin(), x.end()), finder_(fabric, x, options.self, options.obstacles) {
    for (std::size_t b = 0; b < fabric.bodies.size(); ++b) {
      above_.push_back(kAbove * fabric.thickness[b]);
      const bool solid = fabric.kinds[b] == Kind::solid || fabric.kinds[b] == Kind::floor;
      if (solid && options.obstacles) solids_.emplace_back(finder_.surfaces(), b, fabric.kinds[b], x);
    }
    const std::vector<Solid> bodies = solids_;
    for (std::size_t b = 0; b < fabric.bodies.size(); ++b)
      if (fabric.kinds[b] == Kind::layer) solids_.emplace_back(finder_.surfaces(), b, x, fabric.on_border, bodies);
    double sum = 0;
    std::size_t count = 0;
    for (const Fabric::Link& link : fabric.links) {
      if (link.bend) continue;
      sum += link.most;
      ++count;
    }
    step_ = kStep * sum / static_cast<double>(std::max<std::size_t>(count, 1));
  }

  Report run() {
    finder_.find(x_);
    report_.pairs_before = finder_.pairs();
    part_touching();
    if (leave_solids()) {
      cross_over();
      if (report_.pairs_after == 0) keep_apart();
    }
    measure();
    return report_;
  }

 private:
  // Cloth inside of bodies goes out, region by region; false where there is no way, and then nothing moves.
  bool leave_solids() {
    for (int pass = 0; pass < kPasses && report_.locked.empty(); ++pass) {
      std::vector<InsideRegion> regions;
      for (const Solid& solid : solids_) {
        for (InsideRegion& region : find_inside(fabric_, solid, above_, x_)) {
          const bool shallow = region.farthest < kShallow * above_[region.cloth];
          const bool free =
              !region.moves.empty() && region.farthest <= kLongestWay * region.size && region.blocked <= kMostBlocked;
          (shallow || free ? regions : report_.locked).push_back(std::move(region));
        }
      }
      if (regions.empty() || !report_.locked.empty()) break;
      for (const InsideRegion& region : regions) apply(region.moves);
      relax(fabric_, solids_, above_, kSweepsAfterMove, x_);
      for (InsideRegion& region : regions)
        if (is_overstretched(region)) report_.locked.push_back(std::move(region));
    }
    if (report_.locked.empty()) return true;
    std::ranges::copy(start_, x_.begin());
    report_.pairs_after = report_.pairs_before;
    return false;
  }

  bool is_overstretched(const InsideRegion& region) const {
    std::vector<std::uint8_t> in(static_cast<std::size_t>(fabric_.particles()), 0);
    for (const Move& move : region.moves) in[move.particle] = 1;
    return std::ranges::any_of(fabric_.links, [&](const Fabric::Link& link) {
      return !link.bend && (in[link.i] || in[link.j]) &&
             (x_[link.i] - x_[link.j]).norm() > (1 + kMostStretch) * link.most;
    });
  }

  bool apply(std::span<const Move> moves) {
    bool any = false;
    for (const Move& move : moves) {
      if (!fabric_.movable[move.particle]) continue;
      x_[move.particle] = move.target;
      any = true;
    }
    return any;
  }

  // What lies exactly in other cloth has no side yet: the cloth that comes later gets on the front of the other.
  void part_touching() {
    std::vector<Vec3> normals(static_cast<std::size_t>(fabric_.particles()), Vec3::Zero());
    for (const collision::TrianglePair& pair : finder_.near(x_, kTouch)) {
      const collision::CornerPair corners{fabric_.bodies.triangles()[pair.a], fabric_.bodies.triangles()[pair.b]};
      if (!fabric_.is_cloth(corners.b[0]) ||
          fabric_.bodies.body_of(corners.a[0]) == fabric_.bodies.body_of(corners.b[0]))
        continue;
      if (collision::closest_features(corners, x_).points.distance_sq > kTouch * kTouch) continue;
      const bool later = fabric_.movable[corners.b[0]];
      const collision::Triangle &still = later ? corners.a : corners.b, &moves = later ? corners.b : corners.a;
      for (const Index v : moves)
        normals[v] += (x_[still[1]] - x_[still[0]]).cross(x_[still[2]] - x_[still[0]]).stableNormalized();
    }
    for (Index i = 0; i < fabric_.particles(); ++i)
      if (fabric_.movable[i])
        x_[i] += 1.1 * kApart * fabric_.thickness[fabric_.bodies.body_of(i)] * normals[i].stableNormalized();
  }

  // Until nothing crosses, or nothing gets better.
  void cross_over() {
    find();
    best_.assign(x_.begin(), x_.end());
    least_ = finder_.pairs();
    for (int waited = 0, smoothings = 0; report_.rounds < kMostRounds && least_ > 0; ++report_.rounds) {
      if (waited == 0 && change_sides()) continue;
      push_off(fabric_, crossings_, solids_, above_, x_);
      shorten_contours(fabric_, crossings_, step_, x_);
      relax(fabric_, solids_, above_, kSweeps, x_);
      find();
      waited = is_better() ? 0 : waited + 1;
      if (waited < kPatience) continue;
      if (++smoothings > kMostSmoothings) break;
      smooth_around(smoothings);
      waited = 0;
    }
    return_to_best();
    report_.pairs_after = least_;
  }

  // Parts that are cut off: all of them; of one cloth and another all that longer lines cut off; each of these. Whether
  // fewer triangles cross then; else nothing has changed.
  bool change_sides() {
    const std::vector<Vec3> before(x_.begin(), x_.end());
    const auto helps = [&](std::span<const std::vector<Move>> parts) {
      bool any = false;
      for (const std::vector<Move>& moves : parts) any = apply(moves) || any;
      if (!any) return false;
      relax(fabric_, solids_, above_, kSweepsAfterMove, x_);
      find();
      if (is_better()) return true;
      std::ranges::copy(before, x_.begin());
      find();
      return false;
    };
    const auto parts_of = [&](const std::optional<Through>& only) {
      return move_cut_off_parts(fabric_, crossings_, finder_.surfaces(), above_, only, x_);
    };
    if (helps(parts_of(std::nullopt))) return true;
    for (const Through& only : list_through(fabric_, crossings_)) {
      const auto parts = parts_of(only);
      if (helps(parts)) return true;
      for (std::size_t p = 0; parts.size() > 1 && p < std::min(parts.size(), kSingleParts); ++p)
        if (helps(std::span(parts).subspan(p, 1))) return true;
    }
    return false;
  }

  // Cloth around cloth that it crosses, the farther the more often. Over a body it would go back into that.
  void smooth_around(int smoothings) {
    std::vector<Index> around;
    for (const Crossing& c : crossings_) {
      if (with_solid(fabric_, c)) continue;
      const auto& edge = fabric_.edges.edges[c.edge].vertices;
      const auto& t = fabric_.bodies.triangles()[c.triangle];
      around.insert(around.end(), {edge[0], edge[1], t[0], t[1], t[2]});
    }
    smooth(fabric_, around, 1 + smoothings, 4 * smoothings, x_);
    relax(fabric_, solids_, above_, kSweepsAfterMove, x_);
    find();
    is_better();
  }

  void find() {
    const std::span<const Crossing> found = finder_.find(x_);
    crossings_.assign(found.begin(), found.end());
  }
  // Whether fewer cross than ever; then this is kept.
  bool is_better() {
    if (finder_.pairs() >= least_) return false;
    least_ = finder_.pairs();
    best_.assign(x_.begin(), x_.end());
    return true;
  }
  void return_to_best() { std::ranges::copy(best_, x_.begin()); }

  // Nothing crosses, but some may touch: what is closer than that is pushed apart, as long as nothing crosses.
  void keep_apart() {
    std::vector<Vec3> good(x_.begin(), x_.end());
    double most = 0;
    for (const double thickness : fabric_.thickness) most = std::max(most, kApart * thickness);
    for (int round = 0; round < kApartRounds; ++round) {
      int close = 0;
      for (const collision::TrianglePair& pair : finder_.near(x_, most)) {
        const collision::CornerPair corners{fabric_.bodies.triangles()[pair.a], fabric_.bodies.triangles()[pair.b]};
        close += push(corners);
      }
      if (close == 0) break;
      finder_.find(x_);
      if (finder_.pairs() > 0) break;
      std::ranges::copy(x_, good.begin());
    }
    std::ranges::copy(good, x_.begin());
  }

  bool push(const collision::CornerPair& pair) {
    const double wanted = kApart * std::max(fabric_.thickness[fabric_.bodies.body_of(pair.a[0])],
                                            fabric_.thickness[fabric_.bodies.body_of(pair.b[0])]);
    const collision::ClosestFeatures closest = collision::closest_features(pair, x_);
    const double distance = std::sqrt(closest.points.distance_sq);
    if (distance >= wanted) return false;
    const Vec3 n = distance > 0
                       ? Vec3(closest.points.difference / distance)
                       : (x_[pair.b[1]] - x_[pair.b[0]]).cross(x_[pair.b[2]] - x_[pair.b[0]]).stableNormalized();
    double sum_sq = 0;
    for (std::size_t k = 0; k < 4; ++k)
      if (fabric_.movable[closest.vertices[k]]) sum_sq += closest.points.weights[k] * closest.points.weights[k];
    if (sum_sq == 0) return false;
    for (std::size_t k = 0; k < 4; ++k)
      if (fabric_.movable[closest.vertices[k]])
        x_[closest.vertices[k]] += (1.1 * wanted - distance) * closest.points.weights[k] / sum_sq * n;
    return true;
  }

  void measure() {
    for (Index i = 0; i < fabric_.particles(); ++i)
      report_.farthest = std::max(report_.farthest, (x_[i] - start_[i]).norm());
    for (const Fabric::Link& link : fabric_.links)
      if (!link.bend) report_.stretch = std::max(report_.stretch, (x_[link.i] - x_[link.j]).norm() / link.most - 1);
  }

  const Fabric& fabric_;
  std::span<Vec3> x_;
  std::vector<Vec3> start_;
  CrossingFinder finder_;
  std::vector<Solid> solids_;
  std::vector<double> above_;  // per body [m]
  double step_ = 0;            // [m]
  std::vector<Crossing> crossings_;
  std::vector<Vec3> best_;  // where the fewest triangles crossed
  int least_ = 0;           // how many pairs
  Report report_;
};

}  // namespace

Report untangle(const Fabric& fabric, const Options& options, std::span<Vec3> x) {
  return Untangling(fabric, options, x).run();
}

}  // namespace weft::untangle
