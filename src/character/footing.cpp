#include "character/footing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace weft::character {
namespace {

// A foot stands while its ball is slower and lower than this, in lengths of the leg (0.85 m in an adult, so 0.3 m/s and
// 4 cm): toes that swing pass at 3 to 5 m/s, noise of recordings moves feet that stand at 0.05 to 0.15 m/s.
constexpr double kSlow = 0.35, kLow = 0.05;
/// Flat feet have ankles that are as slow, and no higher above where ankles stand.
constexpr double kFlatAnkle = 0.03;
/// Speeds are means over this time [s], half a key of 15 a second.
constexpr double kSpeedWindow = 1.0 / 30;
/// Shorter contacts are chance [s].
constexpr double kShortest = 0.08;
/// A ball that goes further than this within a contact shuffles: there, one contact ends and the next begins [legs].
constexpr double kShuffle = 0.08;
/// The floor is at the lowest height at which feet are slow at least half as often as where they are most often: below
/// are poses that recordings begin with and outliers, above are steps and chairs.
constexpr double kOften = 0.5;
/// In which feet go over from a contact to their own motion [s]; a step takes 0.4 s or more.
constexpr double kRamp = 0.15;
/// In which hips come down and up again around a key where a leg would not reach [s].
constexpr double kRiseRamp = 0.25;
/// A leg is straight at this share of its length: with a bend of 5°, from where knees do not snap.
constexpr double kReach = 0.999;
/// Cosine of the angle between thigh and shin of a knee that folds by 155°, as far as calf and thigh let it.
constexpr double kFolded = 0.906;

/// The value below which `share` of them lie.
double quantile(std::vector<double> values, double share) {
  const auto k = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + k, values.end());
  return values[static_cast<std::size_t>(k)];
}

/// Mean speeds at the keys of a track [m/s].
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

/// The joints of one foot over time.
struct FootTrack {
  std::vector<Vec3> places;
  std::vector<double> speeds, heights;
};

FootTrack track_of(Joint joint, std::span<const Posture> postures, std::span<const double> times, const Vec3& up) {
  FootTrack track;
  for (const Posture& posture : postures) {
    track.places.push_back(posture.places[place_of(joint)]);
    track.heights.push_back(up.dot(track.places.back()));
  }
  track.speeds = speeds(track.places, times);
  return track;
}

std::vector<Contact> contacts_of(const FootTrack& ball, std::span<const double> times, double floor, double leg) {
  std::vector<Contact> contacts;
  const auto stands = [&](std::size_t k) {
    return ball.speeds[k] < kSlow * leg && ball.heights[k] < floor + kLow * leg;
  };
  for (std::size_t k = 0; k < times.size(); ++k) {
    if (!stands(k)) continue;
    Contact contact{k, k};
    while (contact.last + 1 < times.size() && stands(contact.last + 1) &&
           (ball.places[contact.last + 1] - ball.places[contact.first]).norm() < kShuffle * leg)
      ++contact.last;
    if (times[contact.last] - times[contact.first] >= kShortest) contacts.push_back(contact);
    k = contact.last;
  }
  return contacts;
}

/// The lowest height of balls that stand on the floor; without slow ones that of all.
double floor_height(const std::array<FootTrack, 2>& balls, double leg) {
  std::vector<double> slow;
  double lowest = std::numeric_limits<double>::infinity();
  for (const FootTrack& ball : balls)
    for (std::size_t k = 0; k < ball.heights.size(); ++k) {
      lowest = std::min(lowest, ball.heights[k]);
      if (ball.speeds[k] < kSlow * leg) slow.push_back(ball.heights[k]);
    }
  if (slow.empty()) return lowest;
  std::ranges::sort(slow);
  // How many lie up to kLow above each.
  std::vector<std::ptrdiff_t> many;
  for (auto h = slow.begin(); h != slow.end(); ++h)
    many.push_back(std::upper_bound(h, slow.end(), *h + kLow * leg) - h);
  const double often = kOften * static_cast<double>(std::ranges::max(many));
  std::size_t k = 0;
  while (static_cast<double>(many[k]) < often) ++k;
  while (k + 1 < many.size() && many[k + 1] >= many[k]) ++k;
  return slow[k];
}

/// What a quantity that is known in contacts alone is at other keys: that of the nearest contact, less and less.
class Between {
 public:
  Between(const std::vector<Contact>& contacts, std::span<const double> times) : contacts_(contacts), times_(times) {}

  /// `in_contact(c, k)`: of contact c at key k, asked for keys in it.
  template <class InContact>
  Vec3 at(std::size_t k, const InContact& in_contact) const {
    Vec3 sum = Vec3::Zero();
    for (std::size_t c = 0; c < contacts_.size(); ++c) {
      const auto [first, last] = contacts_[c];
      if (k >= first && k <= last) return in_contact(c, k);
      if (k > last)
        sum += weight(times_[k] - times_[last], c + 1 < contacts_.size() ? gap(c) : kAlone) * in_contact(c, last);
      if (k < first) sum += weight(times_[first] - times_[k], c > 0 ? gap(c - 1) : kAlone) * in_contact(c, first);
    }
    return sum;
  }

 private:
  static constexpr double kAlone = std::numeric_limits<double>::infinity();

  /// Time from contact c to the next.
  double gap(std::size_t c) const { return times_[contacts_[c + 1].first] - times_[contacts_[c].last]; }

  static double weight(double after, double gap) { return 1 - ease(after / std::min(kRamp, gap)); }

  const std::vector<Contact>& contacts_;
  std::span<const double> times_;
};

/// How far the ankle is at least from the hip.
double least_reach(const Leg& leg) {
  const double a = (leg.knee - leg.hip).norm(), b = (leg.ankle - leg.knee).norm();
  return std::sqrt(a * a + b * b - 2 * a * b * kFolded);
}

/// And at most; a leg that is straighter as it is may stay so.
double most_reach(const Leg& leg) {
  return std::max(kReach * ((leg.knee - leg.hip).norm() + (leg.ankle - leg.knee).norm()), (leg.ankle - leg.hip).norm());
}

/// By how much the hips must rise for a distance between hip and ankle, where the ankle is at `way` from the hip; less
/// than 0 if they must come down; 0 where they can not.
double rise_for(double distance, const Vec3& way, const Vec3& up) {
  const double down = -up.dot(way), level_sq = (way + down * up).squaredNorm();
  return distance * distance > level_sq ? std::sqrt(distance * distance - level_sq) - down : 0;
}

double rise_of_hips(const Leg& leg, const Vec3& ankle, const Vec3& up) {
  const Vec3 way = ankle - leg.hip;
  if (way.norm() > most_reach(leg)) return std::min(0.0, rise_for(most_reach(leg), way, up));
  if (way.norm() < least_reach(leg)) return std::max(0.0, rise_for(least_reach(leg), way, up));
  return 0;
}

/// The least that is nowhere less than the given, which are not negative, and comes and goes within kRiseRamp.
std::vector<double> spread(const std::vector<double>& needed, std::span<const double> times) {
  std::vector<double> result = needed;
  for (std::size_t k = 0; k < needed.size(); ++k) {
    if (needed[k] == 0) continue;
    const auto reaches = [&](std::size_t to) {
      const double share = 1 - ease(std::abs(times[to] - times[k]) / kRiseRamp);
      result[to] = std::max(result[to], needed[k] * share);
      return share > 0;
    };
    for (std::size_t to = k; to > 0 && reaches(to - 1);) --to;
    for (std::size_t to = k + 1; to < needed.size() && reaches(to);) ++to;
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
  steps.ankle_height = quantile(standing, 0.25);  // later in a contact heels rise
  for (const bool right : {false, true})
    for (const Contact& contact : steps.contacts[right])
      for (std::size_t k = contact.first; k <= contact.last; ++k)
        steps.flat[k][right] =
            ankles[right].speeds[k] < kSlow * leg && ankles[right].heights[k] < steps.ankle_height + kFlatAnkle * leg
                ? 1
                : 0;
  return steps;
}

std::vector<Stance> plant_feet(std::span<const Legs> legs, const Footsteps& steps, std::span<const double> times,
                               double floor, const Vec3& up) {
  std::vector<Stance> stances(legs.size());
  std::vector<double> up_by(legs.size(), 0), down_by(legs.size(), 0);  // of the hips
  const auto above = [&](const Leg& leg) { return std::min(up.dot(leg.ball), up.dot(leg.heel)) - floor; };
  for (const bool right : {false, true}) {
    const std::vector<Contact>& contacts = steps.contacts[right];
    const Between between(contacts, times);
    std::vector<Vec3> anchors;  // of the ball
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
  up_by = spread(up_by, times);
  down_by = spread(down_by, times);
  for (std::size_t k = 0; k < stances.size(); ++k) stances[k].rise = up_by[k] - down_by[k];
  return stances;
}

LegTurns reach(const Leg& leg, const Vec3& ankle) {
  const Vec3 thigh = leg.knee - leg.hip, shin = leg.ankle - leg.knee, way = ankle - leg.hip;
  const double a = thigh.norm(), b = shin.norm();
  const double length = std::clamp(way.norm(), least_reach(leg), most_reach(leg));
  // The plane of the leg, or that of its hinge where it is straight.
  const Vec3 normal = (thigh.cross(shin) / (a * b) + 0.02 * leg.hinge).normalized();
  const double cosine = std::clamp((length * length - a * a - b * b) / (2 * a * b), -1.0, 1.0);
  const double now = std::atan2(thigh.cross(shin).dot(normal), thigh.dot(shin));
  const Quat bend(Eigen::AngleAxisd(std::acos(cosine) - now, normal));
  const Quat swing = shortest_rotation(thigh + bend * shin, way);
  return {swing, swing * bend};
}

}  // namespace weft::character
