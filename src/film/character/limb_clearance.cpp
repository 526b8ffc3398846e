#include "film/character/limb_clearance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/parallel.hpp"
#include "film/character/dressing.hpp"
#include "physics/mesh/triangle_grid.hpp"

namespace weft::character {
namespace {

/// Two points of the skin belong to different limbs if the difference() of their limb weights exceeds this. Smaller
/// differences occur near a joint, where weights change gradually and skin may fold onto itself.
constexpr float kMinWeightDifference = 0.15F;

/// Lines from bone to skin per parallel task. A task takes some hundred microseconds.
constexpr std::size_t kLinesPerTask = 512;

/// Number of grid cells along the longest side of the body. The cells of a person are 3 cm wide.
constexpr double kCellsPerSide = 60;

/// Maximum number of rounds of move_skin(). If the surfaces of two limbs face each other, one round is enough.
/// Otherwise, each round halves the missing clearance.
constexpr int kMaxRounds = 8;

/// move_skin() ends if, in a round and without smoothing, no vertex moves by more than this fraction of the clearance.
constexpr double kMissingTolerance = 0.02;

/// Number of smoothing passes per round. Dents then extend over at least this number of edges.
constexpr int kSmoothingPasses = 3;

/// Clearance between body and ground, as a fraction of the clearance between limbs.
constexpr double kGroundClearanceRatio = 0.5;

/// Each of two limbs moves back by at most this fraction of the clearance that is missing between them.
constexpr double kMaxGivenFraction = 0.5;

/// Minimum remaining fraction of the distance from bone to skin. A thinner limb looks unnatural.
constexpr double kMinRemainingFraction = 0.5;

/// Skin without cloth nearby follows its neighbours by at most this distance [m]. A displacement of 5 mm is visible.
constexpr double kMaxMoveWithoutCloth = 0.004;

/// Skin near cloth moves by at most this distance [m] or twice the clearance, whichever is larger. Limbs that overlap
/// more deeply still overlap afterwards, because larger displacements would be visible.
constexpr double kMaxMoveNearCloth = 0.03;

/// The nearness of cloth to a limb also applies to skin of another limb inside it: fully up to half of this depth [m],
/// then decreasing to 0 at this depth.
constexpr double kMaxNearClothDepth = 0.05;

/// Skin follows its neighbours fully over edges up to this length [m], and less over longer edges. Dents in coarse
/// meshes are then as narrow as in fine ones.
constexpr double kFullFollowEdge = 0.02;

/// The number of the limb of each joint (index into kLimbNames), in the order of Joint. The trunk includes neck, head
/// and shoulders. Hands belong to lower arms and feet to lower legs, because they are too thin to move back separately.
constexpr std::array<std::uint8_t, kJointCount> kLimbOf = {0, 0, 0, 0, 0, 0, 1, 2, 2, 3, 4,
                                                           4, 4, 0, 5, 6, 6, 7, 8, 8, 8};
constexpr std::array<const char*, 9> kLimbNames = {"trunk",           "left upper arm",  "left lower arm",
                                                   "left upper leg",  "left lower leg",  "right upper arm",
                                                   "right lower arm", "right upper leg", "right lower leg"};

const char* name_of(const LimbClearance::LimbWeights& weights) {
  return kLimbNames[static_cast<std::size_t>(std::ranges::max_element(weights) - weights.begin())];
}

std::vector<LimbClearance::LimbWeights> limb_weights_of(const Rig& rig) {
  const Character& body = rig.character;
  std::vector<std::uint8_t> limb_of_node;
  for (const Index joint : joints_of_nodes(body, rig.joints))
    limb_of_node.push_back(joint < 0 ? std::uint8_t{0} : kLimbOf[joint]);
  std::vector<LimbClearance::LimbWeights> weights(body.mesh.positions.size(), LimbClearance::LimbWeights{});
  for (std::size_t v = 0; v < weights.size(); ++v)
    for (Index i = body.first_influence[v]; i < body.first_influence[v + 1]; ++i)
      weights[v][limb_of_node[body.bones[body.influences[i].bone].node]] +=
          static_cast<float>(body.influences[i].weight);
  return weights;
}

/// Half of the sum of all absolute differences: 0 for equal weights, 1 for weights without a common limb.
float difference(const LimbClearance::LimbWeights& a, const LimbClearance::LimbWeights& b) {
  float sum = 0;
  for (std::size_t l = 0; l < a.size(); ++l) sum += std::abs(a[l] - b[l]);
  return 0.5F * sum;
}

/// The body with a new mesh in the bind pose, whose vertices get the positions `places` in the rest pose.
Character rebind_to_bones(const Character& body, const std::vector<Vec3>& places) {
  Character rebound{body.nodes, body.bones, {}, body.first_influence, body.influences, {}, {}, {}, {}, {}};
  const Pose rest = rest_pose(rebound);
  // Positions to which the skinning map of each vertex moves the origin and the unit vectors.
  std::array<std::vector<Vec3>, 4> images;
  for (int k = 0; k < 4; ++k) {
    rebound.mesh.positions.assign(places.size(), k == 0 ? Vec3(Vec3::Zero()) : Vec3(Vec3::Unit(k - 1)));
    images[k].resize(places.size());
    skin(rebound, rest, images[k]);
  }
  for (std::size_t v = 0; v < places.size(); ++v) {
    Mat3 map;
    for (int k = 0; k < 3; ++k) map.col(k) = images[k + 1][v] - images[0][v];
    rebound.mesh.positions[v] = map.fullPivLu().solve(places[v] - images[0][v]);
  }
  return rebound;
}

}  // namespace

LimbClearance::LimbClearance(const Rig& rig, const VertexMask& touched, std::vector<float> near_cloth, double clearance,
                             std::vector<Ground> grounds)
    : clearance_(clearance),
      grounds_(std::move(grounds)),
      limb_weights_(limb_weights_of(rig)),
      near_(std::move(near_cloth)),
      touched_(touched),
      foot_(vertices_of(rig.character, rig.joints, joints_of_part("feet"))) {
  for (const mesh::Triangle& t : rig.character.mesh.topology.triangles) {
    if (std::ranges::any_of(t, [&](Index v) { return touched_[v] == 0; })) continue;
    triangles_.push_back(t);
    near_of_triangle_.push_back(std::min({near_[t[0]], near_[t[1]], near_[t[2]]}));
    LimbWeights& mean = limb_weights_of_triangle_.emplace_back();
    for (std::size_t l = 0; l < mean.size(); ++l)
      mean[l] = (limb_weights_[t[0]][l] + limb_weights_[t[1]][l] + limb_weights_[t[2]][l]) / 3;
    for (int k = 0; k < 3; ++k) edges_.push_back({t[k], t[(k + 1) % 3]});
  }
  const Pose rest = rest_pose(rig.character);
  std::vector<Vec3> places = growth_start_positions(rig.character, rest);
  bones_ = rebind_to_bones(rig.character, places);
  std::vector<Vec3> skinned(rig.character.mesh.positions.size());
  skin(rig.character, rest, skinned);
  missing_at_rest_.assign(touched_.size(), 0);
  std::vector<MissingClearance> missing(touched_.size());
  find_missing(places, skinned, skinned, missing);
  for (std::size_t v = 0; v < missing.size(); ++v) missing_at_rest_[v] = missing[v].distance;
}

// Computes the missing clearance per vertex. The line of a vertex goes from the bone to the skin and is extended by the
// clearance. The missing clearance is the length of this line from the first entry into another limb to its end, minus
// the same length in the rest pose. `from`: points on the bones. `skin`: unmoved skin, which defines the lines. `x`:
// present positions of the skin.
void LimbClearance::find_missing(std::span<const Vec3> from, std::span<const Vec3> skin, std::span<const Vec3> x,
                                 std::vector<MissingClearance>& missing) const {
  Box3 box;
  for (const mesh::Triangle& t : triangles_) box.extend(x[t[0]]);
  if (triangles_.empty()) return;
  const mesh::TriangleGrid grid(triangles_, x, box.diagonal().maxCoeff() / kCellsPerSide);
  parallel_for(touched_.size(), kLinesPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      missing[v] = {};
      const double length = (skin[v] - from[v]).norm();
      // If more than the clearance is missing in the rest pose, limbs cross there on purpose, such as plates of armour.
      if (touched_[v] == 0 || !(length > 0) || missing_at_rest_[v] > clearance_) continue;
      const Vec3 to = x[v] + clearance_ / length * (skin[v] - from[v]);
      const mesh::Entry entry = grid.find_first_crossing(from[v], to, [&](Index t) {
        return difference(limb_weights_of_triangle_[t], limb_weights_[v]) > kMinWeightDifference;
      });
      if (entry.triangle < 0) continue;
      const double all = (1 - entry.t) * (to - from[v]).norm();
      const double shallow = std::clamp(2 - 2 * (all - clearance_) / kMaxNearClothDepth, 0.0, 1.0);
      missing[v] = {std::max(0.0, all - missing_at_rest_[v]),
                    std::max(near_[v], static_cast<float>(shallow) * near_of_triangle_[entry.triangle]),
                    entry.triangle};
    }
  });
}

// Moves each vertex back by at least the mean fraction by which its neighbours moved back. A neighbour counts less if
// its edge is longer than kFullFollowEdge. `lengths`: of the edges [m]. `remaining`: per vertex, the fraction of its
// line that remains.
void LimbClearance::smooth(std::span<const double> lengths, std::vector<double>& remaining) const {
  std::vector<double> sums(remaining.size()), counts(remaining.size());
  for (int round = 0; round < kSmoothingPasses; ++round) {
    std::ranges::fill(sums, 0);
    std::ranges::fill(counts, 0);
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      const auto [a, b] = edges_[e];
      const double along = std::min(1.0, kFullFollowEdge / lengths[e]);
      sums[a] += along * (1 - remaining[b]), sums[b] += along * (1 - remaining[a]);
      ++counts[a], ++counts[b];
    }
    for (std::size_t v = 0; v < remaining.size(); ++v)
      if (counts[v] > 0) remaining[v] = std::min(remaining[v], 1 - sums[v] / counts[v]);
  }
}

// Lifts skin out of the ground. Does not lift skin whose points on the bones are in the ground: either the author of
// the scene intends this, or lifting the skin does not help.
void LimbClearance::lift_from_ground(std::span<const Vec3> from, std::span<Vec3> x) const {
  for (const Ground& ground : grounds_)
    for (std::size_t v = 0; v < touched_.size(); ++v) {
      if (touched_[v] == 0 || foot_[v] != 0 || near_[v] <= 0) continue;
      const double missing = ground.height + kGroundClearanceRatio * clearance_ - ground.up.dot(x[v]);
      const double lift_fraction = std::clamp((ground.up.dot(from[v]) - ground.height) / clearance_, 0.0, 1.0);
      if (missing > 0) x[v] += static_cast<double>(near_[v]) * lift_fraction * missing * ground.up;
    }
}

// Finds the vertex that moved farthest. A vertex first moves back from `before` to `unlifted`, then up to `x`. `other`:
// per vertex, the triangle of another limb from which it moved back; -1: it did not move, or only followed its
// neighbours.
LargestDisplacement LimbClearance::find_largest_displacement(std::span<const Vec3> before,
                                                             std::span<const Vec3> unlifted, std::span<const Vec3> x,
                                                             std::vector<Index> other) const {
  LargestDisplacement moved;
  for (std::size_t v = 0; v < before.size(); ++v) {
    const double distance = (x[v] - before[v]).norm();
    if (distance > moved.distance) moved.distance = distance, moved.vertex = static_cast<Index>(v);
  }
  if (moved.vertex < 0) return moved;
  const auto v = static_cast<std::size_t>(moved.vertex);
  moved.limb = name_of(limb_weights_[v]);
  moved.away_from = "ground";
  if ((x[v] - unlifted[v]).norm() > (unlifted[v] - before[v]).norm()) return moved;
  // If the vertex only followed its neighbours, spreads `other` along edges until the vertex has a triangle.
  std::vector<Index> known;
  while (other[v] < 0 && known != other) {
    known = other;
    for (const auto& [a, b] : edges_) {
      if (known[a] < 0) other[a] = std::max(other[a], known[b]);
      if (known[b] < 0) other[b] = std::max(other[b], known[a]);
    }
  }
  if (other[v] >= 0) moved.away_from = name_of(limb_weights_of_triangle_[other[v]]);
  return moved;
}

LargestDisplacement LimbClearance::move_skin(const Pose& pose, std::span<Vec3> x) const {
  const std::vector<Vec3> original(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(touched_.size()));
  std::vector<Vec3> from(touched_.size());
  skin(bones_, {pose.nodes, {}}, from);
  std::vector<double> lengths;
  for (const auto& [a, b] : edges_) lengths.push_back((original[a] - original[b]).norm());
  std::vector<double> remaining(touched_.size(), 1);
  // Largest displacement of each vertex due to its own missing clearance [m]. Smoothing may move the vertex farther.
  std::vector<double> max_given(touched_.size(), 0);
  std::vector<float> near = near_;
  std::vector<Index> other(touched_.size(), -1);
  std::vector<MissingClearance> missing(touched_.size());
  for (int round = 0; round < kMaxRounds; ++round) {
    find_missing(from, original, x, missing);
    bool changed = false;
    for (std::size_t v = 0; v < remaining.size(); ++v) {
      if (missing[v].distance <= 0 || missing[v].near <= 0) continue;
      if (other[v] < 0) other[v] = missing[v].triangle;
      near[v] = std::max(near[v], missing[v].near);
      max_given[v] =
          std::max(max_given[v], kMaxGivenFraction * static_cast<double>(missing[v].near) * missing[v].distance);
      const double length = (original[v] - from[v]).norm(), before = remaining[v];
      const double lower_limit = std::max(kMinRemainingFraction, 1 - max_given[v] / length);
      remaining[v] = std::min(before, std::max(lower_limit, before - kMaxGivenFraction * missing[v].distance / length));
      changed |= (before - remaining[v]) * length > kMissingTolerance * clearance_;
    }
    // Smooths in every round. Otherwise, neighbours of a vertex that moves back alone would stay inside the other limb.
    smooth(lengths, remaining);
    for (std::size_t v = 0; v < remaining.size(); ++v) {
      if (!(remaining[v] < 1)) continue;
      const double max_move =
          std::lerp(kMaxMoveWithoutCloth, std::max(kMaxMoveNearCloth, 2 * clearance_), static_cast<double>(near[v]));
      remaining[v] = std::max({remaining[v], kMinRemainingFraction, 1 - max_move / (original[v] - from[v]).norm()});
      x[v] = from[v] + remaining[v] * (original[v] - from[v]);
    }
    if (!changed) break;
  }
  const std::vector<Vec3> unlifted(x.begin(), x.begin() + std::ssize(original));
  lift_from_ground(from, x);
  return find_largest_displacement(original, unlifted, x, std::move(other));
}

}  // namespace weft::character
