#include "film/character/travel.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "film/character/pose.hpp"

namespace weft::character {
namespace {

/// Paths are smoothed over this time before and after each key [s]. A step of a person takes 0.4 to 0.7 s.
constexpr double kPathWindow = 0.6;
/// The velocities of the body that feet imply are smoothed over this time before and after each key [s], because they
/// jump when contacts begin and end.
constexpr double kFootWindow = 0.05;
/// Maximum height of the ball of a foot in stance above the lowest height of any ball in the clip [leg lengths].
constexpr double kMaxFootHeight = 0.05;
/// Minimum mean speed of feet in stance, relative to the body, that counts as a walk [leg lengths/s].
constexpr double kMinFeetSpeed = 0.1;

/// Key times of a clip and, if its last key is earlier, its end, so that the body can travel until then.
std::vector<double> travel_times(const Clip& clip) {
  std::vector<double> times = key_times(clip);
  if (clip.duration - times.back() > kSameTime) times.push_back(clip.duration);
  return times;
}

/// A clip, sampled at its keys.
class Path {
 public:
  Path(const Rig& rig, const Clip& clip, const Vec3& up)
      : rig_(rig), skeleton_(rig), clip_(clip), up_(up), times_(travel_times(clip)) {
    const std::vector<Index> moved = moved_nodes(rig, clip);
    const Index hips = rig.joints[joint_index(Joint::hips)];
    const Index middle = hips >= 0 ? hips : leading_node(rig.character, clip, moved);
    for (const double t : times_) {
      const Pose pose = pose_at(rig.character, clip, t);
      postures_.push_back(skeleton_.at(pose));
      middles_.push_back(Vec3::Zero());
      if (middle >= 0) middles_.back() = horizontal(global_transforms(rig.character, pose)[middle].translation());
    }
  }

  /// The nodes that translate a body: the hips or an ancestor of them, and other nodes that travel.
  static std::vector<Index> moved_nodes(const Rig& rig, const Clip& clip) {
    return traveling_nodes(rig.character, clip, rig.joints[joint_index(Joint::hips)]);
  }

  /// The clip, with `nodes` translated by a displacement at each key.
  Clip translate(const std::vector<Index>& nodes, const std::vector<Vec3>& by) const {
    Clip result = clip_;
    for (const Index node : nodes) translate_node(node, by, result);
    return result;
  }

  /// Displacements per key that remove the travel [m].
  std::vector<Vec3> displacements_in_place() const {
    std::vector<Vec3> by;
    const double window = std::min(kPathWindow, times_.back() / 2);
    for (const double t : times_) by.emplace_back(middles_.front() - smoothed(middles_, t, window));
    return by;
  }

  /// Displacements per key along the path that keeps feet in place, at the mean speed `speed` [m/s]. Writes the speed
  /// that the feet imply to `feet` [m/s]; 0 if it is too slow for a walk.
  std::vector<Vec3> displacements_at_speed(double speed, double& feet) const {
    std::vector<Vec3> velocities = implied_velocities();
    Vec3 mean = Vec3::Zero();
    for (std::size_t k = 0; k + 1 < times_.size(); ++k)
      mean += (times_[k + 1] - times_[k]) / times_.back() * (velocities[k] + velocities[k + 1]) / 2;
    feet = mean.norm();
    if (!(feet > kMinFeetSpeed * skeleton_.leg_length(postures_.front()))) {
      feet = 0;
      mean = Vec3::UnitY();
      velocities.assign(velocities.size(), mean);
    }
    std::vector<Vec3> by{Vec3::Zero()};
    for (std::size_t k = 0; k + 1 < times_.size(); ++k) {
      const Vec3 velocity = (heading(k) * velocities[k] + heading(k + 1) * velocities[k + 1]) / 2;
      by.emplace_back(by.back() + speed / mean.norm() * (times_[k + 1] - times_[k]) * velocity);
    }
    return by;
  }

 private:
  void translate_node(Index node, const std::vector<Vec3>& by, Clip& result) const {
    Curve<Vec3> position;
    for (std::size_t k = 0; k < times_.size(); ++k) {
      const Pose pose = pose_at(rig_.character, clip_, times_[k]);
      const Mat3 to_world = parent_transform(rig_.character, pose, node).linear();
      position.times.push_back(times_[k]);
      position.values.emplace_back(pose.nodes[node].position + to_world.inverse() * by[k]);
    }
    auto channel = std::ranges::find(result.channels, node, &Channel::node);
    if (channel == result.channels.end()) channel = result.channels.insert(channel, {node, {}, {}, {}});
    channel->position = std::move(position);
  }

  Vec3 horizontal(const Vec3& v) const { return v - v.dot(up_) * up_; }

  /// Axes of the body: left, ahead (both horizontal), and up.
  Mat3 heading(std::size_t k) const {
    const Posture& p = postures_[k];
    const Vec3 across = horizontal(skeleton_.across_hips(p).normalized() + skeleton_.across_shoulders(p).normalized());
    const Vec3 left = across.norm() > 0 ? Vec3(across.normalized()) : up_.unitOrthogonal();
    Mat3 axes;
    axes << left, left.cross(up_), up_;
    return axes;
  }

  /// Mean of a path over the times within `window` of t. Beyond its ends, the path is continued by point reflection at
  /// the end points.
  Vec3 smoothed(const std::vector<Vec3>& path, double t, double window) const {
    const auto at = [&](double s) -> Vec3 {
      const auto next = std::ranges::upper_bound(times_, s);
      if (next == times_.end()) return path.back();
      if (next == times_.begin()) return path.front();
      const auto k = static_cast<std::size_t>(next - times_.begin());
      const double fraction = (s - times_[k - 1]) / (times_[k] - times_[k - 1]);
      return (1 - fraction) * path[k - 1] + fraction * path[k];
    };
    const double end = times_.back();
    constexpr int kSamples = 32;
    Vec3 sum = Vec3::Zero();
    for (int i = -kSamples; i <= kSamples; ++i) {
      const double s = t + window * i / kSamples;
      sum += s < 0 ? Vec3(2 * path.front() - at(-s)) : s > end ? Vec3(2 * path.back() - at(2 * end - s)) : at(s);
    }
    return sum / (2 * kSamples + 1);
  }

  /// Velocities of the body per key that the feet in stance imply, in the axes of heading() [m/s].
  std::vector<Vec3> implied_velocities() const {
    std::array<Joint, 2> balls{};
    double floor = std::numeric_limits<double>::infinity();
    for (const bool right : {false, true}) {
      const Joint toes = on_side(Joint::left_toes, right), foot = on_side(Joint::left_foot, right);
      balls[right] = skeleton_.has(toes) ? toes : foot;
      for (const Posture& p : postures_)
        if (skeleton_.has(balls[right])) floor = std::min(floor, up_.dot(p.places[joint_index(balls[right])]));
    }
    const double low = kMaxFootHeight * skeleton_.leg_length(postures_.front());
    std::vector<double> weights(times_.size(), 0);
    std::vector<Vec3> velocities(times_.size(), Vec3::Zero());
    for (const Joint ball : balls) {
      if (!skeleton_.has(ball) || low <= 0) continue;
      for (std::size_t k = 0; k < times_.size(); ++k) {
        const std::size_t a = k > 0 ? k - 1 : k, b = std::min(k + 1, times_.size() - 1);
        const Vec3 &from = postures_[a].places[joint_index(ball)], &to = postures_[b].places[joint_index(ball)];
        const double weight = 1 - (up_.dot(postures_[k].places[joint_index(ball)]) - floor) / low;
        if (weight <= 0 || a == b) continue;
        weights[k] += weight;
        velocities[k] -= weight / (times_[b] - times_[a]) * (heading(k).transpose() * horizontal(to - from));
      }
    }
    // At keys without a contact, the velocity is interpolated.
    std::size_t known = times_.size();
    for (std::size_t k = 0; k < times_.size(); ++k) {
      if (weights[k] == 0) continue;
      velocities[k] /= weights[k];
      const Vec3 first = known < times_.size() ? velocities[known] : velocities[k];
      const std::size_t begin = known < times_.size() ? known + 1 : 0;
      for (std::size_t i = begin; i < k; ++i)
        velocities[i] =
            first + static_cast<double>(i - begin + 1) / static_cast<double>(k - begin + 1) * (velocities[k] - first);
      known = k;
    }
    for (std::size_t k = known + 1; k < times_.size(); ++k) velocities[k] = velocities[known];
    std::vector<Vec3> smooth;
    for (const double t : times_) smooth.push_back(smoothed(velocities, t, std::min(kFootWindow, times_.back() / 2)));
    return smooth;
  }

  const Rig& rig_;
  const Skeleton skeleton_;
  const Clip& clip_;
  const Vec3 up_;
  const std::vector<double> times_;
  std::vector<Posture> postures_;
  std::vector<Vec3> middles_;  // horizontal positions of the hips; without hips, of leading_node()
};

}  // namespace

Clip remove_travel(const Rig& rig, const Clip& clip, const Vec3& up) {
  const Path path(rig, clip, up);
  return path.translate(Path::moved_nodes(rig, clip), path.displacements_in_place());
}

TravelResult set_travel_speed(const Rig& rig, const Clip& clip, double speed, const Vec3& up) {
  const Clip still = remove_travel(rig, clip, up);
  const Path path(rig, still, up);
  TravelResult result;
  const std::vector<Vec3> by = path.displacements_at_speed(speed, result.feet);
  result.clip = path.translate(Path::moved_nodes(rig, clip), by);  // `still` may have fewer such nodes
  return result;
}

}  // namespace weft::character
