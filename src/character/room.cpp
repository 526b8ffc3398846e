#include "character/room.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "character/dressing.hpp"
#include "core/parallel.hpp"
#include "mesh/triangle_grid.hpp"

namespace weft::character {
namespace {

/// Skin that is held this differently is of two limbs: 1 that of two bones, 0 what the same bones hold alike. Near a
/// joint, where it changes from one bone to the other, it folds onto itself.
constexpr float kOther = 0.15F;

/// Lines looked at by one task; a task then takes some hundred microseconds.
constexpr std::size_t kLinesPerTask = 512;

/// Boxes of the search along the longest side of the body: of a person 3 cm.
constexpr double kCells = 60;

/// Rounds of giving way. One is enough where both sides see each other straight; each halves what is left elsewhere.
constexpr int kYieldingRounds = 8;

/// Of the room, what may be missing in the end.
constexpr double kLeastMissing = 0.02;

/// Smoothings in each round: dents end over so many edges and more.
constexpr int kSmoothings = 3;

/// Of the room, what is left between the body and the ground.
constexpr double kAboveGround = 0.5;

/// Least share of the way from bone to skin that is left of a limb.
constexpr double kLeast = 0.15;

/// Of a limb, by joints in their order: the trunk with neck, head and shoulders is one, hands go with lower arms and
/// toes with feet, as a fist has no inside.
constexpr std::array<std::uint8_t, kJointCount> kLimbOf = {0, 0, 0, 0, 0, 0, 1, 2, 2,  3, 4,
                                                           5, 5, 0, 6, 7, 7, 8, 9, 10, 10};
constexpr std::uint8_t kLeftFoot = 5, kRightFoot = 10;

std::vector<Room::Shares> shares_of_limbs(const Rig& rig) {
  const Character& body = rig.character;
  std::vector<std::uint8_t> limb_of_node(body.nodes.size(), 0);
  for (std::size_t n = 0; n < limb_of_node.size(); ++n) {
    const auto own = std::ranges::find(rig.joints, static_cast<Index>(n));
    if (own != rig.joints.end()) {
      limb_of_node[n] = kLimbOf[static_cast<std::size_t>(own - rig.joints.begin())];
    } else if (body.nodes[n].parent >= 0) {
      limb_of_node[n] = limb_of_node[body.nodes[n].parent];
    }
  }
  std::vector<Room::Shares> shares(body.mesh.positions.size(), Room::Shares{});
  for (std::size_t v = 0; v < shares.size(); ++v)
    for (Index i = body.first_influence[v]; i < body.first_influence[v + 1]; ++i)
      shares[v][limb_of_node[body.bones[body.influences[i].bone].node]] +=
          static_cast<float>(body.influences[i].weight);
  return shares;
}

/// Half of the sum of all differences.
float difference(const Room::Shares& a, const Room::Shares& b) {
  float sum = 0;
  for (std::size_t l = 0; l < a.size(); ++l) sum += std::abs(a[l] - b[l]);
  return 0.5F * sum;
}

/// The body with these places, given as they are in its rest pose, in the place of its skin as bound.
Character hung_on_bones(const Character& body, const std::vector<Vec3>& places) {
  Character hung{body.nodes, body.bones, {}, body.first_influence, body.influences, {}, {}, {}, {}, {}};
  const Pose rest = rest_pose(hung);
  // Where the map of each vertex takes the origin and the ends of the axes.
  std::array<std::vector<Vec3>, 4> images;
  for (int k = 0; k < 4; ++k) {
    hung.mesh.positions.assign(places.size(), k == 0 ? Vec3(Vec3::Zero()) : Vec3(Vec3::Unit(k - 1)));
    images[k].resize(places.size());
    skin(hung, rest, images[k]);
  }
  for (std::size_t v = 0; v < places.size(); ++v) {
    Mat3 map;
    for (int k = 0; k < 3; ++k) map.col(k) = images[k + 1][v] - images[0][v];
    hung.mesh.positions[v] = map.fullPivLu().solve(places[v] - images[0][v]);
  }
  return hung;
}

}  // namespace

Room::Room(const Rig& rig, const VertexMask& touched, double room, std::vector<Ground> grounds)
    : room_(room),
      grounds_(std::move(grounds)),
      shares_(shares_of_limbs(rig)),
      touched_(touched),
      foot_(touched.size()) {
  for (std::size_t v = 0; v < foot_.size(); ++v) foot_[v] = shares_[v][kLeftFoot] + shares_[v][kRightFoot] > 0.5F;
  for (const mesh::Triangle& t : rig.character.mesh.topology.triangles) {
    if (std::ranges::any_of(t, [&](Index v) { return touched_[v] == 0; })) continue;
    triangles_.push_back(t);
    Shares& mean = shares_of_triangle_.emplace_back();
    for (std::size_t l = 0; l < mean.size(); ++l)
      mean[l] = (shares_[t[0]][l] + shares_[t[1]][l] + shares_[t[2]][l]) / 3;
    for (int k = 0; k < 3; ++k) edges_.push_back({t[k], t[(k + 1) % 3]});
  }
  const Pose rest = rest_pose(rig.character);
  std::vector<Vec3> places = places_on_bones(rig.character, rest);
  bones_ = hung_on_bones(rig.character, places);
  std::vector<Vec3> skinned(rig.character.mesh.positions.size());
  skin(rig.character, rest, skinned);
  missing_at_rest_.assign(touched_.size(), 0);
  std::vector<double> missing(touched_.size());
  find_missing(places, skinned, skinned, missing);
  missing_at_rest_ = std::move(missing);
}

// How much of the way from the bone through the skin, to the room beyond it, is in another limb. `skin`: where the
// lines go, x: where the skin is now.
void Room::find_missing(std::span<const Vec3> from, std::span<const Vec3> skin, std::span<const Vec3> x,
                        std::vector<double>& missing) const {
  Box3 box;
  for (const mesh::Triangle& t : triangles_) box.extend(x[t[0]]);
  if (triangles_.empty()) return;
  const mesh::TriangleGrid grid(triangles_, x, box.diagonal().maxCoeff() / kCells);
  parallel_for(touched_.size(), kLinesPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      missing[v] = 0;
      const double length = (skin[v] - from[v]).norm();
      if (touched_[v] == 0 || !(length > 0)) continue;
      const Vec3 to = x[v] + room_ / length * (skin[v] - from[v]);
      const mesh::Entry entry = grid.first_entry(
          from[v], to, [&](Index t) { return difference(shares_of_triangle_[t], shares_[v]) > kOther; });
      if (entry.triangle >= 0) missing[v] = std::max(0.0, (1 - entry.t) * (to - from[v]).norm() - missing_at_rest_[v]);
    }
  });
}

// Each vertex gives way at least as far as its neighbours in the mean.
void Room::smooth(std::vector<double>& shares) const {
  std::vector<double> sums(shares.size()), counts(shares.size());
  for (int round = 0; round < kSmoothings; ++round) {
    std::ranges::fill(sums, 0);
    std::ranges::fill(counts, 0);
    for (const auto& [a, b] : edges_) {
      sums[a] += shares[b], sums[b] += shares[a];
      ++counts[a], ++counts[b];
    }
    for (std::size_t v = 0; v < shares.size(); ++v)
      if (counts[v] > 0) shares[v] = std::min(shares[v], sums[v] / counts[v]);
  }
}

// Limbs whose bones are in the ground stay there: they are meant to, or nothing helps.
void Room::lift(std::span<const Vec3> from, std::span<Vec3> x) const {
  for (const Ground& ground : grounds_)
    for (std::size_t v = 0; v < touched_.size(); ++v) {
      if (touched_[v] == 0 || foot_[v] != 0) continue;
      const double missing = ground.height + kAboveGround * room_ - ground.up.dot(x[v]);
      const double held = std::clamp((ground.up.dot(from[v]) - ground.height) / room_, 0.0, 1.0);
      if (missing > 0) x[v] += held * missing * ground.up;
    }
}

void Room::make(const Pose& pose, std::span<Vec3> x) const {
  const std::vector<Vec3> whole(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(touched_.size()));
  std::vector<Vec3> from(touched_.size());
  skin(bones_, {pose.nodes, {}}, from);
  std::vector<double> shares(touched_.size(), 1), missing(touched_.size());
  const auto move = [&] {
    for (std::size_t v = 0; v < shares.size(); ++v)
      if (shares[v] < 1) x[v] = from[v] + shares[v] * (whole[v] - from[v]);
  };
  for (int round = 0; round < kYieldingRounds; ++round) {
    find_missing(from, whole, x, missing);
    bool changed = false;
    for (std::size_t v = 0; v < shares.size(); ++v) {
      if (missing[v] <= 0) continue;
      shares[v] = std::max(kLeast, shares[v] - 0.5 * missing[v] / (whole[v] - from[v]).norm());
      changed |= missing[v] > kLeastMissing * room_;
    }
    // In each round: what gives way alone leaves its neighbours in what it went out of.
    smooth(shares);
    move();
    if (!changed) break;
  }
  lift(from, x);
}

}  // namespace weft::character
