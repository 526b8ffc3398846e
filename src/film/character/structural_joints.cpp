#include "film/character/structural_joints.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "film/character/joints.hpp"
#include "film/character/pose.hpp"

namespace weft::character {
namespace {

/// Maximum difference between the lengths of left and right chain, relative to the longer chain. Applies to each of
/// their first bones and to the whole chains. Left and right legs of recordings differ by 2 %; the longest chains of
/// two arms may end at different fingers.
constexpr double kMaxChainDifference = 0.1;
/// Number of bones of two chains that are compared one by one: upper and lower bone, and possibly an auxiliary bone.
constexpr int kComparedBones = 3;
/// Minimum number of chains that branch at a hand.
constexpr int kMinFingers = 3;
/// Decides between two candidates for the elbow. Compares the shorter of the two bones that meet at each candidate. The
/// outer candidate is chosen if its shorter bone is longer than this fraction of the inner candidate's. The fraction is
/// below 9/13, because some recordings have collarbones of 13 cm and forearms of 9 cm. It is above 1/2, because the
/// part of a hand up to the fingers is shorter than half a forearm.
constexpr double kMinOuterElbowRatio = 0.6;
/// kMaxEqualDifference: maximum relative difference of lengths that count as equal, such as those of the two halves of
/// a split bone; covers the rounding of files. kMaxLimbBoneRatio: maximum ratio between the lengths of upper and lower
/// bone of a limb (1.0 to 1.3 in adults).
constexpr double kMaxEqualDifference = 0.01, kMaxLimbBoneRatio = 1.5;
/// A node above the arms that neither influences skin nor moves belongs to the neck if its bone is shorter than this
/// fraction of the leg length. A longer bone is that of the head.
constexpr double kMaxNeckBone = 0.17;
/// Number of samples of a clip that determine the posture.
constexpr int kPostureSamples = 32;
/// A node moves if it rotates by more than this in a clip [rad].
constexpr double kMinRotation = 1e-4;
/// Minimum magnitude of the triple product (trunk, forward, across) from which the left side is determined [cubed leg
/// lengths]. The product is 0.03 for a body with known feet, 2e-4 for knees that are 1 mm in front of a straight leg.
constexpr double kMinLeftSignal = 1e-4;

/// Nodes of a limb, from the trunk outward (`end`: hand or foot, `tip`: toes); -1 if missing.
struct Chain {
  Index shoulder = -1, upper = -1, lower = -1, end = -1, tip = -1;
  double length = 0;  ///< of upper and lower bone [m]
};

/// Two chains that leave the node `from`. `a`, `b`: their first nodes.
struct Pair {
  Index from = -1, a = -1, b = -1;
  double chain_length = 0;  ///< length of the shorter chain [m]
};

bool moves(const Channel& channel) {
  return std::ranges::any_of(channel.rotation.values, [&](const Quat& turned) {
    return turned.angularDistance(channel.rotation.values.front()) > kMinRotation;
  });
}

/// Implements find_joints_by_structure().
class StructuralJointFinder {
 public:
  explicit StructuralJointFinder(const Character& character)
      : character_(character), count_(character.nodes.size()), joints_(kJointCount, -1) {
    const std::vector<Affine> at_rest = global_transforms(character, rest_pose(character));
    length_.assign(count_, 0);
    children_.resize(count_);
    for (std::size_t n = 0; n < count_; ++n) {
      const Index parent = character.nodes[n].parent;
      if (parent < 0) continue;
      // The lengths are the same in any pose.
      length_[n] = (at_rest[n].translation() - at_rest[parent].translation()).norm();
      children_[parent].push_back(static_cast<Index>(n));
    }
    compute_chain_lengths();
    find_ends();
  }

  std::vector<Index> find() {
    const auto pairs = find_pairs();
    if (!pairs) return joints_;
    const auto& [legs, arms] = *pairs;
    const std::array leg{chain_of(legs.a, 1), chain_of(legs.b, 1)},
        arm{chain_of(arms.a, kMinOuterElbowRatio), chain_of(arms.b, kMinOuterElbowRatio)};
    const auto across = [&](const std::array<Chain, 2>& limb) {
      return mean_over_clip([&](const std::vector<Vec3>& at) {
        return (at[limb[0].upper] - at[limb[1].upper]).dot(to_the_left(at, leg, arm));
      });
    };
    const double legs_across = across(leg), arms_across = across(arm),
                 size = legs.chain_length * legs.chain_length * legs.chain_length;
    if (!(std::min(std::abs(legs_across), std::abs(arms_across)) > kMinLeftSignal * size)) return joints_;
    for (const bool right : {false, true}) {
      const Chain &l = leg[right != (legs_across < 0)], &a = arm[right != (arms_across < 0)];
      set_joint(Joint::left_upper_leg, right, l.upper);
      set_joint(Joint::left_lower_leg, right, l.lower);
      set_joint(Joint::left_foot, right, l.end);
      set_joint(Joint::left_toes, right, l.tip);
      set_joint(Joint::left_shoulder, right, a.shoulder);
      set_joint(Joint::left_upper_arm, right, a.upper);
      set_joint(Joint::left_lower_arm, right, a.lower);
      set_joint(Joint::left_hand, right, a.end);
    }
    find_head(arms, leg, arm);
    return joints_;
  }

 private:
  void set_joint(Joint left, bool right, Index node) { joints_[joint_index(on_side(left, right))] = node; }

  /// Computes the length of the longest chain below each node, and the child to which this chain leads.
  void compute_chain_lengths() {
    chain_length_.assign(count_, 0);
    next_.assign(count_, -1);
    for (std::size_t n = count_; n-- > 0;)
      for (const Index child : children_[n])
        if (const double length = length_[child] + chain_length_[child]; next_[n] < 0 || length > chain_length_[n]) {
          chain_length_[n] = length;
          next_[n] = child;
        }
  }

  /// Determines which nodes are active, and which are joints rather than end markers of bones.
  void find_ends() {
    is_active_.assign(count_, false);
    for (const Influence& influence : character_.influences) is_active_[character_.bones[influence.bone].node] = true;
    for (const Clip& clip : character_.clips)
      for (const Channel& channel : clip.channels)
        if (moves(channel)) is_active_[channel.node] = true;
    is_joint_ = is_active_;
    for (std::size_t n = 0; n < count_; ++n)
      if (!children_[n].empty()) is_joint_[n] = true;
  }

  bool is_below(Index node, Index above) const {
    while (node >= 0 && node != above) node = character_.nodes[node].parent;
    return node >= 0;
  }

  /// Whether the longest chains through the nodes `a` and `b` can be left and right limb of a body.
  bool are_alike(Index a, Index b) const {
    const double max_difference = kMaxChainDifference * std::max(chain_length_[a], chain_length_[b]);
    if (std::abs(chain_length_[a] - chain_length_[b]) > max_difference) return false;
    for (int k = 0; k < kComparedBones; ++k) {
      a = next_[a];
      b = next_[b];
      if (a < 0 || b < 0) return a == b;
      if (std::abs(length_[a] - length_[b]) > max_difference) return false;
    }
    return true;
  }

  /// Finds the pairs of legs and arms.
  std::optional<std::pair<Pair, Pair>> find_pairs() const {
    std::vector<Pair> pairs;
    for (std::size_t n = 0; n < count_; ++n)
      for (std::size_t i = 0; i < children_[n].size(); ++i)
        for (std::size_t j = i + 1; j < children_[n].size(); ++j) {
          const Index a = children_[n][i], b = children_[n][j];
          if (are_alike(a, b) && chain_of(a, 1).end >= 0 && chain_of(b, 1).end >= 0)
            pairs.push_back({static_cast<Index>(n), a, b, std::min(chain_length_[a], chain_length_[b])});
        }
    std::ranges::stable_sort(pairs, std::greater(), &Pair::chain_length);
    // The spine may be as long as a leg and form a pair with it. This pair is not disjoint from that of the arms, which
    // branch from the spine, nor from other pairs at the hip.
    for (std::size_t first = 0; first < pairs.size(); ++first)
      for (std::size_t second = first + 1; second < pairs.size(); ++second)
        if (are_disjoint(pairs[first], pairs[second])) return legs_and_arms(pairs[first], pairs[second]);
    return {};
  }

  bool are_disjoint(const Pair& p, const Pair& q) const {
    const auto meet = [&](Index x, Index y) { return is_below(x, y) || is_below(y, x); };
    return !meet(p.a, q.a) && !meet(p.a, q.b) && !meet(p.b, q.a) && !meet(p.b, q.b);
  }

  std::pair<Pair, Pair> legs_and_arms(const Pair& p, const Pair& q) const {
    const bool p_above = p.from != q.from && is_below(q.from, p.from);
    const bool q_above = p.from != q.from && is_below(p.from, q.from);
    const bool p_longer = chain_of(p.a, 1).length > chain_of(q.a, 1).length;
    return p_above || (!q_above && p_longer) ? std::pair{p, q} : std::pair{q, p};
  }

  /// Finds the upper and the lower bone on the longest chain through the node `from`. A pair of bones farther out
  /// replaces the pair found so far if its shorter bone is longer than `outer` times the longest of the shorter bones
  /// of all pairs before it.
  Chain chain_of(Index from, double outer) const {
    std::vector<Index> nodes;
    std::size_t last = 0, hand = 0;  // last possible end of the lower bone; node where fingers branch
    for (Index n = from; n >= 0; n = next_[n]) {
      nodes.push_back(n);
      if (is_joint_[n]) last = nodes.size() - 1;
      if (hand == 0 &&
          std::ranges::count_if(children_[n], [&](Index c) { return chain_length_[c] > 0; }) >= kMinFingers)
        hand = nodes.size() - 1;
    }
    if (hand >= 2) last = hand;
    if (last < 2) last = nodes.size() - 1;  // an arm without a hand
    join_halves(nodes, last);
    Chain chain;
    double longest = 0;
    for (std::size_t i = 0; i + 2 <= last; ++i) {
      const double upper = length_between(nodes[i], nodes[i + 1]), lower = length_between(nodes[i + 1], nodes[i + 2]);
      const double shorter = std::min(upper, lower);
      if (shorter <= outer * longest) continue;
      longest = std::max(longest, shorter);
      const auto joint = [&](std::size_t k) { return k < nodes.size() && is_joint_[nodes[k]] ? nodes[k] : -1; };
      chain = {i > 0 ? nodes[i - 1] : -1, nodes[i], nodes[i + 1], joint(i + 2), joint(i + 3), upper + lower};
    }
    return chain;
  }

  /// Total length of the bones from a node to a descendant [m].
  double length_between(Index above, Index below) const {
    double sum = 0;
    for (; below != above; below = character_.nodes[below].parent) sum += length_[below];
    return sum;
  }

  /// Merges the halves of split upper and lower bones, as in rigs with twist bones. Split bones are four consecutive
  /// bones that form two pairs of equal bones, with similar lengths in both pairs.
  void join_halves(std::vector<Index>& nodes, std::size_t& last) const {
    for (std::size_t i = 0; i + 4 <= last; ++i) {
      const auto bone = [&](std::size_t k) { return length_[nodes[i + k]]; };
      const auto same = [](double a, double b) { return std::abs(a - b) < kMaxEqualDifference * std::max(a, b); };
      const double ratio = bone(3) / bone(1);
      if (!same(bone(1), bone(2)) || !same(bone(3), bone(4)) ||
          !(ratio > 1 / kMaxLimbBoneRatio && ratio < kMaxLimbBoneRatio))
        continue;
      nodes.erase(nodes.begin() + static_cast<std::ptrdiff_t>(i + 3));
      nodes.erase(nodes.begin() + static_cast<std::ptrdiff_t>(i + 1));
      last -= 2;
      return;
    }
  }

  /// Mean of `figure` over the first clip; the value in the rest pose if there is no clip. `figure`: a function of the
  /// positions of all nodes.
  template <class Figure>
  double mean_over_clip(const Figure& figure) const {
    const bool clip = !character_.clips.empty();
    const int samples = clip ? kPostureSamples : 1;
    double sum = 0;
    std::vector<Vec3> places(count_);
    for (int k = 0; k < samples; ++k) {
      const Pose pose =
          clip ? pose_at(character_, character_.clips.front(), character_.clips.front().duration * k / samples)
               : rest_pose(character_);
      const std::vector<Affine> globals = global_transforms(character_, pose);
      for (std::size_t n = 0; n < count_; ++n) places[n] = globals[n].translation();
      sum += figure(places);
    }
    return sum / samples;
  }

  static Vec3 trunk(const std::vector<Vec3>& at, const std::array<Chain, 2>& leg, const std::array<Chain, 2>& arm) {
    return (at[arm[0].upper] + at[arm[1].upper] - at[leg[0].upper] - at[leg[1].upper]) / 2;
  }

  /// Vector to the left: the cross product of the trunk and the forward direction, which follows from feet and bent
  /// knees.
  Vec3 to_the_left(const std::vector<Vec3>& at, const std::array<Chain, 2>& leg,
                   const std::array<Chain, 2>& arm) const {
    Vec3 forward = Vec3::Zero();
    for (const Chain& l : leg) {
      if (next_[l.end] >= 0) forward += at[next_[l.end]] - at[l.end];
      forward += at[l.lower] - (at[l.upper] + at[l.end]) / 2;
    }
    return trunk(at, leg, arm).cross(forward);
  }

  /// Finds neck and head: the first and the last node of the highest chain that leaves the common ancestor of the arms.
  /// The chain ends where it branches.
  void find_head(const Pair& arms, const std::array<Chain, 2>& leg, const std::array<Chain, 2>& arm) {
    Index neck = -1;
    double highest = 0;
    for (const Index child : children_[arms.from]) {
      if (child == arms.a || child == arms.b || !is_joint_[child]) continue;
      Index tip = child;
      while (next_[tip] >= 0) tip = next_[tip];
      if (is_below(leg[0].upper, child)) continue;
      const double height = mean_over_clip(
          [&](const std::vector<Vec3>& at) { return (at[tip] - at[arms.from]).dot(trunk(at, leg, arm)); });
      if (height <= highest) continue;
      highest = height;
      neck = child;
    }
    if (neck < 0) return;
    Index head = neck;
    while (true) {
      Index only = -1;
      int below = 0;
      for (const Index child : children_[head])
        if (is_active_[child] || (is_joint_[child] && length_[child] < kMaxNeckBone * leg[0].length)) {
          only = child;
          ++below;
        }
      if (below != 1) break;
      head = only;
    }
    if (head != neck) joints_[joint_index(Joint::neck)] = neck;
    joints_[joint_index(Joint::head)] = head;
  }

  const Character& character_;
  const std::size_t count_;
  std::vector<Index> joints_;
  std::vector<double> length_;                // length of the bone that ends at a node [m]
  std::vector<std::vector<Index>> children_;  // of each node
  std::vector<double> chain_length_;          // length of the longest chain below a node [m]
  std::vector<Index> next_;                   // child of the node on this chain, or -1
  std::vector<bool> is_active_;               // per node: whether it influences skin, or moves in a clip
  std::vector<bool> is_joint_;                // per node: whether it is active, or has children
};

}  // namespace

std::vector<Index> find_joints_by_structure(const Character& character) {
  return StructuralJointFinder(character).find();
}

std::array<Index, 2> find_knuckles(const Character& character, Index hand) {
  const std::vector<Node>& nodes = character.nodes;
  // Per node: length of the longest chain from its parent through it.
  std::vector<double> chain_length(nodes.size(), 0);
  for (std::size_t n = nodes.size(); n-- > 0;) {
    chain_length[n] += nodes[n].local.translation().norm();
    if (const Index parent = nodes[n].parent; parent >= 0)
      chain_length[parent] = std::max(chain_length[parent], chain_length[n]);
  }
  const auto place = [&](Index finger) -> Vec3 { return nodes[finger].local.translation(); };
  std::vector<Index> fingers;
  Vec3 along = Vec3::Zero();
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const auto finger = static_cast<Index>(n);
    if (nodes[n].parent != hand || !(chain_length[n] > place(finger).norm())) continue;
    fingers.push_back(finger);
    along += place(finger);
  }
  constexpr std::size_t kMinFingerChains = 4;
  if (fingers.size() < kMinFingerChains) return {-1, -1};
  const auto length = [&](Index finger) { return chain_length[finger]; };
  const Index thumb = std::ranges::min(fingers, {}, length);
  std::erase(fingers, thumb);
  const double next = length(std::ranges::min(fingers, {}, length));
  if (next - length(thumb) < kMaxEqualDifference * next) return {-1, -1};
  std::array<Index, 2> ends{-1, -1};
  double widest = 0;
  for (const Index a : fingers)
    for (const Index b : fingers)
      if (const double width = (place(a) - place(b)).norm(); width > widest) {
        widest = width;
        ends = {a, b};
      }
  if (ends[0] < 0) return ends;
  Vec3 across = place(ends[1]) - place(ends[0]);
  across -= across.dot(along) / along.squaredNorm() * along;
  if ((2 * place(thumb) - place(ends[0]) - place(ends[1])).dot(across) > 0) std::swap(ends[0], ends[1]);
  return ends;
}

}  // namespace weft::character
