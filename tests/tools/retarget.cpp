// weft_retarget: transfers motions of other skeletons to a body and prints how well its bones and feet follow.
#include "film/character/retarget.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "core/timer.hpp"
#include "film/assets/character_file.hpp"
#include "film/character/footing.hpp"
#include "film/character/mannequin.hpp"
#include "film/character/parts.hpp"

namespace {

using namespace weft;             // NOLINT(google-build-using-namespace)
using namespace weft::character;  // NOLINT(google-build-using-namespace)

const Vec3 kUp = Vec3::UnitZ();

double angle(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / std::numbers::pi;
}

/// The times of the channel with the most keys [s].
std::vector<double> key_times(const Clip& clip) {
  std::vector<double> times;
  for (const Channel& channel : clip.channels)
    if (channel.rotation.times.size() > times.size()) times = channel.rotation.times;
  return times;
}

/// Turn about the vertical from where one skeleton faces to where another does.
Quat turn_between(const Skeleton& a, const Posture& of_a, const Skeleton& b, const Posture& of_b) {
  const auto left = [](const Skeleton& s, const Posture& p) -> Vec3 {
    const Vec3 v = s.across_hips(p).normalized() + s.across_shoulders(p).normalized();
    return v - v.dot(kUp) * kUp;
  };
  const Vec3 l0 = left(a, of_a), l1 = left(b, of_b);
  return Quat(Eigen::AngleAxisd(std::atan2(l0.cross(l1).dot(kUp), l0.dot(l1)), kUp));
}

struct Follows {
  double angle = 0;                  // largest angle between a bone and the same bone of the motion [degrees]
  std::string bone;                  // the bone with that angle
  double arm = 0;                    // `angle` for bones of the arms only [degrees]
  double trunk = 0, trunk_when = 0;  // `angle` for the line from hips to mid-shoulders [degrees], and its time [s]
  double slip = 0;                   // largest horizontal displacement of the toe joint during a contact [m]
  double theirs = 0;                 // `slip` of the motion itself, scaled by the ratio of leg lengths [m]
  double toes = 0;                   // `slip` of the mean vertex of the toes, or of the foot without toe joint [m]
  double below = 0, above = 0;       // least and largest height of the feet over the floor while a foot stands [m]
  std::size_t steps = 0, keys = 0;
  double when = 0;
  // Root mean square error of the offset of the hands from each other, and of a hand from the hips, relative to the
  // offset in the motion, scaled to the body [m]. Only keys at which the motion holds the hands together, or a hand at
  // the hips with a bent arm, count.
  double hands = 0, hips = 0;
  std::size_t hands_keys = 0, hips_keys = 0;
};

/// Height of the lowest vertex of the feet [m].
double lowest(const Rig& body, const Pose& pose) {
  static const VertexMask kFeet = vertices_of(body.character, body.joints, joints_of_part("feet"));
  std::vector<Vec3> x(kFeet.size());
  skin(body.character, pose, x);
  double lowest = std::numeric_limits<double>::infinity();
  for (std::size_t v = 0; v < x.size(); ++v)
    if (kFeet[v] != 0) lowest = std::min(lowest, kUp.dot(x[v]));
  return lowest;
}

/// Mean horizontal position of the vertices that a joint moves [m].
Vec3 middle_of_skin(const Rig& body, Joint joint, const Pose& pose) {
  const VertexMask mask = vertices_below(body.character, body.joints[joint_index(joint)]);
  std::vector<Vec3> x(mask.size());
  skin(body.character, pose, x);
  Vec3 sum = Vec3::Zero();
  int count = 0;
  for (std::size_t v = 0; v < x.size(); ++v)
    if (mask[v] != 0) {
      sum += x[v];
      ++count;
    }
  return (sum - sum.dot(kUp) * kUp) / std::max(1, count);
}

Follows measure(const Rig& body, const Rig& motion, const Clip& theirs, const Clip& ours) {
  const Skeleton a(body), b(motion);
  const std::vector<double> times = key_times(ours);
  std::vector<Posture> at, from;
  const double floor = lowest(body, rest_pose(body.character));
  for (const double t : times) {
    at.push_back(a.at(pose_at(body.character, ours, t)));
    from.push_back(b.at(pose_at(motion.character, theirs, t)));
  }
  Follows result;
  result.keys = times.size();
  const Quat face = turn_between(b, from.front(), a, at.front());
  const Footsteps steps = find_footsteps(b, from, times, kUp);
  std::vector<bool> standing(times.size(), false);
  const double ratio = a.leg_length(at.front()) / b.leg_length(from.front());
  const auto level_way = [](const std::vector<Posture>& postures, Joint joint, std::size_t k0, std::size_t k1) {
    const Vec3 displacement = postures[k1].places[joint_index(joint)] - postures[k0].places[joint_index(joint)];
    return (displacement - displacement.dot(kUp) * kUp).norm();
  };
  for (const bool right : {false, true}) {
    const Joint toes = on_side(a.has(Joint::left_toes) ? Joint::left_toes : Joint::left_foot, right);
    const Joint their_toes = on_side(b.has(Joint::left_toes) ? Joint::left_toes : Joint::left_foot, right);
    for (const Contact& contact : steps.contacts[right]) {
      ++result.steps;
      Vec3 first = Vec3::Zero();
      for (std::size_t k = contact.first; k <= contact.last; ++k) {
        standing[k] = true;
        if ((k - contact.first) % 3 == 0) {
          const Vec3 here = middle_of_skin(body, toes, pose_at(body.character, ours, times[k]));
          if (k == contact.first) first = here;
          result.toes = std::max(result.toes, (here - first).norm());
        }
        result.slip = std::max(result.slip, level_way(at, toes, contact.first, k));
        result.theirs = std::max(result.theirs, ratio * level_way(from, their_toes, contact.first, k));
      }
    }
  }
  for (std::size_t k = 0; k < times.size(); ++k) {
    for (const Joint left_joint :
         {Joint::left_upper_arm, Joint::left_lower_arm, Joint::left_upper_leg, Joint::left_lower_leg})
      for (const bool right : {false, true}) {
        const Joint joint = on_side(left_joint, right);
        if (!a.has(joint) || !b.has(joint)) continue;
        const double between = angle(a.bone(at[k], joint), face * b.bone(from[k], joint));
        if (left_joint <= Joint::left_hand) result.arm = std::max(result.arm, between);
        if (between <= result.angle) continue;
        result.angle = between;
        result.bone = name(joint);
      }
    if (const double lean = angle(a.trunk(at[k]), face * b.trunk(from[k])); lean > result.trunk) {
      result.trunk = lean;
      result.trunk_when = times[k];
    }
    if (!standing[k] || k % 3 != 0) continue;
    const double gap = lowest(body, pose_at(body.character, ours, times[k])) - floor;
    if (gap < result.below) result.when = times[k];
    result.below = std::min(result.below, gap);
    result.above = std::max(result.above, gap);
  }
  return result;
}

/// Measures how well the body holds its hands together, or at the hips with bent arms, where the motion does so.
void measure_hands(const Rig& body, const Rig& motion, const Clip& theirs, const Clip& ours, Follows& result) {
  constexpr double kTogether = 0.24, kAtHips = 0.5, kBent = 60;  // [arm lengths], [arm lengths], [degrees]
  const Skeleton a(body), b(motion);
  for (const Joint joint : {Joint::left_upper_arm, Joint::left_lower_arm, Joint::left_hand, Joint::right_hand})
    if (!a.has(joint) || !b.has(joint)) return;
  const std::vector<double> times = key_times(ours);
  double trunk = 0;
  for (const double t : times) trunk = std::max(trunk, b.trunk(b.at(pose_at(motion.character, theirs, t))).norm());
  const Posture rest = a.at(rest_pose(body.character));
  trunk = a.trunk(rest).norm() / trunk;
  Quat face = Quat::Identity();
  double hands = 0, hips = 0;
  for (const double t : times) {
    const Posture p = a.at(pose_at(body.character, ours, t)), q = b.at(pose_at(motion.character, theirs, t));
    if (t == times.front()) face = turn_between(b, q, a, p);
    const double arm = b.arm_length(q);
    const auto hand = [](const Posture& at, bool right) -> Vec3 {
      return at.places[joint_index(on_side(Joint::left_hand, right))];
    };
    const Vec3 apart = hand(q, false) - hand(q, true);
    if (apart.norm() < kTogether * arm) {
      ++result.hands_keys;
      hands += (hand(p, false) - hand(p, true) - a.arm_length(p) / arm * (face * apart)).squaredNorm();
    }
    for (const bool right : {false, true}) {
      const Vec3 offset = hand(q, right) - b.middle_of_hips(q);
      const double bend =
          angle(b.bone(q, on_side(Joint::left_upper_arm, right)), b.bone(q, on_side(Joint::left_lower_arm, right)));
      if (bend < kBent || offset.norm() > kAtHips * arm) continue;
      ++result.hips_keys;
      hips += (hand(p, right) - a.middle_of_hips(p) - trunk * (face * offset)).squaredNorm();
    }
  }
  result.hands = std::sqrt(hands / std::max<double>(1, static_cast<double>(result.hands_keys)));
  result.hips = std::sqrt(hips / std::max<double>(1, static_cast<double>(result.hips_keys)));
}

/// Prints the ranges of the angles of elbows, knees, upper arms and upper legs in the motion and on the body: minimum
/// and maximum over both sides and all keys; upper arms and legs relative to the trunk.
void report_ranges(const Rig& body, const Rig& motion, const Clip& theirs, const Clip& ours) {
  struct Bend {
    const char* name;
    Joint joint;
    std::optional<Joint> against;  // none: relative to the trunk
  };
  const Bend kBends[] = {{"elbow", Joint::left_lower_arm, Joint::left_upper_arm},
                         {"knee", Joint::left_lower_leg, Joint::left_upper_leg},
                         {"arm", Joint::left_upper_arm, {}},
                         {"leg", Joint::left_upper_leg, {}}};
  const Skeleton a(body), b(motion);
  const std::vector<double> times = key_times(ours);
  std::string text;
  for (const Bend& bend : kBends) {
    std::array<Vec2, 2> range{Vec2(180, 0), Vec2(180, 0)};
    for (const bool right : {false, true}) {
      const Joint joint = on_side(bend.joint, right);
      if (!a.has(joint) || !b.has(joint)) continue;
      const auto add = [&](const Skeleton& skeleton, const Posture& at, Vec2& to) {
        const Vec3 other = bend.against ? skeleton.bone(at, on_side(*bend.against, right)) : Vec3(-skeleton.trunk(at));
        const double degrees = angle(skeleton.bone(at, joint), other);
        to = Vec2(std::min(to.x(), degrees), std::max(to.y(), degrees));
      };
      for (const double t : times) {
        add(b, b.at(pose_at(motion.character, theirs, t)), range[0]);
        add(a, a.at(pose_at(body.character, ours, t)), range[1]);
      }
    }
    text += fmt::format("{} {:.0f} to {:.0f}, {:.0f} to {:.0f}", text.empty() ? "" : ";", range[0].x(), range[0].y(),
                        range[1].x(), range[1].y());
    text += fmt::format(" {}", bend.name);
  }
  std::printf("    ranges [°], of the motion and of the body:%s\n", text.c_str());
}

Character without_names(Character character) {
  for (std::size_t n = 0; n < character.nodes.size(); ++n) character.nodes[n].name = fmt::format("j{}", n);
  return character;
}

/// Finds joints without names of nodes. Prints those that differ from the joints found with names; returns all.
std::vector<Index> compare_without_names(const Character& character) {
  const auto named = find_joints(character), found = find_joints(without_names(character));
  const auto name = [&](Index node) { return node < 0 ? "none" : character.nodes[node].name.c_str(); };
  for (std::size_t j = 0; j < kJointCount; ++j)
    if (named[j] != found[j])
      std::printf("    without names %s: %s for %s\n", joint_names()[j].c_str(), name(found[j]), name(named[j]));
  return found;
}

void report_without_names(const Character& body, const Character& motion, const Clip& expected) {
  const Character nameless = without_names(motion);
  const auto ours = find_joints(body), found = compare_without_names(motion);
  if (found[0] < 0) return;
  const Clip got = retarget({body, ours}, {nameless, found}, nameless.clips.front(), kUp).clip;
  std::vector<Vec3> a(body.mesh.positions.size()), b(a.size());
  double max_distance = 0;
  for (int k = 0; k <= 10; ++k) {
    skin(body, pose_at(body, expected, expected.duration * k / 10), a);
    skin(body, pose_at(body, got, expected.duration * k / 10), b);
    for (std::size_t v = 0; v < a.size(); ++v) max_distance = std::max(max_distance, (a[v] - b[v]).norm());
  }
  std::printf("    without names off by %.3g mm\n", 1e3 * max_distance);
}

void report(const Character& body, const std::string& file, bool nameless) {
  assets::LoadedCharacter motion = assets::load_motion(file, {}, file);
  const auto ours = find_joints(body), theirs = find_joints(motion.character);
  if (mean_trunk({motion.character, theirs}, motion.character.clips.front()).dot(kUp) < 0.5)
    motion = assets::load_motion(file, {{}, scene::FileUp::z}, file);
  std::string missing;
  for (std::size_t j = 0; j < kJointCount; ++j)
    if (theirs[j] < 0 && ours[j] >= 0) missing += fmt::format(" {}", joint_names()[j]);
  if (theirs[0] < 0) throw std::runtime_error("no hips");
  const Clip& clip = motion.character.clips.front();
  const double begin = process_cpu_seconds();
  const Retargeted result = retarget({body, ours}, {motion.character, theirs}, clip, kUp);
  const double seconds = process_cpu_seconds() - begin;
  Follows f = measure({body, ours}, {motion.character, theirs}, clip, result.clip);
  measure_hands({body, ours}, {motion.character, theirs}, clip, result.clip, f);
  const std::string short_name = file.substr(file.rfind('/') + 1);
  std::printf(
      "| %s | %zu | %zu | %.1f (%.2f s) to %.1f | %.1f, %.1f, %.1f | %.1f %s | %.2g | %.1f (%.2f s) | %.0f (%zu), %.0f "
      "(%zu) "
      "| %.2f "
      "|%s\n",
      short_name.c_str(), f.keys, f.steps, 1e3 * f.below, f.when, 1e3 * f.above, 1e3 * f.slip, 1e3 * f.toes,
      1e3 * f.theirs, f.angle, f.bone.c_str(), f.arm, f.trunk, f.trunk_when, 1e3 * f.hands, f.hands_keys, 1e3 * f.hips,
      f.hips_keys, seconds, missing.empty() ? "" : (" without" + missing).c_str());
  for (const std::string& warning : result.warnings) std::printf("    %s\n", warning.c_str());
  report_ranges({body, ours}, {motion.character, theirs}, clip, result.clip);
  if (nameless) report_without_names(body, motion.character, result.clip);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Takes motions over to a body and prints how well it follows.");
  std::vector<std::string> files;
  std::string body_file;
  app.add_option("FILES", files, "BVH, glTF, FBX and so on, with a motion each")->required();
  app.add_option("--body", body_file, "a character from a file, with z up [the mannequin]");
  bool nameless = false;
  app.add_flag("--nameless", nameless, "also with nodes that are called j0, j1 and so on");
  CLI11_PARSE(app, argc, argv);
  const Character body =
      body_file.empty() ? make_mannequin({}) : assets::load_character(body_file, {}, body_file).character;
  std::printf(
      "| Motion | keys | steps | feet over the floor [mm] | slip of joint, of skin, of the motion's "
      "own joint [mm] | limb off by [°] | arm [°] | "
      "trunk [°] | hands off against each other, hips [mm] (keys) | CPU [s] |\n");
  if (nameless) compare_without_names(body);
  for (const std::string& file : files) {
    try {
      report(body, file, nameless);
    } catch (const std::exception& e) {
      std::printf("| %s | %s\n", file.c_str(), e.what());
    }
  }
  return 0;
}
