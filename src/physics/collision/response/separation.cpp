#include "physics/collision/response/separation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/numerics.hpp"
#include "core/parallel.hpp"
#include "core/stop.hpp"
#include "physics/mesh/rigid_frame.hpp"

namespace weft::collision {

Separation::Separation(std::span<const Triangle> triangles, std::span<const Surface> deformable,
                       std::span<const double> masses)
    : triangles_(triangles),
      masses_(masses),
      planes_(triangles_, static_cast<Index>(masses.size())),
      stars_(deformable) {}

void Separation::set_rigid(std::vector<RigidGroup> groups, Index vertices) {
  groups_ = std::move(groups);
  if (groups_.empty()) return;
  group_of_.assign(static_cast<std::size_t>(vertices), -1);
  for (std::size_t g = 0; g < groups_.size(); ++g)
    for_each_member(groups_[g], [&](Index v) { group_of_[v] = static_cast<int>(g); });
}

template <class Visit>
void Separation::for_each_member(const RigidGroup& group, const Visit& visit) {
  constexpr Index kFrame = mesh::RigidFrame::kParticles;
  for (Index v = group.frame; v < group.frame + kFrame; ++v) visit(v);
  for (Index v = group.first; v < group.first + group.count; ++v) visit(v);
}

void Separation::watch(std::span<const TrianglePair> pairs, std::span<const Vec3> x) {
  planes_.watch(pairs, x);
  set_reference(x);
}

void Separation::watch(std::span<const Vec3> x) {
  planes_.watch(x);
  set_reference(x);
}

// Keeps the measures of the stars if x is unchanged, as is usual if pairs are collected again for another end of the
// step.
void Separation::set_reference(std::span<const Vec3> x) {
  if (std::ranges::equal(reference_, x)) return stars_.forget_tests();
  reference_.assign(x.begin(), x.end());
  stars_.set_reference(x);
}

void Separation::measure_motion(std::span<const Vec3> x) {
  moved_.resize(x.size());
  parallel_for(x.size(), kGrainSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v)
      moved_[v] = (1 + 1e-6F) * std::sqrt(static_cast<float>((x[v] - reference_[v]).squaredNorm()));
  });
  planes_.set_moved(moved_);
}

std::vector<std::uint8_t> Separation::find_clear_triangles(double distance, std::span<const Vec3> x) const {
  std::vector<std::uint8_t> vertices(reference_.size(), 0), triangles(triangles_.size(), 0);
  stars_.mark_clear(distance, std::ranges::equal(reference_, x) ? std::span<const Vec3>() : x, vertices);
  for (std::size_t t = 0; t < triangles.size(); ++t)
    triangles[t] = vertices[triangles_[t][0]] & vertices[triangles_[t][1]] & vertices[triangles_[t][2]];
  return triangles;
}

std::span<const CornerPair> Separation::find_failing(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1,
                                                     const PinchedPairs* pinched, const CarriedStarts* carried,
                                                     PlaneKinds which) {
  failing_.clear();
  moved_.resize(x_t0.size());
  changed_.resize(x_t0.size());
  if (tested_t0_.size() != x_t0.size()) {
    tested_t0_.assign(x_t0.size(), Vec3::Constant(std::numeric_limits<double>::quiet_NaN()));
    tested_t1_ = tested_t0_;
  }
  end_if_stopped();
  parallel_for(x_t0.size(), kGrainSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const double max_moved_sq =
          std::max((x_t0[v] - reference_[v]).squaredNorm(), (x_t1[v] - reference_[v]).squaredNorm());
      moved_[v] = (1 + 1e-6F) * std::sqrt(static_cast<float>(max_moved_sq));
      changed_[v] = tested_t0_[v] != x_t0[v] || tested_t1_[v] != x_t1[v];
      tested_t0_[v] = x_t0[v];
      tested_t1_[v] = x_t1[v];
    }
  });
  planes_.find_failing(reference_, x_t0, x_t1, moved_, changed_, failing_, carried, which);
  stars_.find_failing(x_t0, x_t1, moved_, changed_, failing_, which);
  if (pinched != nullptr && !pinched->empty())
    std::erase_if(failing_, [&](const CornerPair& pair) { return pinched->exempts(pair); });
  // The order in which pairs are pushed apart affects the result. Without sorting, this order would
  // depend on the trees, and so on the world axes.
  std::ranges::sort(failing_);
  return failing_;
}

// Returns c of the plane n·x = c for pushing a pair apart to the gap `target` [m]. Corners of side
// a that are not fixed and lie below c + target / 2 are moved up to there; those of side b above c
// − target / 2, down to there. With this c, these pushes keep the common centre of mass of the
// moved corners in place.
double Separation::balanced_plane(const CornerPair& pair, const Vec3& n, double target, const Step& step) const {
  struct Corner {
    double limit, mass;  // [m], [kg]; a corner of a is pushed if c > limit, a corner of b if c < limit
    bool is_of_a;
  };
  std::array<Corner, 6> all;
  std::size_t count = 0;
  for (const bool is_of_a : {true, false}) {
    const Triangle& side = is_of_a ? pair.a : pair.b;
    for (const Index v : std::span(side).first(side[1] == side[2] ? 2 : 3))  // an edge repeats its second end
      if (!is_fixed(v, step))
        all[count++] = {n.dot(step.x_t1[v]) + (is_of_a ? -0.5 : 0.5) * target, masses_.empty() ? 1 : masses_[v],
                        is_of_a};
  }
  const std::span<Corner> corners(all.data(), count);
  std::ranges::sort(corners, {}, &Corner::limit);
  const auto momentum_gain = [&](double c) {  // sum of mass times push along n [kg m]
    double sum = 0;
    for (const Corner& corner : corners)
      if ((c > corner.limit) == corner.is_of_a) sum += corner.mass * (c - corner.limit);
    return sum;
  };
  double below = corners.empty() ? 0 : corners.front().limit, of_below = momentum_gain(below);
  for (const Corner& corner : corners) {
    const double gain = momentum_gain(corner.limit);
    if (gain >= 0) return gain > of_below ? below + (corner.limit - below) * of_below / (of_below - gain) : below;
    below = corner.limit, of_below = gain;
  }
  return below;
}

// Returns the direction along which to push a pair apart. Candidates are `closest`, the direction between the closest
// points at the start, and the normals of faces that do not move, if they separate the pair at the start. Returns the
// candidate along which the ends overlap least. Reason: if cloth slides towards a facet ahead of it, a push along
// `closest` would move the cloth back by as much as it has slid. Normals of moving faces are no candidates, because
// they more than double the strain of cloth that a cylinder strikes at 38 m/s.
Vec3 Separation::push_direction(const CornerPair& pair, const Vec3& closest, const Step& step) const {
  const std::span<const Vec3> start = step.start_of(pair), end = step.x_t1;
  Vec3 best = closest;
  for (const Triangle& face : {pair.a, pair.b}) {
    const Vec3 across = (end[face[1]] - end[face[0]]).cross(end[face[2]] - end[face[0]]);
    const bool stands = std::ranges::all_of(face, [&](Index v) { return is_fixed(v, step) && start[v] == end[v]; });
    if (!stands || across.squaredNorm() == 0) continue;
    for (const double sign : {-1.0, 1.0}) {
      const Vec3 n = sign * across.normalized();
      if (gap_along(n, pair, start) > 0 && gap_along(n, pair, end) > gap_along(best, pair, end)) best = n;
    }
  }
  return best;
}

// Moves the ends of a pair apart. If fixed vertices or those of rigid bodies leave no space for the
// gap, translates the rigid bodies instead. Returns false if the pair touches at the start, or if
// neither is possible.
bool Separation::push_apart(const CornerPair& pair, Step& step) const {
  const Vec3 direction = closest_features(pair, step.start_of(pair)).points.difference;
  const double start_gap = direction.norm();
  if (start_gap == 0) return false;
  const double target =
      std::max(2 * numerics.separation.least_gap, std::min(numerics.separation.restored_gap, 0.5 * start_gap));
  const Vec3 n = push_direction(pair, direction / start_gap, step);

  // `plane`: c of the plane n·x = c that separates the ends. The push conserves momentum, unless fixed vertices limit
  // c.
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  double low = -kInfinity, high = kInfinity;  // bounds of c
  for (int k = 0; k < 3; ++k) {
    const double a = n.dot(step.x_t1[pair.a[k]]), b = n.dot(step.x_t1[pair.b[k]]);
    if (is_fixed(pair.a[k], step)) high = std::min(high, a - 0.5 * target);
    if (is_fixed(pair.b[k], step)) low = std::max(low, b + 0.5 * target);
  }
  if (low > high) return translate_groups(pair, n, target, step);
  const double plane = std::clamp(balanced_plane(pair, n, target, step), low, high);

  const auto push = [&](const Triangle& corners, double sign) {
    for (Index v : corners) {
      const double missing = sign * plane + 0.5 * target - sign * n.dot(step.x_t1[v]);
      if (missing <= 0 || is_fixed(v, step)) continue;
      step.x_t1[v] += sign * missing * n;
    }
  };
  push(pair.a, 1);
  push(pair.b, -1);
  return true;
}

// Moves the rigid bodies of a pair apart along n, to the gap `target` [m]. Returns false if neither
// can move, or if the gap is already that large.
bool Separation::translate_groups(const CornerPair& pair, const Vec3& n, double target, Step& step) const {
  const auto free_group = [&](Index v) { return step.movable[v] == kFree ? group_of(v) : nullptr; };
  const RigidGroup *a = free_group(pair.a[0]), *b = free_group(pair.b[0]);
  const double inverse_mass_a = a != nullptr ? 1 / a->mass : 0, inverse_mass_b = b != nullptr ? 1 / b->mass : 0;
  if (inverse_mass_a + inverse_mass_b == 0) return false;
  double min_a = std::numeric_limits<double>::infinity(), max_b = -min_a;
  for (std::size_t k = 0; k < 3; ++k) {
    min_a = std::min(min_a, n.dot(step.x_t1[pair.a[k]]));
    max_b = std::max(max_b, n.dot(step.x_t1[pair.b[k]]));
  }
  const double missing = target - (min_a - max_b);
  if (missing <= 0) return false;
  const auto translate = [&](const RigidGroup* group, double by) {
    if (group != nullptr) for_each_member(*group, [&](Index v) { step.x_t1[v] += by * n; });
  };
  translate(a, missing * inverse_mass_a / (inverse_mass_a + inverse_mass_b));
  translate(b, -missing * inverse_mass_b / (inverse_mass_a + inverse_mass_b));
  return true;
}

// Releases the pinned particles of a pair. Returns false if there are none.
bool Separation::release_pins(const CornerPair& pair, Step& step) {
  bool changed = false;
  for (const Triangle& corners : {pair.a, pair.b}) {
    for (Index v : corners) {
      if (step.movable[v] != kPinned) continue;
      step.movable[v] = kFree;
      step.report.obstructed_pins.push_back({v, pair});
      changed = true;
    }
  }
  return changed;
}

// Position to which a vertex is backtracked: its start, or its start carried by an obstacle.
const Vec3& Separation::backtrack_target(Index v, const Step& step) const {
  return carriers_[v] >= 0 ? step.carried->by(static_cast<std::size_t>(carriers_[v]))[v] : step.x_t0[v];
}

// Chooses the backtrack targets of the free vertices of a failing pair: their start, or their start
// carried by an obstacle. If the pair has an obstacle that moves rigidly, this obstacle carries
// them. If another obstacle already carries a vertex, the vertex gets kAlwaysAtStart. In a pair
// without an obstacle, an obstacle that carries one vertex carries all free ones. But if two
// obstacles carry vertices of the pair, or if one vertex is carried and another one cannot be, all
// free vertices get kAlwaysAtStart. Returns true if a target has changed; each vertex changes its
// target at most twice.
bool Separation::choose_backtrack_targets(const CornerPair& pair, const Step& step) {
  if (step.carried == nullptr) return false;
  bool changed = false;
  const auto choose = [&](Index v, int carrier) {
    if (step.movable[v] != kFree || carriers_[v] == carrier) return;
    carriers_[v] = carrier;
    if (const RigidGroup* group = group_of(v))
      for_each_member(*group, [&](Index member) { carriers_[member] = carrier; });
    changed = true;
  };
  if (step.carried->has_obstacle(pair)) {
    const std::size_t obstacle = step.carried->obstacle_of(pair);
    const int carrier = step.carried->carries(obstacle) ? static_cast<int>(obstacle) : kAtStart;
    for (Index v : pair.a)
      if (carriers_[v] != kAlwaysAtStart)
        choose(v, carriers_[v] == kAtStart ? carrier : carriers_[v] == carrier ? carrier : kAlwaysAtStart);
    return changed;
  }
  int carrier = kAtStart;
  bool differ = false;
  for (const Triangle& corners : {pair.a, pair.b}) {
    for (Index v : corners) {
      if (step.movable[v] == kFree && carriers_[v] == kAtStart) continue;
      const int of_vertex = step.movable[v] == kFree ? carriers_[v] : kAlwaysAtStart;
      differ |= carrier != kAtStart && carrier != of_vertex;
      carrier = of_vertex;
    }
  }
  if (carrier == kAtStart || (carrier == kAlwaysAtStart && !differ)) return false;
  for (const Triangle& corners : {pair.a, pair.b})
    for (Index v : corners) choose(v, differ ? kAlwaysAtStart : carrier);
  return changed;
}

bool Separation::has_carried_vertex(const CornerPair& pair) const {
  const auto is_carried = [&](Index v) { return carriers_[v] >= 0; };
  return std::ranges::any_of(pair.a, is_carried) || std::ranges::any_of(pair.b, is_carried);
}

// Backtracks the vertices of a pair, entirely or half of the way, each at most once per round. If
// an obstacle carries a vertex, backtracks entirely, because the pair may still meet halfway.
// Returns false if every free vertex is at its target and no target has changed.
bool Separation::backtrack(const CornerPair& pair, bool all_the_way, Step& step) {
  bool changed = choose_backtrack_targets(pair, step);
  const double fraction = all_the_way || has_carried_vertex(pair) ? 1 : 0.5;
  for (const Triangle& corners : {pair.a, pair.b}) {
    for (Index v : corners) {
      const Vec3& to = backtrack_target(v, step);
      if (step.movable[v] != kFree || step.x_t1[v] == to) continue;
      changed = true;
      if (backtracked_in_[v] == round_) continue;
      const auto take_back = [&](Index member) {
        const Vec3& there = backtrack_target(member, step);
        step.x_t1[member] = fraction == 1 ? there : Vec3(step.x_t1[member] + fraction * (there - step.x_t1[member]));
        backtracked_in_[member] = round_;
      };
      if (const RigidGroup* group = group_of(v))
        for_each_member(*group, take_back);
      else
        take_back(v);
    }
  }
  return changed;
}

bool Separation::backtrack_all(Step& step) const {
  bool moved = false;
  for (std::size_t v = 0; v < step.x_t0.size(); ++v) {
    const Vec3& to = backtrack_target(static_cast<Index>(v), step);
    if (step.movable[v] != kFree || step.x_t1[v] == to) continue;
    step.x_t1[v] = to;
    moved = true;
  }
  return moved;
}

// Whether all vertices of a pair are at their start, or all at the start carried by one obstacle (if the pair has an
// obstacle: by this one). Such a pair does not meet, however close it is, because it does not meet at the start.
bool Separation::is_backtracked(const CornerPair& pair, const Step& step) const {
  const auto ends_at = [&](std::span<const Vec3> x) {
    const auto is_there = [&](Index v) { return step.x_t1[v] == x[v]; };
    return std::ranges::all_of(pair.a, is_there) && std::ranges::all_of(pair.b, is_there);
  };
  if (ends_at(step.x_t0)) return true;
  const int carrier = carriers_[pair.a[0]];
  if (carrier < 0) return false;
  // Carried vertices move with their obstacle but not with other obstacles, so they may meet these.
  const auto obstacle = static_cast<std::size_t>(carrier);
  return (!step.carried->has_obstacle(pair) || step.carried->obstacle_of(pair) == obstacle) &&
         ends_at(step.carried->by(obstacle));
}

void Separation::test_again(const Step& step) {
  find_failing(step.x_t0, step.x_t1, step.pinched, step.carried, step.which);
  std::erase_if(failing_, [&](const CornerPair& pair) { return is_backtracked(pair, step); });
}

SeparationReport Separation::enforce(std::span<const Vec3> x_t0, std::span<Vec3> x_t1,
                                     std::span<const std::uint8_t> movable, PinchedPairs* pinched,
                                     const CarriedStarts* carried, bool is_continued, PlaneKinds which) {
  Step step{x_t0, x_t1, {movable.begin(), movable.end()}, pinched, carried, which};
  backtracked_in_.assign(x_t0.size(), 0);
  if (!is_continued) carriers_.assign(x_t0.size(), kAtStart);
  test_again(step);
  // With r = `rounds`: rounds 1 to r push pairs apart. Later rounds backtrack failing pairs, up to
  // round 1.5 r by halves, then entirely. From round 2.5 r on, all free vertices are backtracked
  // entirely.
  const int rounds = numerics.separation.max_rounds, by_halves = rounds + rounds / 2;
  for (round_ = 1; !failing_.empty(); ++round_) {
    bool changed = round_ >= by_halves + rounds && backtrack_all(step);
    const bool is_final = round_ > by_halves;
    for (const CornerPair& pair : failing_) {
      if (round_ <= rounds && !has_carried_vertex(pair)) {
        if (find_separating_plane(pair, step.start_of(pair), x_t1, planes_.kinds_of(pair, which)))
          continue;  // an earlier push of this round was enough
        if (push_apart(pair, step) && (changed = true)) continue;
        if (release_pins(pair, step) && (changed = true) && push_apart(pair, step)) continue;
      }
      if (backtrack(pair, is_final, step) || (is_final && !is_backtracked(pair, step) && release_pins(pair, step))) {
        changed = true;
      } else if (is_final && pinched != nullptr && pinched->is_cloth_and_obstacle(pair) &&
                 !is_backtracked(pair, step)) {
        pinched->add(pair);
        changed = true;
      }
    }
    // No vertex can move any more: the remaining pairs cannot be separated.
    if (!changed && is_final) {
      step.report.unseparated_pair = failing_.front();
      return step.report;
    }
    if (!changed) round_ = by_halves;
    test_again(step);
  }
  step.report.separated = true;
  return step.report;
}

}  // namespace weft::collision
