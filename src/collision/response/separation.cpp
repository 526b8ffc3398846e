#include "collision/response/separation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace weft::collision {
namespace {

// Gap that a push restores [m], or half of the gap at the start where that is less: a tenth of a fabric's thickness, so
// that the contact springs of the next step have something to act on.
constexpr double kKeep = 2e-4;
// Rounds of pushing before particles are backtracked by halves, before they are backtracked entirely, and before all
// are.
constexpr int kPushRounds = 24;
constexpr int kHalfRounds = 36;
constexpr int kRounds = 60;

std::size_t index(Index vertex) {
  return static_cast<std::size_t>(vertex);
}

}  // namespace

Separation::Separation(std::span<const Triangle> triangles, std::span<const Surface> deformable)
    : triangles_(triangles), planes_(triangles_), fans_(deformable) {}

void Separation::watch(std::span<const TrianglePair> pairs, std::span<const Vec3> x) {
  reference_.assign(x.begin(), x.end());
  planes_.watch(pairs, x);
  fans_.set_reference(x);
}

std::span<const CornerPair> Separation::find_failing(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1,
                                                     const PinchedPairs* pinched) {
  failing_.clear();
  moved_.resize(x_t0.size());
  for (std::size_t v = 0; v < x_t0.size(); ++v) {
    const double most_sq = std::max((x_t0[v] - reference_[v]).squaredNorm(), (x_t1[v] - reference_[v]).squaredNorm());
    moved_[v] = (1 + 1e-6F) * std::sqrt(static_cast<float>(most_sq));
  }
  planes_.find_failing(reference_, x_t0, x_t1, moved_, failing_);
  fans_.find_failing(x_t0, x_t1, moved_, failing_);
  if (pinched != nullptr && !pinched->empty())
    std::erase_if(failing_, [&](const CornerPair& pair) { return pinched->holds(pair); });
  return failing_;
}

// Moves the ends of a pair apart; false if what cannot move leaves no room.
bool Separation::push_apart(const CornerPair& pair, std::span<const Vec3> x_t0, std::span<Vec3> x_t1,
                            std::span<const std::uint8_t> movable, SeparationReport& report) {
  const Vec3 direction = closest_features(pair, x_t0).points.difference;
  const double start_gap = direction.norm();
  if (start_gap == 0) return false;
  const Vec3 n = direction / start_gap;
  const double target = std::max(2 * kFloor, std::min(kKeep, 0.5 * start_gap));

  // The separating plane n·x = c at the end: midway, unless what cannot move stands in the way.
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  double low = -kInfinity, high = kInfinity;  // of c
  double lowest_a = kInfinity, highest_b = -kInfinity;
  for (int k = 0; k < 3; ++k) {
    const double a = n.dot(x_t1[index(pair.a[k])]), b = n.dot(x_t1[index(pair.b[k])]);
    lowest_a = std::min(lowest_a, a);
    highest_b = std::max(highest_b, b);
    if (!movable[index(pair.a[k])]) high = std::min(high, a - 0.5 * target);
    if (!movable[index(pair.b[k])]) low = std::max(low, b + 0.5 * target);
  }
  if (low > high) return false;
  const double plane = std::clamp(0.5 * (lowest_a + highest_b), low, high);

  const auto push = [&](const Triangle& corners, double sign) {
    for (Index corner : corners) {
      const std::size_t v = index(corner);
      const double missing = sign * plane + 0.5 * target - sign * n.dot(x_t1[v]);
      if (missing <= 0 || !movable[v]) continue;
      x_t1[v] += sign * missing * n;
      report.largest_push = std::max(report.largest_push, missing);
    }
  };
  push(pair.a, 1);
  push(pair.b, -1);
  return true;
}

// Back by a share of the way to where there was no intersection, once a round; false if nothing was moved.
bool Separation::backtrack(const CornerPair& pair, double share, std::span<const Vec3> x_t0, std::span<Vec3> x_t1,
                           std::span<const std::uint8_t> movable, SeparationReport& report) {
  bool moved = false;
  for (const Triangle& corners : {pair.a, pair.b}) {
    for (Index corner : corners) {
      const std::size_t v = index(corner);
      if (!movable[v] || x_t1[v] == x_t0[v]) continue;
      moved = true;
      if (backtracked_in_[v] == round_) continue;
      report.largest_push = std::max(report.largest_push, share * (x_t0[v] - x_t1[v]).norm());
      x_t1[v] = share == 1 ? x_t0[v] : Vec3(x_t1[v] + share * (x_t0[v] - x_t1[v]));
      backtracked_in_[v] = round_;
    }
  }
  return moved;
}

bool Separation::backtrack_all(std::span<const Vec3> x_t0, std::span<Vec3> x_t1,
                               std::span<const std::uint8_t> movable) {
  bool moved = false;
  for (std::size_t v = 0; v < x_t0.size(); ++v) {
    if (!movable[v] || x_t1[v] == x_t0[v]) continue;
    x_t1[v] = x_t0[v];
    moved = true;
  }
  return moved;
}

// As find_failing, without pairs that stay where they are: these do not meet at the end because they do not at the
// start, however close they are.
void Separation::look_again(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1, const PinchedPairs* pinched) {
  find_failing(x_t0, x_t1, pinched);
  const auto stays = [&](Index v) { return x_t1[index(v)] == x_t0[index(v)]; };
  std::erase_if(failing_, [&](const CornerPair& pair) {
    return std::all_of(pair.a.begin(), pair.a.end(), stays) && std::all_of(pair.b.begin(), pair.b.end(), stays);
  });
}

SeparationReport Separation::enforce(std::span<const Vec3> x_t0, std::span<Vec3> x_t1,
                                     std::span<const std::uint8_t> movable, PinchedPairs* pinched) {
  SeparationReport report;
  backtracked_in_.assign(x_t0.size(), 0);
  look_again(x_t0, x_t1, pinched);
  report.corrected_pairs = static_cast<int>(failing_.size());
  for (round_ = 1; !failing_.empty(); ++round_) {
    bool changed = round_ >= kRounds && backtrack_all(x_t0, x_t1, movable);
    for (const CornerPair& pair : failing_) {
      if (round_ <= kPushRounds) {
        if (find_certificate(pair, x_t0, x_t1)) continue;  // an earlier push of this round was enough
        if (push_apart(pair, x_t0, x_t1, movable, report) && (changed = true)) continue;
      }
      const bool last = round_ > kHalfRounds;
      if (last && pinched != nullptr && pinched->may_hold(pair)) {
        pinched->add(pair);
        changed = true;
      } else if (backtrack(pair, last ? 1 : 0.5, x_t0, x_t1, movable, report)) {
        changed = true;
      }
    }
    // What cannot be moved any more is driven into each other.
    if (!changed && round_ > kHalfRounds) {
      report.stuck = failing_.front();
      return report;
    }
    look_again(x_t0, x_t1, pinched);
  }
  report.separated = true;
  return report;
}

}  // namespace weft::collision
