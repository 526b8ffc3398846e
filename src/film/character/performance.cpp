#include "film/character/performance.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace weft::character {
namespace {

/// Time over which key_rate() counts keys [s]: a fast movement, such as a kick, takes about this time.
constexpr double kRateWindow = 0.25;

}  // namespace

double clip_time(const Timing& timing, double t) {
  const double elapsed = t - timing.motion_start;
  if (elapsed <= 0) return timing.start;
  if (elapsed >= timing.blend) return timing.start + timing.speed * (elapsed - timing.blend / 2);
  // The integral of ease(): the speed rises smoothly from 0.
  const double u = elapsed / timing.blend;
  return timing.start + timing.speed * timing.blend * (u * u * u * (1 - u / 2));
}

Performance::Performance(const Character& character, const Clip& clip, const Playing& playing, const Vec3& up)
    : character_(character), clip_(clip), playing_(playing), up_(up) {
  roots_ = traveling_nodes(character, clip);
  leading_ = leading_node(character, clip, roots_);
  const double fade = std::min(playing.crossfade, clip.duration / 2);
  playing_.crossfade = fade;
  period_ = clip.duration - fade;
  if (playing.loop)
    travel_ = displacement_between(pose_at(character, clip, fade / 2), pose_at(character, clip, period_ + fade / 2));
  if (playing.stance) shift_ = displacement_between(at_clip_time(playing.timing.start), *playing.stance);
}

Vec3 Performance::displacement_between(const Pose& a, const Pose& b) const {
  if (leading_ < 0) return Vec3::Zero();
  const Index node = leading_;
  const Affine parent_a = parent_transform(character_, a, node), parent_b = parent_transform(character_, b, node);
  // The last two terms are exactly 0 if the nodes above this one do not move.
  const Vec3 whole = parent_a.linear() * (b.nodes[node].position - a.nodes[node].position) +
                     (parent_b.linear() - parent_a.linear()) * b.nodes[node].position +
                     (parent_b.translation() - parent_a.translation());
  return whole - whole.dot(up_) * up_;
}

void Performance::translate(Pose& pose, const Vec3& by) const {
  for (const Index node : roots_) {
    const Vec3 local = parent_transform(character_, pose, node).linear().inverse() * by;
    if (local.allFinite()) pose.nodes[node].position += local;  // it is infinite if an ancestor has the scale 0
  }
}

Pose Performance::at_clip_time(double t) const {
  if (!playing_.loop || period_ <= 0) return pose_at(character_, clip_, t);
  const double round = std::floor(t / period_), round_time = t - round * period_;
  Pose pose = pose_at(character_, clip_, round_time);
  translate(pose, round * travel_);
  if (round >= 1 && round_time < playing_.crossfade) {
    Pose last = pose_at(character_, clip_, period_ + round_time);
    translate(last, (round - 1) * travel_);
    pose = blend(last, pose, ease(round_time / playing_.crossfade));
  }
  return pose;
}

Pose Performance::at(double t) const {
  const Timing& timing = playing_.timing;
  if (playing_.stance && t <= timing.motion_start) return *playing_.stance;
  Pose pose = at_clip_time(clip_time(timing, t));
  translate(pose, shift_);
  if (playing_.stance && t < timing.motion_start + timing.blend)
    pose = blend(*playing_.stance, pose, ease((t - timing.motion_start) / timing.blend));
  return pose;
}

double Performance::gap() const {
  if (!playing_.loop || playing_.crossfade > 0) return 0;
  std::vector<Vec3> end(character_.mesh.positions.size()), begin(end.size());
  Pose next = pose_at(character_, clip_, 0);
  translate(next, travel_);
  skin(character_, pose_at(character_, clip_, clip_.duration), end);
  skin(character_, next, begin);
  double gap = 0;
  for (std::size_t v = 0; v < end.size(); ++v) gap = std::max(gap, (end[v] - begin[v]).norm());
  return gap;
}

double key_rate(const Clip& clip) {
  if (!(clip.duration > 0)) return 0;
  double rate = 0;
  const auto add = [&](const std::vector<double>& times) {
    if (times.empty()) return;
    rate = std::max(rate, static_cast<double>(times.size() - 1) / clip.duration);
    std::size_t first = 0;
    for (std::size_t last = 0; last < times.size(); ++last) {
      // Excludes windows of exactly this length, so that rounding does not change the rate of even keys.
      while (times[last] - times[first] > kRateWindow - kSameTime) ++first;
      rate = std::max(rate, static_cast<double>(last - first) / kRateWindow);
    }
  };
  for (const Channel& channel : clip.channels)
    for (const auto* times : {&channel.position.times, &channel.rotation.times, &channel.scale.times}) add(*times);
  for (const MorphChannel& channel : clip.morphs) add(channel.weight.times);
  return rate;
}

}  // namespace weft::character
