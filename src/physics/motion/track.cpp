#include "physics/motion/track.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace weft::motion {
namespace {

constexpr double kPi = std::numbers::pi;

/// Deviation up to which a rotation counts as half a turn [rad]: far above the rounding of quaternions, far below what
/// is visible.
constexpr double kHalfTurnTolerance = 1e-6;

/// Rotation with the rotation vector w.
Quat exp(const Vec3& w) {
  const double angle = w.norm();
  // sin(angle / 2) / angle; for small angles by its series, because the quotient is 0 / 0 at angle 0.
  const double factor = angle > 1e-4 ? std::sin(0.5 * angle) / angle : 0.5 - angle * angle / 48;
  return Quat(std::cos(0.5 * angle), factor * w.x(), factor * w.y(), factor * w.z());
}

/// Rotation vector of q with an angle in [0, π].
Vec3 log(const Quat& q) {
  const Vec3 v = q.w() < 0 ? Vec3(-q.vec()) : Vec3(q.vec());
  const double sine = v.norm();
  if (sine < 1e-12) return 2 * v;
  return 2 * std::atan2(sine, std::abs(q.w())) / sine * v;
}

/// Of all rotation vectors of q, which differ by whole turns, the one closest to `guess`.
Vec3 log_near(const Quat& q, const Vec3& guess) {
  const Vec3 w = log(q);
  const double angle = w.norm();
  // If q is the identity, it does not define the axis of whole turns.
  const Vec3 axis = angle > 1e-9 ? Vec3(w / angle) : Vec3(guess.stableNormalized());
  return w + 2 * kPi * std::round((guess.dot(axis) - angle) / (2 * kPi)) * axis;
}

/// If at most one of the Euler angles (Pose::angles) changes: rotation vector of that change [rad], including whole
/// turns. Otherwise nothing.
std::optional<Vec3> turn_of_one_angle(const Pose& from, const Pose& to) {
  const std::optional<Vec3> change = change_of_angles(from, to);
  if (!change || (change->array() != 0).count() > 1) return std::nullopt;
  // The rotations are applied in the order x, y, z. Thus the rotations about y and z turn the x
  // axis, and the rotation about z turns the y axis.
  const Vec3 angles = kDegree * to.angles.value_or(Vec3::Zero());
  Vec3 axis = Vec3::UnitZ();
  if (change->x() != 0) axis = Eigen::AngleAxisd(angles.y(), Vec3::UnitY()) * Vec3::UnitX();
  if (change->y() != 0) axis = Vec3::UnitY();
  return Vec3(kDegree * change->sum() * (Eigen::AngleAxisd(angles.z(), Vec3::UnitZ()) * axis));
}

/// Rotation vectors from each key to the next [rad].
std::vector<Vec3> rotation_vectors_between(const std::vector<Pose>& poses) {
  std::vector<Vec3> turns;
  for (std::size_t i = 0; i + 1 < poses.size(); ++i) {
    if (const auto turn = turn_of_one_angle(poses[i], poses[i + 1])) {
      turns.push_back(*turn);
      continue;
    }
    Vec3 turn = log(poses[i + 1].rotation * poses[i].rotation.conjugate());
    // For half a turn, rounding errors decide the sign of the axis. This loop takes the sign for
    // which the axis is closer to that of the previous turn.
    if (!turns.empty() && kPi - turn.norm() < kHalfTurnTolerance && turn.dot(turns.back()) < 0)
      turn -= 2 * kPi * turn.normalized();
    turns.push_back(turn);
  }
  return turns;
}

/// Replaces the rotation p by e p with e = exp(b w), and updates its angular velocity and acceleration; db, ddb: time
/// derivatives of b. The angular velocity becomes db w + e (angular velocity of p); the angular acceleration is its
/// time derivative.
void rotate_sample(RotationSpline::Sample& p, const Vec3& w, double b, double db, double ddb) {
  const Quat e = exp(b * w);
  const Vec3 carried = e * p.angular_velocity;
  p.angular_acceleration = ddb * w + e * p.angular_acceleration + (db * w).cross(carried);
  p.angular_velocity = db * w + carried;
  p.rotation = e * p.rotation;
}

/// The results of of(key) for all keys; without keys, that for the rest pose.
template <class Of>
auto of_each_key(const PoseTrack& track, const Pose& rest, const Of& of) {
  std::vector<decltype(of(PoseKey()))> results;
  for (const PoseKey& key : track.keys) results.push_back(of(key));
  if (results.empty()) results.push_back(of(PoseKey{0, rest}));
  return results;
}

}  // namespace

RotationSpline::RotationSpline(Interpolation interpolation, std::vector<double> times, std::vector<Pose> poses)
    : interpolation_(interpolation), times_(std::move(times)) {
  for (Pose& pose : poses) {
    pose.rotation.normalize();
    rotations_.push_back(pose.rotation);
  }
  const std::vector<Vec3> turns = rotation_vectors_between(poses);
  std::vector<double> lengths;
  std::vector<Vec3> chords;
  for (std::size_t i = 0; i < turns.size(); ++i) {
    lengths.push_back(times_[i + 1] - times_[i]);
    chords.push_back(turns[i] / lengths[i]);
  }
  const std::vector<Vec3> slopes = slopes_between_keys<Vec3>(lengths, chords);
  for (std::size_t i = 0; i < turns.size(); ++i) {
    const double h = lengths[i];
    Segment segment{times_[i], h, rotations_[i], Vec3::Zero(), turns[i], Vec3::Zero()};
    if (interpolation_ == Interpolation::cubic) {
      // w1 and w3 follow from the angular velocities (slopes) at both keys; w2 is the rest of the rotation.
      segment.w1 = h / 3 * slopes[i];
      segment.w3 = h / 3 * slopes[i + 1];
      const Quat middle = exp(-segment.w3) * rotations_[i + 1] * rotations_[i].conjugate() * exp(-segment.w1);
      segment.w2 = log_near(middle, turns[i] - segment.w1 - segment.w3);
    }
    segments_.push_back(segment);
  }
}

RotationSpline::Sample RotationSpline::at(double t) const {
  if (t < times_.front() || times_.size() == 1) return {rotations_.front()};
  if (t >= times_.back()) return {rotations_.back()};
  const Segment& s = segments_[find_segment(times_, t)];
  const double h = s.length, u = (t - s.start) / h, v = 1 - u;
  Sample sample{s.q0};
  if (interpolation_ == Interpolation::linear) {
    rotate_sample(sample, s.w2, u, 1 / h, 0);
  } else {
    rotate_sample(sample, s.w1, 1 - v * v * v, 3 * v * v / h, -6 * v / (h * h));
    rotate_sample(sample, s.w2, u * u * (3 - 2 * u), 6 * u * v / h, 6 * (v - u) / (h * h));
    rotate_sample(sample, s.w3, u * u * u, 3 * u * u / h, 6 * u / (h * h));
  }
  sample.rotation.normalize();
  return sample;
}

Track::Track(const PoseTrack& track, const Pose& rest)
    : times_(of_each_key(track, rest, [](const PoseKey& key) { return key.time; })),
      position_(track.interpolation, times_,
                of_each_key(track, rest, [](const PoseKey& key) { return key.pose.position; })),
      rotation_(track.interpolation, times_, of_each_key(track, rest, [](const PoseKey& key) { return key.pose; })) {}

// A time within 1e-12 s of a key counts as the time of the key. Otherwise a track that ends at this
// key and a track with further keys would give poses that differ by rounding errors. Contacts of
// cloth amplify such differences to millimetres.
PoseSample Track::at(double t) const {
  constexpr double kRounding = 1e-12;  // [s]
  const auto key = std::ranges::lower_bound(times_, t - kRounding);
  if (key != times_.end() && *key <= t + kRounding) t = *key;
  const Spline<3>::Sample p = position_.at(t);
  const RotationSpline::Sample r = rotation_.at(t);
  return {p.value, r.rotation, p.first_derivative, r.angular_velocity, p.second_derivative, r.angular_acceleration};
}

PoseSample compose(const PoseSample& parent, const Pose& parent_start, const PoseSample& own) {
  const Quat turn = parent.rotation * parent_start.rotation.conjugate();
  const Vec3 arm = turn * (own.position - parent_start.position), drift = turn * own.velocity;
  const Vec3 &omega = parent.angular_velocity, spin = turn * own.angular_velocity;
  PoseSample sample;
  sample.position = parent.position + arm;
  sample.rotation = (turn * own.rotation).normalized();
  sample.velocity = parent.velocity_at(arm) + drift;
  sample.angular_velocity = omega + spin;
  sample.acceleration = parent.acceleration_at(arm) + 2 * omega.cross(drift) + turn * own.acceleration;
  sample.angular_acceleration = parent.angular_acceleration + omega.cross(spin) + turn * own.angular_acceleration;
  return sample;
}

}  // namespace weft::motion
