#include "film/assets/clip_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <span>
#include <stdexcept>

#include "film/assets/import.hpp"

namespace weft::assets {
namespace {

/// Ticks per second of files that do not state them. This is the default in the documentation of assimp.
constexpr double kDefaultTicksPerSecond = 25;

/// Maximum length of a clip [s]. Files with longer clips count as damaged.
constexpr double kMaxClipLength = 86400;

/// There is no warning for keys that are after the end of a clip by less than this fraction of its length, because this
/// is only a rounding error.
constexpr double kEndSlack = 1e-4;

Vec3 to_value(const aiVector3D& v) {
  return {v.x, v.y, v.z};
}
Quat to_value(const aiQuaternion& q) {
  return {q.w, q.x, q.y, q.z};
}
bool is_usable(const Vec3& v) {
  return v.allFinite();
}
bool is_usable(const Quat& q) {
  return q.coeffs().allFinite() && q.norm() > 1e-6;
}
/// Makes a rotation a unit quaternion. Returns vectors unchanged.
Vec3 normalise_if_rotation(const Vec3& v) {
  return v;
}
Quat normalise_if_rotation(const Quat& q) {
  return q.normalized();
}

/// Converts the channels of one animation.
struct ClipReader {
  const aiAnimation& animation;
  std::string name;
  double ticks_per_second = kDefaultTicksPerSecond;
  double last_key = 0;         // latest key time so far [s]
  std::string last_channel{};  // channel of the key at `last_key`

  [[noreturn]] void fail(const std::string& channel, const std::string& why) const {
    throw std::runtime_error(fmt::format("clip \"{}\", channel \"{}\": {}", name, channel, why));
  }

  double to_seconds(double ticks, const std::string& channel) {
    const double t = ticks / ticks_per_second;
    if (!(std::abs(t) < kMaxClipLength))
      fail(channel,
           fmt::format("expected key times within a day, got {:g} ticks of {:g} a second", ticks, ticks_per_second));
    if (t > last_key) {
      last_key = t;
      last_channel = channel;
    }
    return t;
  }

  /// Appends a key. If there are several keys at the same time, the last one counts.
  template <class Value>
  void append(character::Curve<Value>& curve, double t, const Value& value, const std::string& channel) const {
    if (!curve.times.empty() && t < curve.times.back())
      fail(channel, fmt::format("expected key times that increase, got {:g} s after {:g} s", t, curve.times.back()));
    if (!curve.times.empty() && t == curve.times.back()) {
      curve.values.back() = value;
      return;
    }
    curve.times.push_back(t);
    curve.values.push_back(value);
  }

  template <class Value, class Key>
  character::Curve<Value> to_curve(std::span<Key> keys, const std::string& channel) {
    character::Curve<Value> curve;
    for (const Key& key : keys) {
      const Value value = to_value(key.mValue);
      const double t = to_seconds(key.mTime, channel);
      if (!is_usable(value)) fail(channel, fmt::format("the key at {:g} s {}", t, kNotFinite));
      append(curve, t, normalise_if_rotation(value), channel);
    }
    return curve;
  }

  character::Channel to_channel(const aiNodeAnim& from, Index node) {
    const std::string channel = from.mNodeName.C_Str();
    return {node, to_curve<Vec3>(std::span(from.mPositionKeys, from.mNumPositionKeys), channel),
            to_curve<Quat>(std::span(from.mRotationKeys, from.mNumRotationKeys), channel),
            to_curve<Vec3>(std::span(from.mScalingKeys, from.mNumScalingKeys), channel)};
  }

  /// Reads the weights of morph targets. Each key lists targets and their weights.
  void read_morphs(const aiMeshMorphAnim& from, const ClipTargets::Morphs& targets, character::Clip& clip) {
    const std::string channel = from.mName.C_Str();
    std::vector<character::MorphChannel> channels(static_cast<std::size_t>(targets.count));
    for (const aiMeshMorphKey& key : std::span(from.mKeys, from.mNumKeys)) {
      const double t = to_seconds(key.mTime, channel);
      for (unsigned k = 0; k < key.mNumValuesAndWeights; ++k) {
        const unsigned target = key.mValues[k];
        if (target >= channels.size())
          fail(channel, fmt::format("expected one of {} morph targets, got number {}", channels.size(), target));
        if (!std::isfinite(key.mWeights[k])) fail(channel, fmt::format("a weight of a morph target {}", kNotFinite));
        append(channels[target].weight, t, key.mWeights[k], channel);
      }
    }
    for (std::size_t k = 0; k < channels.size(); ++k) {
      channels[k].target = targets.first + static_cast<Index>(k);
      if (!channels[k].weight.times.empty()) clip.morphs.push_back(std::move(channels[k]));
    }
  }
};

/// Above some FBX nodes, assimp inserts a chain of helper nodes, which it names after the node. Each helper has a part
/// of the node's transform. If a channel has keys for both position and rotation of such a node, it contains the whole
/// transform. Then gives the helpers without a channel identity channels, so that no part of the transform applies
/// twice.
void add_identity_channels(const aiNodeAnim& from, const ClipTargets& targets, std::set<Index>& moved,
                           character::Clip& clip) {
  if (from.mNumPositionKeys == 0 || from.mNumRotationKeys == 0) return;
  const std::string start = std::string(from.mNodeName.C_Str()) + "_$AssimpFbx$_";
  for (auto helper = targets.nodes.lower_bound(start);
       helper != targets.nodes.end() && helper->first.starts_with(start); ++helper)
    if (moved.insert(helper->second).second)
      clip.channels.push_back(
          {helper->second, {{0}, {Vec3::Zero()}}, {{0}, {Quat::Identity()}}, {{0}, {Vec3::Ones()}}});
}

/// Removes the suffix ("*0", "*1") that assimp appends to the name of a mesh if it splits the mesh into parts.
std::string plain_name(const std::string& name) {
  return name.substr(0, name.find('*'));
}

}  // namespace

character::Clip to_clip(const aiAnimation& animation, const ClipTargets& targets, std::vector<std::string>& warnings) {
  ClipReader reader{.animation = animation, .name = animation.mName.C_Str()};
  character::Clip clip;
  clip.name = reader.name;
  if (std::isfinite(animation.mTicksPerSecond) && animation.mTicksPerSecond > 0)
    reader.ticks_per_second = animation.mTicksPerSecond;
  else if (animation.mTicksPerSecond != 0)  // 0: not stated
    warnings.push_back(
        fmt::format("clip \"{}\": expected a time > 0 s for each frame, got {:g} s; {:g} frames a second "
                    "are assumed",
                    clip.name, 1 / animation.mTicksPerSecond, kDefaultTicksPerSecond));

  std::vector<std::string> unknown_nodes;
  std::set<Index> moved;
  for (const aiNodeAnim* channel : std::span(animation.mChannels, animation.mNumChannels)) {
    const auto node = targets.nodes.find(channel->mNodeName.C_Str());
    if (node == targets.nodes.end()) {
      unknown_nodes.push_back(channel->mNodeName.C_Str());
    } else if (moved.insert(node->second).second) {
      clip.channels.push_back(reader.to_channel(*channel, node->second));
    } else {
      warnings.push_back(fmt::format("clip \"{}\": several channels for node \"{}\"; the first counts", clip.name,
                                     channel->mNodeName.C_Str()));
    }
  }
  for (const aiNodeAnim* channel : std::span(animation.mChannels, animation.mNumChannels))
    add_identity_channels(*channel, targets, moved, clip);
  for (const aiMeshMorphAnim* channel : std::span(animation.mMorphMeshChannels, animation.mNumMorphMeshChannels)) {
    const std::string mesh = plain_name(channel->mName.C_Str());
    const auto [begin, end] = targets.morphs.equal_range(mesh);
    if (begin == end && !targets.left_out.contains(mesh)) unknown_nodes.push_back(channel->mName.C_Str());
    for (auto found = begin; found != end; ++found) reader.read_morphs(*channel, found->second, clip);
  }
  if (!unknown_nodes.empty())
    warnings.push_back(fmt::format("clip \"{}\": {} channel{} left out, which name no part of the file: \"{}\"{}",
                                   clip.name, unknown_nodes.size(), unknown_nodes.size() == 1 ? "" : "s",
                                   unknown_nodes.front(), unknown_nodes.size() == 1 ? "" : ", ..."));

  clip.duration = std::isfinite(animation.mDuration) ? std::max(0.0, animation.mDuration / reader.ticks_per_second) : 0;
  if (!(clip.duration < kMaxClipLength))
    throw std::runtime_error(
        fmt::format("clip \"{}\": expected a clip shorter than a day, got {:g} s", clip.name, clip.duration));
  if (reader.last_key > clip.duration) {
    if (clip.duration > 0 && reader.last_key > (1 + kEndSlack) * clip.duration)
      warnings.push_back(
          fmt::format("clip \"{}\", channel \"{}\": its last key, at {:g} s, is past the end at {:g} s; "
                      "the clip is taken to be that long",
                      clip.name, reader.last_channel, reader.last_key, clip.duration));
    clip.duration = reader.last_key;
  }
  return clip;
}

}  // namespace weft::assets
