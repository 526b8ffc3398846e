#include "film/character/pose.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "core/parallel.hpp"

namespace weft::character {
namespace {

/// Vertices per parallel task. A task takes some hundred microseconds.
constexpr std::size_t kVerticesPerTask = 2048;

template <class Value>
Value interpolate(const Value& a, const Value& b, double weight) {
  return a + weight * (b - a);
}
Quat interpolate(const Quat& a, const Quat& b, double weight) {
  return a.slerp(weight, b);
}

/// Value of a curve at the time t [s]. The curve must have at least one key.
template <class Value>
Value value_at(const Curve<Value>& curve, double t) {
  const auto after = std::upper_bound(curve.times.begin(), curve.times.end(), t);
  if (after == curve.times.begin()) return curve.values.front();
  if (after == curve.times.end()) return curve.values.back();
  const auto k = static_cast<std::size_t>(after - curve.times.begin());
  const double weight = (t - curve.times[k - 1]) / (curve.times[k] - curve.times[k - 1]);
  return interpolate(curve.values[k - 1], curve.values[k], weight);
}

/// The rotation of a linear map, by the Gram-Schmidt process on its columns. Mirroring remains in the stretch.
Mat3 rotation_of(const Mat3& linear) {
  Vec3 x = linear.col(0), y = linear.col(1);
  const double length = std::max({linear.col(0).norm(), linear.col(1).norm(), linear.col(2).norm()});
  // A map that is singular along an axis has no unique rotation.
  if (!(x.norm() > 1e-9 * length) || !(x.cross(y).norm() > 1e-9 * x.norm() * length)) return Mat3::Identity();
  x.normalize();
  y = (y - y.dot(x) * x).normalized();
  Mat3 rotation;
  rotation << x, y, x.cross(y);
  return rotation;
}

bool changes_position(const Channel& channel) {
  const std::vector<Vec3>& places = channel.position.values;
  return std::ranges::any_of(places, [&](const Vec3& x) { return x != places.front(); });
}

}  // namespace

Affine Placement::to_affine() const {
  Affine map;
  map.linear() = rotation.toRotationMatrix() * stretch;
  map.translation() = position;
  map.makeAffine();
  return map;
}

Placement to_placement(const Affine& map) {
  const Mat3 rotation = rotation_of(map.linear());
  return {map.translation(), Quat(rotation).normalized(), rotation.transpose() * map.linear()};
}

Pose rest_pose(const Character& character) {
  Pose pose;
  for (const Node& node : character.nodes) pose.nodes.push_back(to_placement(node.local));
  for (const MorphTarget& target : character.morphs) pose.morphs.push_back(target.weight);
  return pose;
}

Pose pose_at(const Character& character, const Clip& clip, double t) {
  Pose pose = rest_pose(character);
  for (const Channel& channel : clip.channels) {
    Placement& node = pose.nodes[channel.node];
    if (!channel.position.times.empty()) node.position = value_at(channel.position, t);
    if (!channel.rotation.times.empty()) node.rotation = value_at(channel.rotation, t).normalized();
    if (channel.scale.times.empty()) continue;
    const Vec3 signs = channel.scale.values.front().unaryExpr([](double x) { return x < 0 ? -1.0 : 1.0; });
    const bool mirrors = signs != Vec3::Ones();
    // rest_pose() turns negative scales into a rotation, a mirroring or both. The clip has the same scales, so that
    // only the rotation of the map without them may act.
    if (mirrors && channel.rotation.times.empty())
      node.rotation = Quat(rotation_of(character.nodes[channel.node].local.linear() * signs.asDiagonal())).normalized();
    node.stretch = value_at(channel.scale, t).asDiagonal();
    if (mirrors) node = to_placement(node.to_affine());  // as at rest, so that both poses can be blended
  }
  for (const MorphChannel& channel : clip.morphs)
    if (!channel.weight.times.empty()) pose.morphs[channel.target] = value_at(channel.weight, t);
  return pose;
}

std::vector<double> key_times(const Clip& clip) {
  std::vector<double> times{0};
  for (const Channel& channel : clip.channels) {
    times.insert(times.end(), channel.rotation.times.begin(), channel.rotation.times.end());
    times.insert(times.end(), channel.position.times.begin(), channel.position.times.end());
  }
  std::sort(times.begin(), times.end());
  std::vector<double> distinct;
  for (const double t : times)
    if (t >= 0 && (distinct.empty() || t - distinct.back() > kSameTime)) distinct.push_back(t);
  return distinct;
}

std::vector<Index> traveling_nodes(const Character& character, const Clip& clip, Index also) {
  std::vector<std::uint8_t> travels(character.nodes.size(), 0);
  if (also >= 0) travels[also] = 1;
  for (const Channel& channel : clip.channels)
    if (changes_position(channel)) travels[channel.node] = 1;
  std::vector<Index> uppermost;
  for (std::size_t n = 0; n < travels.size(); ++n) {
    const Index parent = character.nodes[n].parent;
    const bool is_carried = parent >= 0 && travels[parent] != 0;
    if (travels[n] != 0 && !is_carried) uppermost.push_back(static_cast<Index>(n));
    if (is_carried) travels[n] = 1;
  }
  return uppermost;
}

Index leading_node(const Character& character, const Clip& clip, std::span<const Index> traveling) {
  if (traveling.empty()) return -1;
  // Per node: weight of the skin on it and on the nodes below it.
  std::vector<double> carried(character.nodes.size(), 0);
  for (const Influence& influence : character.influences)
    carried[character.bones[influence.bone].node] += influence.weight;
  for (std::size_t n = carried.size(); n-- > 0;)
    if (const Index parent = character.nodes[n].parent; parent >= 0) carried[parent] += carried[n];
  const Index top = *std::ranges::max_element(traveling, {}, [&](Index n) { return carried[n]; });
  Index leading = top;
  if (!(carried[top] > 0)) return leading;
  const auto is_below_top = [&](Index node) {
    while (node > top) node = character.nodes[node].parent;  // parents precede their children
    return node == top;
  };
  for (const Channel& channel : clip.channels)
    if (channel.node > leading && carried[channel.node] == carried[top] && is_below_top(channel.node) &&
        changes_position(channel))
      leading = channel.node;
  return leading;
}

Pose blend(const Pose& a, const Pose& b, double weight) {
  Pose pose = a;
  for (std::size_t n = 0; n < pose.nodes.size(); ++n) {
    Placement& node = pose.nodes[n];
    node.position = interpolate(node.position, b.nodes[n].position, weight);
    node.rotation = interpolate(node.rotation, b.nodes[n].rotation, weight).normalized();
    node.stretch += weight * (b.nodes[n].stretch - node.stretch);
  }
  for (std::size_t m = 0; m < pose.morphs.size(); ++m)
    pose.morphs[m] = interpolate(pose.morphs[m], b.morphs[m], weight);
  return pose;
}

Quat shortest_rotation(const Vec3& from, const Vec3& to) {
  const Vec3 a = from.normalized(), b = to.normalized();
  const double cosine = b.dot(a);
  Quat rotation;
  if (cosine < -1 + 1e-12) {  // the cross product consists of rounding errors only
    rotation.w() = 0;
    rotation.vec() = a.unitOrthogonal();
  } else {
    const double twice_w = std::sqrt(2 * (1 + cosine));
    rotation.w() = 0.5 * twice_w;
    rotation.vec() = a.cross(b) * (1 / twice_w);
  }
  return rotation;
}

std::vector<Affine> global_transforms(const Character& character, const Pose& pose) {
  std::vector<Affine> globals;
  globals.reserve(pose.nodes.size());
  for (std::size_t n = 0; n < pose.nodes.size(); ++n) {
    const Index parent = character.nodes[n].parent;
    const Affine local = pose.nodes[n].to_affine();
    globals.push_back(parent < 0 ? local : globals[parent] * local);
  }
  return globals;
}

Affine parent_transform(const Character& character, const Pose& pose, Index node) {
  const Index parent = character.nodes[node].parent;
  return parent < 0 ? Affine::Identity() : global_transforms(character, pose)[parent];
}

void skin(const Character& character, const Pose& pose, std::span<Vec3> out) {
  using Map = Eigen::Matrix<double, 3, 4>;
  const std::vector<Affine> globals = global_transforms(character, pose);
  std::vector<Map> bones;
  for (const Bone& bone : character.bones) bones.push_back((globals[bone.node] * bone.offset).matrix().topRows<3>());
  parallel_for(out.size(), kVerticesPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      Vec3 shape = character.mesh.positions[v];
      for (std::size_t m = 0; m < pose.morphs.size(); ++m)
        if (pose.morphs[m] != 0) shape += pose.morphs[m] * character.morphs[m].displacements[v];
      Map map = Map::Zero();
      for (auto i = static_cast<std::size_t>(character.first_influence[v]);
           i < static_cast<std::size_t>(character.first_influence[v + 1]); ++i)
        map += character.influences[i].weight * bones[character.influences[i].bone];
      out[v] = map * shape.homogeneous();
    }
  });
}

}  // namespace weft::character
