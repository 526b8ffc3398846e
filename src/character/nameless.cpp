#include "character/nameless.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "character/joints.hpp"
#include "character/pose.hpp"

namespace weft::character {
namespace {

/// Chains of both sides differ by less in their first bones and as a whole, by what is longer: recordings have left and
/// right legs that differ by 2 %, fingers end at different ones left and right.
constexpr double kAlike = 0.1;
/// Bones that are compared one by one: a helper, the upper and the lower one.
constexpr int kCompared = 3;
/// So many chains part at a hand.
constexpr int kFingers = 3;
/// Of two places for the elbow the outer one counts if its shorter bone is as long as this share of the other's: there
/// are recordings with collarbones of 13 and forearms of 9 cm; hands have less than half of a forearm up to the
/// fingers.
constexpr double kElbow = 0.6;
/// Halves of a bone differ by less, and upper and lower bones of limbs by no more than this factor (those of adults by
/// 1.0 to 1.3).
constexpr double kSameHalf = 0.01, kHalves = 1.5;
/// Bones of necks that do not bend are shorter than this share of a leg; those that are longer are heads.
constexpr double kNeckBone = 0.17;
/// Of a clip so many moments say how somebody stands.
constexpr int kMoments = 32;
/// Rotations of a clip that differ by less do not move [radians].
constexpr double kStill = 1e-4;
/// What tells the left, in cubes of a leg: trunk times way forward times way across, 0.03 in a body whose feet are
/// known, 2e-4 for knees that are 1 mm before a straight leg.
constexpr double kTells = 1e-4;

/// Nodes of a limb, from the trunk outward; -1 for those that it has not.
struct Chain {
  Index shoulder = -1, upper = -1, lower = -1, end = -1, tip = -1;
  double length = 0;  ///< of upper and lower bone [m]
};

/// Two chains that leave one node.
struct Pair {
  Index from = -1, a = -1, b = -1;
  double reach = 0;  ///< of the shorter one [m]
};

bool moves(const Channel& channel) {
  return std::ranges::any_of(channel.rotation.values, [&](const Quat& turned) {
    return turned.angularDistance(channel.rotation.values.front()) > kStill;
  });
}

class NamelessFinder {
 public:
  explicit NamelessFinder(const Character& character)
      : character_(character), count_(character.nodes.size()), joints_(kJointCount, -1) {
    const std::vector<Affine> at_rest = global_transforms(character, rest_pose(character));
    length_.assign(count_, 0);
    children_.resize(count_);
    for (std::size_t n = 0; n < count_; ++n) {
      const Index parent = character.nodes[n].parent;
      if (parent < 0) continue;
      // Turns do not change lengths, so that any pose is as good as that at rest.
      length_[n] = (at_rest[n].translation() - at_rest[parent].translation()).norm();
      children_[parent].push_back(static_cast<Index>(n));
    }
    find_reach();
    find_ends();
  }

  std::vector<Index> find() {
    const auto pairs = find_pairs();
    if (!pairs) return joints_;
    const auto& [legs, arms] = *pairs;
    const std::array leg{chain_of(legs.a, 1), chain_of(legs.b, 1)},
        arm{chain_of(arms.a, kElbow), chain_of(arms.b, kElbow)};
    const auto across = [&](const std::array<Chain, 2>& limb) {
      return mean_over_moments([&](const std::vector<Vec3>& at) {
        return (at[limb[0].upper] - at[limb[1].upper]).dot(to_the_left(at, leg, arm));
      });
    };
    const double legs_across = across(leg), arms_across = across(arm), size = legs.reach * legs.reach * legs.reach;
    if (!(std::min(std::abs(legs_across), std::abs(arms_across)) > kTells * size)) return joints_;
    for (const bool right : {false, true}) {
      const Chain &l = leg[right != (legs_across < 0)], &a = arm[right != (arms_across < 0)];
      put(Joint::left_upper_leg, right, l.upper);
      put(Joint::left_lower_leg, right, l.lower);
      put(Joint::left_foot, right, l.end);
      put(Joint::left_toes, right, l.tip);
      put(Joint::left_shoulder, right, a.shoulder);
      put(Joint::left_upper_arm, right, a.upper);
      put(Joint::left_lower_arm, right, a.lower);
      put(Joint::left_hand, right, a.end);
    }
    find_head(arms, leg, arm);
    return joints_;
  }

 private:
  void put(Joint left, bool right, Index node) { joints_[place_of(on_side(left, right))] = node; }

  /// How far the longest chain below each node goes, and along which child.
  void find_reach() {
    reach_.assign(count_, 0);
    next_.assign(count_, -1);
    for (std::size_t n = count_; n-- > 0;)
      for (const Index child : children_[n])
        if (const double reach = length_[child] + reach_[child]; next_[n] < 0 || reach > reach_[n]) {
          reach_[n] = reach;
          next_[n] = child;
        }
  }

  void find_ends() {
    acts_.assign(count_, false);
    for (const Influence& influence : character_.influences) acts_[character_.bones[influence.bone].node] = true;
    for (const Clip& clip : character_.clips)
      for (const Channel& channel : clip.channels)
        if (moves(channel)) acts_[channel.node] = true;
    is_joint_ = acts_;
    for (std::size_t n = 0; n < count_; ++n)
      if (!children_[n].empty()) is_joint_[n] = true;
  }

  bool is_below(Index node, Index above) const {
    while (node >= 0 && node != above) node = character_.nodes[node].parent;
    return node >= 0;
  }

  bool alike(Index a, Index b) const {
    const double most = kAlike * std::max(reach_[a], reach_[b]);
    if (std::abs(reach_[a] - reach_[b]) > most) return false;
    for (int k = 0; k < kCompared; ++k) {
      a = next_[a];
      b = next_[b];
      if (a < 0 || b < 0) return a == b;
      if (std::abs(length_[a] - length_[b]) > most) return false;
    }
    return true;
  }

  /// Legs and arms.
  std::optional<std::pair<Pair, Pair>> find_pairs() const {
    std::vector<Pair> pairs;
    for (std::size_t n = 0; n < count_; ++n)
      for (std::size_t i = 0; i < children_[n].size(); ++i)
        for (std::size_t j = i + 1; j < children_[n].size(); ++j) {
          const Index a = children_[n][i], b = children_[n][j];
          if (alike(a, b) && chain_of(a, 1).end >= 0 && chain_of(b, 1).end >= 0)
            pairs.push_back({static_cast<Index>(n), a, b, std::min(reach_[a], reach_[b])});
        }
    std::ranges::stable_sort(pairs, std::greater(), &Pair::reach);
    // A spine may be like a leg: what it is paired with meets all others.
    for (std::size_t first = 0; first < pairs.size(); ++first)
      for (std::size_t second = first + 1; second < pairs.size(); ++second)
        if (apart(pairs[first], pairs[second])) return legs_and_arms(pairs[first], pairs[second]);
    return {};
  }

  bool apart(const Pair& p, const Pair& q) const {
    const auto meet = [&](Index x, Index y) { return is_below(x, y) || is_below(y, x); };
    return !meet(p.a, q.a) && !meet(p.a, q.b) && !meet(p.b, q.a) && !meet(p.b, q.b);
  }

  std::pair<Pair, Pair> legs_and_arms(const Pair& p, const Pair& q) const {
    const bool p_above = p.from != q.from && is_below(q.from, p.from);
    const bool q_above = p.from != q.from && is_below(p.from, q.from);
    const bool p_longer = chain_of(p.a, 1).length > chain_of(q.a, 1).length;
    return p_above || (!q_above && p_longer) ? std::pair{p, q} : std::pair{q, p};
  }

  /// `outer`: how much shorter bones may be to be preferred because they lie farther out.
  Chain chain_of(Index from, double outer) const {
    std::vector<Index> nodes;
    std::size_t last = 0, hand = 0;  // that may end the lower bone; where fingers part
    for (Index n = from; n >= 0; n = next_[n]) {
      nodes.push_back(n);
      if (is_joint_[n]) last = nodes.size() - 1;
      if (hand == 0 && std::ranges::count_if(children_[n], [&](Index c) { return reach_[c] > 0; }) >= kFingers)
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

  /// The length of the bones from a node to one below it.
  double length_between(Index above, Index below) const {
    double sum = 0;
    for (; below != above; below = character_.nodes[below].parent) sum += length_[below];
    return sum;
  }

  /// Upper and lower bones that are in two halves, as twists of rigs want them, become whole: four bones of which two
  /// and two are as long, and one pair is not much longer than the other.
  void join_halves(std::vector<Index>& nodes, std::size_t& last) const {
    for (std::size_t i = 0; i + 4 <= last; ++i) {
      const auto bone = [&](std::size_t k) { return length_[nodes[i + k]]; };
      const auto same = [](double a, double b) { return std::abs(a - b) < kSameHalf * std::max(a, b); };
      const double ratio = bone(3) / bone(1);
      if (!same(bone(1), bone(2)) || !same(bone(3), bone(4)) || !(ratio > 1 / kHalves && ratio < kHalves)) continue;
      nodes.erase(nodes.begin() + static_cast<std::ptrdiff_t>(i + 3));
      nodes.erase(nodes.begin() + static_cast<std::ptrdiff_t>(i + 1));
      last -= 2;
      return;
    }
  }

  /// The mean of a figure over what the first clip shows, or at rest. `figure`: by the places of all nodes.
  template <class Figure>
  double mean_over_moments(const Figure& figure) const {
    const bool clip = !character_.clips.empty();
    const int moments = clip ? kMoments : 1;
    double sum = 0;
    std::vector<Vec3> places(count_);
    for (int k = 0; k < moments; ++k) {
      const Pose pose =
          clip ? pose_at(character_, character_.clips.front(), character_.clips.front().duration * k / moments)
               : rest_pose(character_);
      const std::vector<Affine> globals = global_transforms(character_, pose);
      for (std::size_t n = 0; n < count_; ++n) places[n] = globals[n].translation();
      sum += figure(places);
    }
    return sum / moments;
  }

  static Vec3 trunk(const std::vector<Vec3>& at, const std::array<Chain, 2>& leg, const std::array<Chain, 2>& arm) {
    return (at[arm[0].upper] + at[arm[1].upper] - at[leg[0].upper] - at[leg[1].upper]) / 2;
  }

  /// Across the trunk and what points forward: feet, and knees as far as they are bent.
  Vec3 to_the_left(const std::vector<Vec3>& at, const std::array<Chain, 2>& leg,
                   const std::array<Chain, 2>& arm) const {
    Vec3 forward = Vec3::Zero();
    for (const Chain& l : leg) {
      if (next_[l.end] >= 0) forward += at[next_[l.end]] - at[l.end];
      forward += at[l.lower] - (at[l.upper] + at[l.end]) / 2;
    }
    return trunk(at, leg, arm).cross(forward);
  }

  /// Of the nodes right below the arms' that which goes farthest up, and from there to where it parts or ends.
  void find_head(const Pair& arms, const std::array<Chain, 2>& leg, const std::array<Chain, 2>& arm) {
    Index neck = -1;
    double highest = 0;
    for (const Index child : children_[arms.from]) {
      if (child == arms.a || child == arms.b || !is_joint_[child]) continue;
      Index tip = child;
      while (next_[tip] >= 0) tip = next_[tip];
      if (is_below(leg[0].upper, child)) continue;
      const double height = mean_over_moments(
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
        if (acts_[child] || (is_joint_[child] && length_[child] < kNeckBone * leg[0].length)) {
          only = child;
          ++below;
        }
      if (below != 1) break;
      head = only;
    }
    if (head != neck) joints_[place_of(Joint::neck)] = neck;
    joints_[place_of(Joint::head)] = head;
  }

  const Character& character_;
  const std::size_t count_;
  std::vector<Index> joints_;
  std::vector<double> length_;                // of the bone that ends at a node, at rest [m]
  std::vector<std::vector<Index>> children_;  // of each node
  std::vector<double> reach_;                 // of the longest chain below a node [m]
  std::vector<Index> next_;                   // child along it, or -1
  std::vector<bool> acts_;                    // holds skin, or moves in a clip
  std::vector<bool> is_joint_;                // or has nodes below
};

}  // namespace

std::vector<Index> find_nameless_joints(const Character& character) {
  return NamelessFinder(character).find();
}

std::array<Index, 2> find_knuckles(const Character& character, Index hand) {
  const std::vector<Node>& nodes = character.nodes;
  std::vector<double> reach(nodes.size(), 0);  // of the longest chain from its parent through a node
  for (std::size_t n = nodes.size(); n-- > 0;) {
    reach[n] += nodes[n].local.translation().norm();
    if (const Index parent = nodes[n].parent; parent >= 0) reach[parent] = std::max(reach[parent], reach[n]);
  }
  const auto place = [&](Index finger) -> Vec3 { return nodes[finger].local.translation(); };
  std::vector<Index> fingers;
  Vec3 along = Vec3::Zero();
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const auto finger = static_cast<Index>(n);
    if (nodes[n].parent != hand || !(reach[n] > place(finger).norm())) continue;
    fingers.push_back(finger);
    along += place(finger);
  }
  constexpr std::size_t kFewest = 4;
  if (fingers.size() < kFewest) return {-1, -1};
  const Index thumb = *std::ranges::min_element(fingers, {}, [&](Index f) { return reach[f]; });
  std::erase(fingers, thumb);
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
