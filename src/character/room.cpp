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

/// Each of two limbs gives at most this fraction of what is missing between them.
constexpr double kGivenByEach = 0.5;

/// Least fraction of the way from bone to skin that is left of a limb: with less it looks deflated.
constexpr double kLeast = 0.5;

/// Skin without cloth nearby moves by at most so much along with its neighbours [m]; 5 mm are seen.
constexpr double kUnseen = 0.004;

/// Skin near cloth moves by at most so much, or twice the room [m]: what goes deeper into another limb is not opened
/// up, for that would be seen.
constexpr double kMostMove = 0.03;

/// Skin without cloth of its own that is deeper in the other limb than this has no cloth near it [m].
constexpr double kNearDepth = 0.05;

/// Over edges up to this length skin takes its neighbours along whole; over longer ones by less, so that a dent in a
/// body of few triangles stays as narrow [m].
constexpr double kWholeEdge = 0.02;

/// The limb of each joint, in the order of joints: the trunk with neck, head and shoulders is one limb, hands belong to
/// lower arms, feet to lower legs. What moves at a wrist or an ankle is too thin to lose anything.
constexpr std::array<std::uint8_t, kJointCount> kLimbOf = {0, 0, 0, 0, 0, 0, 1, 2, 2, 3, 4,
                                                           4, 4, 0, 5, 6, 6, 7, 8, 8, 8};
constexpr std::array<const char*, 9> kLimbNames = {"trunk",           "left upper arm",  "left lower arm",
                                                   "left upper leg",  "left lower leg",  "right upper arm",
                                                   "right lower arm", "right upper leg", "right lower leg"};

const char* name_of(const Room::Shares& shares) {
  return kLimbNames[static_cast<std::size_t>(std::ranges::max_element(shares) - shares.begin())];
}

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

Room::Room(const Rig& rig, const VertexMask& touched, std::vector<float> near_cloth, double room,
           std::vector<Ground> grounds)
    : room_(room),
      grounds_(std::move(grounds)),
      shares_(shares_of_limbs(rig)),
      near_(std::move(near_cloth)),
      touched_(touched),
      foot_(vertices_of(rig.character, rig.joints, joints_of_part("feet"))) {
  for (const mesh::Triangle& t : rig.character.mesh.topology.triangles) {
    if (std::ranges::any_of(t, [&](Index v) { return touched_[v] == 0; })) continue;
    triangles_.push_back(t);
    near_of_triangle_.push_back(std::min({near_[t[0]], near_[t[1]], near_[t[2]]}));
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
  std::vector<Missing> missing(touched_.size());
  find_missing(places, skinned, skinned, missing);
  for (std::size_t v = 0; v < missing.size(); ++v) missing_at_rest_[v] = missing[v].distance;
}

// How much of the way from the bone through the skin, to the room beyond it, is in another limb. `skin`: where the
// lines go, x: where the skin is now.
void Room::find_missing(std::span<const Vec3> from, std::span<const Vec3> skin, std::span<const Vec3> x,
                        std::vector<Missing>& missing) const {
  Box3 box;
  for (const mesh::Triangle& t : triangles_) box.extend(x[t[0]]);
  if (triangles_.empty()) return;
  const mesh::TriangleGrid grid(triangles_, x, box.diagonal().maxCoeff() / kCells);
  parallel_for(touched_.size(), kLinesPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      missing[v] = {};
      const double length = (skin[v] - from[v]).norm();
      // More than the room is missing at rest where limbs cross there, as plates of armour do by design.
      if (touched_[v] == 0 || !(length > 0) || missing_at_rest_[v] > room_) continue;
      const Vec3 to = x[v] + room_ / length * (skin[v] - from[v]);
      const mesh::Entry entry = grid.first_entry(
          from[v], to, [&](Index t) { return difference(shares_of_triangle_[t], shares_[v]) > kOther; });
      if (entry.triangle < 0) continue;
      const double all = (1 - entry.t) * (to - from[v]).norm();
      const double shallow = std::clamp(2 - 2 * (all - room_) / kNearDepth, 0.0, 1.0);
      missing[v] = {std::max(0.0, all - missing_at_rest_[v]),
                    std::max(near_[v], static_cast<float>(shallow) * near_of_triangle_[entry.triangle]),
                    entry.triangle};
    }
  });
}

// Each vertex gives way at least as far as its neighbours in the mean, but hardly where no cloth is near.
void Room::smooth(std::span<const double> lengths, std::vector<double>& shares) const {
  std::vector<double> sums(shares.size()), counts(shares.size());
  for (int round = 0; round < kSmoothings; ++round) {
    std::ranges::fill(sums, 0);
    std::ranges::fill(counts, 0);
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      const auto [a, b] = edges_[e];
      const double along = std::min(1.0, kWholeEdge / lengths[e]);
      sums[a] += along * (1 - shares[b]), sums[b] += along * (1 - shares[a]);
      ++counts[a], ++counts[b];
    }
    for (std::size_t v = 0; v < shares.size(); ++v)
      if (counts[v] > 0) shares[v] = std::min(shares[v], 1 - sums[v] / counts[v]);
  }
}

// Limbs whose bones are in the ground stay there: they are meant to, or nothing helps.
void Room::lift(std::span<const Vec3> from, std::span<Vec3> x) const {
  for (const Ground& ground : grounds_)
    for (std::size_t v = 0; v < touched_.size(); ++v) {
      if (touched_[v] == 0 || foot_[v] != 0 || near_[v] <= 0) continue;
      const double missing = ground.height + kAboveGround * room_ - ground.up.dot(x[v]);
      const double held = std::clamp((ground.up.dot(from[v]) - ground.height) / room_, 0.0, 1.0);
      if (missing > 0) x[v] += static_cast<double>(near_[v]) * held * missing * ground.up;
    }
}

Moved Room::farthest(std::span<const Vec3> before, std::span<const Vec3> x, std::span<const Index> other) const {
  Moved moved;
  for (std::size_t v = 0; v < before.size(); ++v) {
    const double distance = (x[v] - before[v]).norm();
    if (distance > moved.distance) moved.distance = distance, moved.vertex = static_cast<Index>(v);
  }
  if (moved.vertex < 0) return moved;
  moved.limb = name_of(shares_[moved.vertex]);
  const Index triangle = other[moved.vertex];
  moved.away_from = triangle < 0 ? "the ground" : name_of(shares_of_triangle_[triangle]);
  return moved;
}

Moved Room::make(const Pose& pose, std::span<Vec3> x) const {
  const std::vector<Vec3> whole(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(touched_.size()));
  std::vector<Vec3> from(touched_.size());
  skin(bones_, {pose.nodes, {}}, from);
  std::vector<double> lengths;
  for (const auto& [a, b] : edges_) lengths.push_back((whole[a] - whole[b]).norm());
  std::vector<double> shares(touched_.size(), 1);
  std::vector<double> given(touched_.size(), 0);  // most that each vertex may give of its own [m]
  std::vector<float> near = near_;
  std::vector<Index> other(touched_.size(), -1);
  std::vector<Missing> missing(touched_.size());
  for (int round = 0; round < kYieldingRounds; ++round) {
    find_missing(from, whole, x, missing);
    bool changed = false;
    for (std::size_t v = 0; v < shares.size(); ++v) {
      if (missing[v].distance <= 0 || missing[v].near <= 0) continue;
      if (other[v] < 0) other[v] = missing[v].triangle;
      near[v] = std::max(near[v], missing[v].near);
      given[v] = std::max(given[v], kGivenByEach * static_cast<double>(missing[v].near) * missing[v].distance);
      const double length = (whole[v] - from[v]).norm(), before = shares[v];
      const double least = std::max(kLeast, 1 - given[v] / length);
      shares[v] = std::min(before, std::max(least, before - kGivenByEach * missing[v].distance / length));
      changed |= (before - shares[v]) * length > kLeastMissing * room_;
    }
    // In each round: what gives way alone leaves its neighbours in what it went out of.
    smooth(lengths, shares);
    for (std::size_t v = 0; v < shares.size(); ++v) {
      if (!(shares[v] < 1)) continue;
      const double most = std::lerp(kUnseen, std::max(kMostMove, 2 * room_), static_cast<double>(near[v]));
      shares[v] = std::max({shares[v], kLeast, 1 - most / (whole[v] - from[v]).norm()});
      x[v] = from[v] + shares[v] * (whole[v] - from[v]);
    }
    if (!changed) break;
  }
  lift(from, x);
  return farthest(whole, x, other);
}

}  // namespace weft::character
