#include "film/character/footing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace weft::character {
namespace {

// A foot is in contact if its ball is slower than kMaxContactSpeed [leg lengths/s] and less than kMaxContactHeight [leg
// lengths] above floor_height(). For the leg of an adult, 0.85 m, this is 0.3 m/s and 4 cm. Toes in swing move at 3 to
// 5 m/s; noise in recordings moves standing feet at 0.05 to 0.15 m/s.
constexpr double kMaxContactSpeed = 0.35, kMaxContactHeight = 0.05;
/// Maximum height of the ankle of a flat foot above Footsteps::ankle_height [leg lengths].
constexpr double kMaxFlatAnkleHeight = 0.03;
/// Window of the mean speed at a key [s]: from the last key that is at least half of this time earlier to the first key
/// that is at least half of it later.
constexpr double kSpeedWindow = 1.0 / 30;
/// Minimum duration of a contact [s]. Shorter contacts are ignored.
constexpr double kMinContactTime = 0.08;
/// A new contact begins if the ball is farther than this from its position at the start of the contact, as in shuffling
/// [leg lengths].
constexpr double kMaxBallMotion = 0.08;
/// floor_height() counts the heights of slow feet. The floor is the lowest peak of these counts that is at least this
/// fraction of the highest peak. Initial poses of recordings and outliers are below the floor, stairs and chairs above.
constexpr double kMinFrequencyRatio = 0.5;
/// Time in which a foot blends from a contact into its own motion and back [s]. A step takes 0.4 s or more.
constexpr double kFootBlendTime = 0.15;
/// A correction of the hips at a key fades within this time before and after the key (see plant_feet) [s].
constexpr double kHipBlendTime = 0.25;
/// Maximum distance from hip to ankle, as a fraction of thigh plus shin. The knee then keeps a bend of 5°; without this
/// limit, it would straighten abruptly.
constexpr double kStraightLegRatio = 0.999;
/// Cosine of the smallest angle between thigh and shin. The knee is then bent by 155°, and calf and thigh touch.
constexpr double kFoldedKneeCosine = 0.906;

/// The value below which the fraction `fraction` of all values lies.
double quantile(std::vector<double> values, double fraction) {
  const auto k = static_cast<std::ptrdiff_t>(fraction * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + k, values.end());
  return values[static_cast<std::size_t>(k)];
}

/// Mean speed at each key of a track [m/s].
std::vector<double> speeds(const std::vector<Vec3>& track, std::span<const double> times) {
  std::vector<double> speeds(track.size(), 0);
  for (std::size_t k = 0; k < track.size(); ++k) {
    std::size_t a = k, b = k;
    while (a > 0 && times[k] - times[a] < kSpeedWindow / 2) --a;
    while (b + 1 < track.size() && times[b] - times[k] < kSpeedWindow / 2) ++b;
    if (b > a) speeds[k] = (track[b] - track[a]).norm() / (times[b] - times[a]);
  }
  return speeds;
}

/// The path of one joint of a foot.
struct FootTrack {
  std::vector<Vec3> places;
  std::vector<double> speeds, heights;
};

FootTrack track_of(Joint joint, std::span<const Posture> postures, std::span<const double> times, const Vec3& up) {
  FootTrack track;
  for (const Posture& posture : postures) {
    track.places.push_back(posture.places[joint_index(joint)]);
    track.heights.push_back(up.dot(track.places.back()));
  }
  track.speeds = speeds(track.places, times);
  return track;
}

std::vector<Contact> contacts_of(const FootTrack& ball, std::span<const double> times, double floor, double leg) {
  std::vector<Contact> contacts;
  const auto is_standing = [&](std::size_t k) {
    return ball.speeds[k] < kMaxContactSpeed * leg && ball.heights[k] < floor + kMaxContactHeight * leg;
  };
  for (std::size_t k = 0; k < times.size(); ++k) {
    if (!is_standing(k)) continue;
    Contact contact{k, k};
    while (contact.last + 1 < times.size() && is_standing(contact.last + 1) &&
           (ball.places[contact.last + 1] - ball.places[contact.first]).norm() < kMaxBallMotion * leg)
      ++contact.last;
    if (times[contact.last] - times[contact.first] >= kMinContactTime) contacts.push_back(contact);
    k = contact.last;
  }
  return contacts;
}

/// Height of the ball joints of feet that stand on the floor [m]. If no ball joint is ever slower than
/// kMaxContactSpeed, the lowest height of any.
double floor_height(const std::array<FootTrack, 2>& balls, double leg) {
  std::vector<double> slow;
  double lowest = std::numeric_limits<double>::infinity();
  for (const FootTrack& ball : balls)
    for (std::size_t k = 0; k < ball.heights.size(); ++k) {
      lowest = std::min(lowest, ball.heights[k]);
      if (ball.speeds[k] < kMaxContactSpeed * leg) slow.push_back(ball.heights[k]);
    }
  if (slow.empty()) return lowest;
  std::ranges::sort(slow);
  // Per height, the number of heights between it and kMaxContactHeight above it.
  std::vector<std::ptrdiff_t> counts;
  for (auto h = slow.begin(); h != slow.end(); ++h)
    counts.push_back(std::upper_bound(h, slow.end(), *h + kMaxContactHeight * leg) - h);
  const double threshold = kMinFrequencyRatio * static_cast<double>(std::ranges::max(counts));
  std::size_t k = 0;
  while (static_cast<double>(counts[k]) < threshold) ++k;
  while (k + 1 < counts.size() && counts[k + 1] >= counts[k]) ++k;
  return slow[k];
}

/// Extends a quantity that is defined only in contacts to all keys. Outside contacts, the values at the ends of the
/// nearest contacts fade to zero with time.
class ContactBlend {
 public:
  ContactBlend(const std::vector<Contact>& contacts, std::span<const double> times)
      : contacts_(contacts), times_(times) {}

  /// `in_contact(c, k)`: value of contact c at key k; called only for keys inside the contact.
  template <class InContact>
  Vec3 at(std::size_t k, const InContact& in_contact) const {
    Vec3 sum = Vec3::Zero();
    for (std::size_t c = 0; c < contacts_.size(); ++c) {
      const auto [first, last] = contacts_[c];
      if (k >= first && k <= last) return in_contact(c, k);
      if (k > last)
        sum += weight(times_[k] - times_[last], c + 1 < contacts_.size() ? gap(c) : kNoNeighbour) * in_contact(c, last);
      if (k < first) sum += weight(times_[first] - times_[k], c > 0 ? gap(c - 1) : kNoNeighbour) * in_contact(c, first);
    }
    return sum;
  }

 private:
  static constexpr double kNoNeighbour = std::numeric_limits<double>::infinity();

  /// Time from the end of contact c to the start of the next [s].
  double gap(std::size_t c) const { return times_[contacts_[c + 1].first] - times_[contacts_[c].last]; }

  static double weight(double after, double gap) { return 1 - ease(after / std::min(kFootBlendTime, gap)); }

  const std::vector<Contact>& contacts_;
  std::span<const double> times_;
};

/// Minimum distance from hip to ankle [m].
double min_reach(const Leg& leg) {
  const double a = (leg.knee - leg.hip).norm(), b = (leg.ankle - leg.knee).norm();
  return std::sqrt(a * a + b * b - 2 * a * b * kFoldedKneeCosine);
}

/// Maximum distance from hip to ankle [m]: kStraightLegRatio of the leg length or, if larger, that in the motion.
double max_reach(const Leg& leg) {
  return std::max(kStraightLegRatio * ((leg.knee - leg.hip).norm() + (leg.ankle - leg.knee).norm()),
                  (leg.ankle - leg.hip).norm());
}

/// Rise of the hips [m] that makes the distance from hip to ankle equal to `distance`; negative if the hips must move
/// down, 0 if no rise achieves this. `to_ankle`: vector from the hip to the ankle before the rise.
double rise_for(double distance, const Vec3& to_ankle, const Vec3& up) {
  const double down = -up.dot(to_ankle), level_sq = (to_ankle + down * up).squaredNorm();
  return distance * distance > level_sq ? std::sqrt(distance * distance - level_sq) - down : 0;
}

double rise_of_hips(const Leg& leg, const Vec3& ankle, const Vec3& up) {
  const Vec3 to_ankle = ankle - leg.hip;
  if (to_ankle.norm() > max_reach(leg)) return std::min(0.0, rise_for(max_reach(leg), to_ankle, up));
  if (to_ankle.norm() < min_reach(leg)) return std::max(0.0, rise_for(min_reach(leg), to_ankle, up));
  return 0;
}

/// Spreads each value of `needed` (>= 0) to other keys, fading to 0 at the time distance kHipBlendTime. Returns for
/// each key the largest of its own value and the values spread to it.
std::vector<double> spread_over_time(const std::vector<double>& needed, std::span<const double> times) {
  std::vector<double> result = needed;
  for (std::size_t k = 0; k < needed.size(); ++k) {
    if (needed[k] == 0) continue;
    const auto raise_at = [&](std::size_t to) {
      const double fraction = 1 - ease(std::abs(times[to] - times[k]) / kHipBlendTime);
      result[to] = std::max(result[to], needed[k] * fraction);
      return fraction > 0;
    };
    for (std::size_t to = k; to > 0 && raise_at(to - 1);) --to;
    for (std::size_t to = k + 1; to < needed.size() && raise_at(to);) ++to;
  }
  return result;
}

}  // namespace

Footsteps find_footsteps(const Skeleton& skeleton, std::span<const Posture> postures, std::span<const double> times,
                         const Vec3& up) {
  Footsteps steps;
  steps.flat.assign(postures.size(), Flat{0, 0});
  steps.ankle_height = std::numeric_limits<double>::infinity();
  std::array<FootTrack, 2> balls, ankles;
  for (const bool right : {false, true}) {
    const Joint foot = on_side(Joint::left_foot, right), toes = on_side(Joint::left_toes, right);
    if (!skeleton.has(foot)) continue;
    ankles[right] = track_of(foot, postures, times, up);
    balls[right] = skeleton.has(toes) ? track_of(toes, postures, times, up) : ankles[right];
    for (const double height : ankles[right].heights) steps.ankle_height = std::min(steps.ankle_height, height);
  }
  const double leg = skeleton.leg_length(postures.front());
  if (leg == 0 || !std::isfinite(steps.ankle_height)) return steps;

  const double floor = floor_height(balls, leg);
  std::vector<double> standing;  // heights of ankles
  for (const bool right : {false, true}) {
    if (balls[right].places.empty()) continue;
    steps.contacts[right] = contacts_of(balls[right], times, floor, leg);
    for (const Contact& contact : steps.contacts[right])
      for (std::size_t k = contact.first; k <= contact.last; ++k) standing.push_back(ankles[right].heights[k]);
  }
  if (standing.empty()) return steps;
  steps.ankle_height = quantile(standing, 0.25);  // a low quantile, because the heel rises late in a contact
  for (const bool right : {false, true})
    for (const Contact& contact : steps.contacts[right])
      for (std::size_t k = contact.first; k <= contact.last; ++k)
        steps.flat[k][right] = ankles[right].speeds[k] < kMaxContactSpeed * leg &&
                                       ankles[right].heights[k] < steps.ankle_height + kMaxFlatAnkleHeight * leg
                                   ? 1
                                   : 0;
  return steps;
}

std::vector<Stance> plant_feet(std::span<const Legs> legs, const Footsteps& steps, std::span<const double> times,
                               double floor, const Vec3& up) {
  std::vector<Stance> stances(legs.size());
  std::vector<double> up_by(legs.size(), 0), down_by(legs.size(), 0);  // displacement of the hips [m]
  const auto above = [&](const Leg& leg) { return std::min(up.dot(leg.ball), up.dot(leg.heel)) - floor; };
  for (const bool right : {false, true}) {
    const std::vector<Contact>& contacts = steps.contacts[right];
    const ContactBlend between(contacts, times);
    std::vector<Vec3> anchors;  // per contact: mean position of the ball
    for (const Contact& contact : contacts) {
      Vec3 sum = Vec3::Zero();
      for (std::size_t k = contact.first; k <= contact.last; ++k) sum += legs[k][right].ball;
      anchors.emplace_back(sum / static_cast<double>(contact.last - contact.first + 1));
    }
    for (std::size_t k = 0; k < legs.size(); ++k) {
      Vec3& shift = stances[k].shift[right];
      shift = between.at(k, [&](std::size_t c, std::size_t at) {
        const Leg& leg = legs[at][right];
        const Vec3 back = anchors[c] - leg.ball;
        return Vec3(back - (back.dot(up) + above(leg)) * up);
      });
      const double below = above(legs[k][right]) + up.dot(shift);
      if (below < 0) shift -= below * up;
      const double rise = rise_of_hips(legs[k][right], legs[k][right].ankle + shift, up);
      up_by[k] = std::max(up_by[k], rise);
      down_by[k] = std::max(down_by[k], -rise);
    }
    for (const Contact& contact : contacts)
      for (std::size_t k = contact.first; k <= contact.last; ++k) stances[k].in_contact[right] = true;
  }
  up_by = spread_over_time(up_by, times);
  down_by = spread_over_time(down_by, times);
  for (std::size_t k = 0; k < stances.size(); ++k) stances[k].rise = up_by[k] - down_by[k];
  return stances;
}

LegTurns solve_two_bone_ik(const Leg& leg, const Vec3& ankle) {
  const Vec3 thigh = leg.knee - leg.hip, shin = leg.ankle - leg.knee, to_ankle = ankle - leg.hip;
  const double a = thigh.norm(), b = shin.norm();
  const double length = std::clamp(to_ankle.norm(), min_reach(leg), max_reach(leg));
  // Normal of the plane in which the leg bends; for a straight leg, its hinge axis.
  const Vec3 normal = (thigh.cross(shin) / (a * b) + 0.02 * leg.hinge).normalized();
  const double cosine = std::clamp((length * length - a * a - b * b) / (2 * a * b), -1.0, 1.0);
  const double now = std::atan2(thigh.cross(shin).dot(normal), thigh.dot(shin));
  const Quat bend(Eigen::AngleAxisd(std::acos(cosine) - now, normal));
  const Quat swing = shortest_rotation(thigh + bend * shin, to_ankle);
  return {swing, swing * bend};
}

}  // namespace weft::character
