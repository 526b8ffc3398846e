#include "film/environment/wearers.hpp"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <optional>
#include <system_error>
#include <variant>

#include "core/error.hpp"
#include "film/character/joints.hpp"
#include "film/environment/actor.hpp"
#include "physics/mesh/geometry.hpp"

namespace weft::environment {
namespace {

using Joints = std::vector<std::optional<Vec3>>;

const std::optional<Vec3>& joint(const Joints& joints, const std::string& name) {
  return joints[character::joint_number(name)];
}

/// Axes of a body whose left side is in the horizontal direction `left`: x to the left, z up. The origin is below
/// `middle`, at the height of the lowest vertex.
Eigen::Isometry3d axes_at(const Vec3& middle, const Vec3& left, const StandingBody& standing, const Vec3& up) {
  double floor = std::numeric_limits<double>::infinity();
  for (const Vec3& x : standing.mesh.positions) floor = std::min(floor, up.dot(x));
  Eigen::Isometry3d axes = Eigen::Isometry3d::Identity();
  axes.linear() << left, up.cross(left), up;
  axes.translation() = middle + (floor - up.dot(middle)) * up;
  return axes;
}

/// Axes of a wearer: x to its left, z up. The origin is below the midpoint between its upper-leg joints or, if these
/// are unknown, its upper-arm joints. Absent if both are unknown.
std::optional<Eigen::Isometry3d> axes_by_joints(const StandingBody& standing, const Vec3& up) {
  for (const char* name : {"UpperLeg", "UpperArm"}) {
    const auto &left = joint(standing.joints, std::string("Left") + name),
               &right = joint(standing.joints, std::string("Right") + name);
    if (!left || !right) continue;
    Vec3 across = *left - *right;
    across -= across.dot(up) * up;
    if (across.norm() == 0) continue;
    across.normalize();
    const Vec3 middle = 0.5 * (*left + *right);
    return axes_at(middle, across, standing, up);
  }
  return std::nullopt;
}

/// Estimates the positions of hands that a rig lacks, because garment::Limb needs a hand: it is at the mean position of
/// the skin of its arm beyond the elbow.
void estimate_hands(const StandingBody& standing, Joints& joints) {
  for (const bool left : {true, false}) {
    const std::string side = left ? "Left" : "Right";
    const character::Limb arm = left ? character::Limb::left_arm : character::Limb::right_arm;
    const auto &shoulder = joint(joints, side + "UpperArm"), &elbow = joint(joints, side + "LowerArm");
    if (!shoulder || !elbow || joint(joints, side + "Hand")) continue;
    Vec3 sum = Vec3::Zero();
    double count = 0;
    for (std::size_t v = 0; v < standing.limbs.size(); ++v) {
      const Vec3& x = standing.mesh.positions[v];
      if (standing.limbs[v] != arm || (x - *elbow).dot(*elbow - *shoulder) <= 0) continue;
      sum += x;
      ++count;
    }
    if (count > 0) joints[character::joint_number(side + "Hand")] = Vec3(sum / count);
  }
}

garment::Wearer make_wearer(const StandingBody& standing, const Eigen::Isometry3d& axes) {
  Joints known = standing.joints;
  estimate_hands(standing, known);
  garment::Wearer wearer;
  wearer.to_world = axes;
  const Eigen::Isometry3d to_own = wearer.to_world.inverse();
  for (const Vec3& x : standing.mesh.positions) wearer.skin.push_back(to_own * x);
  wearer.triangles = standing.mesh.topology.triangles;
  const auto region_of = [](character::Limb limb) {
    switch (limb) {
      case character::Limb::left_arm:
        return garment::Region::left_arm;
      case character::Limb::right_arm:
        return garment::Region::right_arm;
      case character::Limb::left_leg:
        return garment::Region::left_leg;
      case character::Limb::right_leg:
        return garment::Region::right_leg;
      case character::Limb::trunk:
        break;
    }
    return garment::Region::trunk;
  };
  for (const character::Limb limb : standing.limbs) wearer.regions.push_back(region_of(limb));
  const auto limb = [&](const std::string& side, const std::array<const char*, 3>& names) {
    std::optional<garment::Limb> joints(std::in_place);
    for (std::size_t k = 0; k < names.size(); ++k) {
      const auto& place = joint(known, side + names[k]);
      if (!place) return std::optional<garment::Limb>();
      (*joints)[k] = to_own * *place;
    }
    return joints;
  };
  constexpr std::array kArm{"UpperArm", "LowerArm", "Hand"}, kLeg{"UpperLeg", "LowerLeg", "Foot"};
  wearer.left_arm = limb("Left", kArm), wearer.right_arm = limb("Right", kArm);
  wearer.left_leg = limb("Left", kLeg), wearer.right_leg = limb("Right", kLeg);
  // Height of the base of the neck: that of the joint Neck. If a rig has no neck, its joint Head is at this place. If
  // it has neither, the height of the body gives an estimate.
  double crown = 0;
  for (const Vec3& x : wearer.skin) crown = std::max(crown, x.z());
  wearer.neck = garment::kNeckHeightRatio * crown;
  for (const char* name : {"Head", "Neck"})
    if (const auto& base = joint(known, name)) wearer.neck = (to_own * *base).z();
  return wearer;
}

}  // namespace

const garment::Wearer& Wearers::of(const scene::Cloth& cloth, const std::string& where) {
  const auto& characters = scene_.characters;
  if (characters.empty())
    throw Error(ExitCode::scene_invalid, "{}: expected a [[character]] that wears the garment, as {}; got none; {}",
                where, cloth.fit ? "fit = true scales it to a body" : "its panels start around parts of a body",
                cloth.fit ? "add one, or leave out fit" : "add one");
  if (cloth.wearer.empty() && characters.size() > 1)
    throw Error(ExitCode::scene_invalid, "{}: expected the wearer, one of {} characters such as {}, got none", where,
                characters.size(), characters[0].name);
  return of(cloth.wearer.empty() ? characters[0].name : cloth.wearer, where);
}

const garment::Wearer& Wearers::of(const std::string& name, const std::string& where) {
  const garment::Wearer& wearer = carrier(name, where);
  if (without_axes_.contains(name))
    throw Error(ExitCode::scene_invalid,
                "{}: expected a wearer that stands upright with two joints UpperLeg or UpperArm, got one without; "
                "[[character.joint]] names them",
                where);
  return wearer;
}

const garment::Wearer& Wearers::carrier(const std::string& name, const std::string& where) {
  const auto known = made_.find(name);
  if (known != made_.end()) return known->second;
  const auto found = std::ranges::find(scene_.characters, name, &scene::Character::name);
  const Vec3 up = scene::up_vector(scene_.up);
  const StandingBody standing = make_standing_body(scene_, *found, where);
  std::optional<Eigen::Isometry3d> axes = axes_by_joints(standing, up);
  if (!axes) {
    without_axes_.insert(name);
    axes = axes_at(mesh::bounding_box(standing.mesh.positions).center(), Vec3::UnitX(), standing, up);
  }
  return made_.emplace(name, make_wearer(standing, *axes)).first->second;
}

Vec3 Wearers::offset_in_file(const scene::Cloth& cloth) {
  if (cloth.object.empty()) return Vec3::Zero();
  std::error_code ignored;
  for (const scene::Character& character : scene_.characters) {
    const auto* source = std::get_if<scene::CharacterFile>(&character.source);
    if (source == nullptr || !std::filesystem::equivalent(source->path, cloth.file, ignored)) continue;
    const auto known = offsets_.find(character.name);
    if (known != offsets_.end()) return known->second;
    return offsets_[character.name] = environment::offset_in_file(scene_, character);
  }
  return Vec3::Zero();
}

}  // namespace weft::environment
