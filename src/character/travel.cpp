#include "character/travel.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "character/pose.hpp"

namespace weft::character {
namespace {

/// Time to either side over which paths are smoothed: people take a step in 0.4 to 0.7 s [s].
constexpr double kStep = 0.6;
/// And speeds of feet, whose contacts come and go [s].
constexpr double kFootWindow = 0.05;
/// Balls of feet lower than this above the lowest one carry the body [legs].
constexpr double kLowFoot = 0.05;
/// Feet that pass more slowly do not walk [legs/s].
constexpr double kWalks = 0.1;

/// A clip at its keys.
class Path {
 public:
  Path(const Rig& rig, const Clip& clip, const Vec3& up)
      : rig_(rig), skeleton_(rig), clip_(clip), up_(up), times_(key_times(clip)) {
    const Index hips = rig.joints[place_of(Joint::hips)], middle = hips >= 0 ? hips : traveling_node(clip);
    for (const double t : times_) {
      const Pose pose = pose_at(rig.character, clip, t);
      postures_.push_back(skeleton_.at(pose));
      middles_.push_back(Vec3::Zero());
      if (middle >= 0) middles_.back() = level(global_transforms(rig.character, pose)[middle].translation());
    }
  }

  /// The clip moved by a displacement at each key.
  Clip moved(const std::vector<Vec3>& by) const {
    Index node = traveling_node(clip_);
    if (node < 0) node = rig_.joints[place_of(Joint::hips)];
    if (node < 0) return clip_;
    const Index parent = rig_.character.nodes[node].parent;
    Curve<Vec3> position;
    for (std::size_t k = 0; k < times_.size(); ++k) {
      const Pose pose = pose_at(rig_.character, clip_, times_[k]);
      Mat3 to_world = Mat3::Identity();
      if (parent >= 0) to_world = global_transforms(rig_.character, pose)[parent].linear();
      position.times.push_back(times_[k]);
      position.values.emplace_back(pose.nodes[node].position + to_world.inverse() * by[k]);
    }
    Clip result = clip_;
    auto channel = std::ranges::find(result.channels, node, &Channel::node);
    if (channel == result.channels.end()) channel = result.channels.insert(channel, {node, {}, {}, {}});
    channel->position = std::move(position);
    return result;
  }

  /// What takes the way out.
  std::vector<Vec3> back() const {
    std::vector<Vec3> by;
    const double window = std::min(kStep, times_.back() / 2);
    for (const double t : times_) by.emplace_back(middles_.front() - smoothed(middles_, t, window));
    return by;
  }

  /// What puts on the way that keeps feet in place, at a speed in the mean, and the speed that the feet ask for.
  std::vector<Vec3> ahead(double speed, double& feet) const {
    std::vector<Vec3> ways = steps();
    Vec3 mean = Vec3::Zero();
    for (std::size_t k = 0; k + 1 < times_.size(); ++k)
      mean += (times_[k + 1] - times_[k]) / times_.back() * (ways[k] + ways[k + 1]) / 2;
    feet = mean.norm();
    if (!(feet > kWalks * skeleton_.leg_length(postures_.front()))) {
      feet = 0;
      mean = Vec3::UnitY();
      ways.assign(ways.size(), mean);
    }
    std::vector<Vec3> by{Vec3::Zero()};
    for (std::size_t k = 0; k + 1 < times_.size(); ++k) {
      const Vec3 way = (heading(k) * ways[k] + heading(k + 1) * ways[k + 1]) / 2;
      by.emplace_back(by.back() + speed / mean.norm() * (times_[k + 1] - times_[k]) * way);
    }
    return by;
  }

 private:
  Vec3 level(const Vec3& v) const { return v - v.dot(up_) * up_; }

  /// To the left, ahead and up, of the body, level.
  Mat3 heading(std::size_t k) const {
    const Posture& p = postures_[k];
    const Vec3 across = level(skeleton_.across_hips(p).normalized() + skeleton_.across_shoulders(p).normalized());
    const Vec3 left = across.norm() > 0 ? Vec3(across.normalized()) : up_.unitOrthogonal();
    Mat3 axes;
    axes << left, left.cross(up_), up_;
    return axes;
  }

  /// The mean over a window about t; beyond its ends a path goes on turned by half a turn about them.
  Vec3 smoothed(const std::vector<Vec3>& path, double t, double window) const {
    const auto at = [&](double s) -> Vec3 {
      const auto next = std::ranges::upper_bound(times_, s);
      if (next == times_.end()) return path.back();
      if (next == times_.begin()) return path.front();
      const auto k = static_cast<std::size_t>(next - times_.begin());
      const double share = (s - times_[k - 1]) / (times_[k] - times_[k - 1]);
      return (1 - share) * path[k - 1] + share * path[k];
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

  /// Velocities with which the feet that stand would have the body go, in the axes of heading().
  std::vector<Vec3> steps() const {
    std::array<Joint, 2> balls{};
    double floor = std::numeric_limits<double>::infinity();
    for (const bool right : {false, true}) {
      const Joint toes = on_side(Joint::left_toes, right), foot = on_side(Joint::left_foot, right);
      balls[right] = skeleton_.has(toes) ? toes : foot;
      for (const Posture& p : postures_)
        if (skeleton_.has(balls[right])) floor = std::min(floor, up_.dot(p.places[place_of(balls[right])]));
    }
    const double low = kLowFoot * skeleton_.leg_length(postures_.front());
    std::vector<double> weights(times_.size(), 0);
    std::vector<Vec3> ways(times_.size(), Vec3::Zero());
    for (const Joint ball : balls) {
      if (!skeleton_.has(ball) || low <= 0) continue;
      for (std::size_t k = 0; k < times_.size(); ++k) {
        const std::size_t a = k > 0 ? k - 1 : k, b = std::min(k + 1, times_.size() - 1);
        const Vec3 &from = postures_[a].places[place_of(ball)], &to = postures_[b].places[place_of(ball)];
        const double weight = 1 - (up_.dot(postures_[k].places[place_of(ball)]) - floor) / low;
        if (weight <= 0 || a == b) continue;
        weights[k] += weight;
        ways[k] -= weight / (times_[b] - times_[a]) * (heading(k).transpose() * level(to - from));
      }
    }
    // In the air it goes on as it went.
    std::size_t known = times_.size();
    for (std::size_t k = 0; k < times_.size(); ++k) {
      if (weights[k] == 0) continue;
      ways[k] /= weights[k];
      const Vec3 first = known < times_.size() ? ways[known] : ways[k];
      const std::size_t begin = known < times_.size() ? known + 1 : 0;
      for (std::size_t i = begin; i < k; ++i)
        ways[i] = first + static_cast<double>(i - begin + 1) / static_cast<double>(k - begin + 1) * (ways[k] - first);
      known = k;
    }
    for (std::size_t k = known + 1; k < times_.size(); ++k) ways[k] = ways[known];
    std::vector<Vec3> smooth;
    for (const double t : times_) smooth.push_back(smoothed(ways, t, std::min(kFootWindow, times_.back() / 2)));
    return smooth;
  }

  const Rig& rig_;
  const Skeleton skeleton_;
  const Clip& clip_;
  const Vec3 up_;
  const std::vector<double> times_;
  std::vector<Posture> postures_;
  std::vector<Vec3> middles_;  // places of the hips, or of what travels where there are none; level
};

}  // namespace

Clip in_place(const Rig& rig, const Clip& clip, const Vec3& up) {
  const Path path(rig, clip, up);
  return path.moved(path.back());
}

Traveled at_speed(const Rig& rig, const Clip& clip, double speed, const Vec3& up) {
  const Clip still = in_place(rig, clip, up);
  const Path path(rig, still, up);
  Traveled result;
  const std::vector<Vec3> by = path.ahead(speed, result.feet);
  result.clip = path.moved(by);
  return result;
}

}  // namespace weft::character
