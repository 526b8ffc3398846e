#include "film/character/mannequin.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "film/character/figure.hpp"
#include "film/character/mannequin_shape.hpp"
#include "film/character/mannequin_skin.hpp"
#include "physics/mesh/isosurface.hpp"

namespace weft::character {
namespace {

constexpr int kRemeshRounds = 8;  ///< further rounds change the smallest angle of the mesh by less than 1°

constexpr std::size_t kFirstLeft = 5, kFirstRight = kFirstLeft + kSideJointCount;

constexpr double kMaxHandEdge = 0.02;  ///< maximum edge length on head and hands of a body of 1.75 m [m]

constexpr double kSoleRounding = 0.012;  ///< rounding between sole and side of a foot [m], for a height of 1.75 m

/// The body with flat soles: cuts off the part below the floor.
mesh::Field standing_on_floor(const BlendedBody& body, double height) {
  const double rim = kSoleRounding * height / 1.75;
  return [&body, rim](const Vec3& p) { return -smooth_min(-body(p), p.z(), rim); };
}

/// Target edge length [m]: shorter where the body is thin or strongly curved (arms, hands, shins, feet, neck, head,
/// between the legs and under the arms). In coarse bodies, kMaxHandEdge limits the edge length of head and hands, so
/// that face and fingers keep their shape.
mesh::Sizing edge_lengths(const MannequinBuild& build, const std::array<Vec3, kJointCount>& joints) {
  const double unit = build.height / 1.75, edge = build.edge_length, fine = std::min(edge, kMaxHandEdge * unit);
  const double wrist = joints[joint_index(Joint::left_hand)].x(),
               shoulder = joints[joint_index(Joint::left_upper_arm)].x();
  const Vec3 crotch(0, 0, 0.78 * unit), armpit(0.82 * shoulder, 0, 1.31 * unit);
  const Vec3 nose(0, -0.095 * unit, 1.61 * unit), ear(0.078 * unit, 0.019 * unit, 1.627 * unit);
  return [=](const Vec3& p) {
    const double arm = 0.5 * smooth_ramp(p.x(), shoulder, wrist);
    const double leg = 1 - smooth_ramp(p.z(), 0, 0.4 * unit);
    const double neck = smooth_ramp(p.z(), 1.38 * unit, 1.52 * unit);
    const double fold = std::min((p - crotch).norm(), (p - armpit).norm());
    const double folds = 1 - smooth_ramp(fold, 0.02 * unit, 0.11 * unit);
    // Edge lengths change gradually toward head and hands.
    const double away = std::max(std::min(1.5 * unit - p.z(), 1.4 * (wrist - p.x())), 0.0);
    const double max_length = 0.5 * fine + 0.6 * away;
    const double coarse = std::min(edge * (1 - std::max({arm, 0.5 * leg, 0.3 * neck, 0.4 * folds})), max_length);
    const double hand = smooth_ramp(p.x(), wrist - 0.01 * unit, wrist + 0.05 * unit);
    const double head = smooth_ramp(p.z(), 1.50 * unit, 1.55 * unit);
    const double face = std::max(1 - smooth_ramp((p - nose).norm(), 0.05 * unit, 0.10 * unit),
                                 1 - smooth_ramp((p - ear).norm(), 0.03 * unit, 0.06 * unit));
    const double wanted = fine * std::min(1 - 0.75 * hand, 1 - 0.55 * head * (1 + 0.38 * face));
    return std::max({hand, head}) > 0 ? std::min(coarse, wanted) : coarse;
  };
}

mesh::MirroredMesh make_skin(const MannequinBuild& build, const std::array<Vec3, kJointCount>& joints) {
  const BlendedBody body = mannequin_body(build);
  const mesh::Field field = standing_on_floor(body, build.height);
  const Box3 bounds = body.bounds();
  const Vec3 spare = Vec3::Constant(kSoleRounding * build.height);
  // Cells are fine enough for fingers and for the gap between the thighs.
  const double cell = std::min(0.7 * build.edge_length, 0.0075 * build.height / 1.75);
  mesh::Mesh half = mesh::march_half_space(field, Box3(bounds.min() - spare, bounds.max() + spare), cell);
  mesh::remesh(half, field, edge_lengths(build, joints), kRemeshRounds);
  return mesh::join_mirror_image(half);
}

/// The number of the same joint on the other side; for a joint of the trunk, its own number.
std::size_t mirrored(std::size_t joint) {
  if (joint < kFirstLeft) return joint;
  return joint < kFirstRight ? joint + kSideJointCount : joint - kSideJointCount;
}

void bind_skin(Character& character, const mesh::MirroredMesh& skin, const std::array<Vec3, kJointCount>& joints,
               double height) {
  for (const Vec3& p : skin.mesh.positions) {
    character.first_influence.push_back(static_cast<Index>(character.influences.size()));
    const bool right = p.x() < 0;
    const auto weights = mannequin_weights(joints, height, Vec3(std::abs(p.x()), p.y(), p.z()));
    for (std::size_t j = 0; j < kJointCount; ++j) {
      const double w = weights[right ? mirrored(j) : j];
      if (w > 0) character.influences.push_back({static_cast<Index>(j), w});
    }
  }
  character.first_influence.push_back(static_cast<Index>(character.influences.size()));
}

}  // namespace

std::array<Vec3, kJointCount> mannequin_joints(const MannequinBuild& build) {
  // Fractions of the height, from Drillis & Contini (1966): ankle 0.039, knee 0.285, hip 0.530, shoulder 0.818 less
  // half of the thickness of a shoulder, upper arm 0.186, forearm 0.146.
  const double h = build.height, cm = h / 175;
  const double wide = 1 + 0.2 * build.masculinity;
  std::array<Vec3, kJointCount> at{};
  const auto set = [&](Joint joint, double x, double forward, double up) {
    at[joint_index(joint)] = Vec3(x, -forward, up);
  };
  set(Joint::hips, 0, 0, 0.545 * h);
  set(Joint::spine, 0, -1.5 * cm, 106 * cm);
  set(Joint::chest, 0, -2.0 * cm, 119 * cm);
  set(Joint::neck, 0, -3.0 * cm, 146 * cm);
  set(Joint::head, 0, -0.2 * cm, 155.5 * cm);
  set(Joint::left_shoulder, 3 * cm, -1.5 * cm, 141 * cm);
  set(Joint::left_upper_arm, 16.4 * wide * cm, -1.4 * cm, 139 * cm);
  const Vec3 down(std::sqrt(0.5), 0, -std::sqrt(0.5));
  at[joint_index(Joint::left_lower_arm)] = at[joint_index(Joint::left_upper_arm)] + 0.186 * h * down;
  at[joint_index(Joint::left_hand)] = at[joint_index(Joint::left_lower_arm)] + 0.146 * h * down;
  set(Joint::left_upper_leg, 8.7 * cm, 0, 0.530 * h);
  set(Joint::left_lower_leg, 10.2 * cm, 0.1 * cm, 0.285 * h);
  set(Joint::left_foot, 11.0 * cm, -1.3 * cm, 0.039 * h);
  set(Joint::left_toes, 12.2 * cm, 11.2 * cm, 0.8 * cm);
  for (std::size_t j = 0; j < kSideJointCount; ++j) {
    at[kFirstRight + j] = at[kFirstLeft + j].cwiseProduct(Vec3(-1, 1, 1));
  }
  return at;
}

namespace {

Character build_character(const MannequinBuild& build) {
  const auto joints = mannequin_joints(build);
  Character character;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const auto joint = static_cast<Joint>(j);
    Node node{std::string(name(joint)), joint == Joint::hips ? -1 : static_cast<Index>(joint_index(parent(joint)))};
    node.local =
        Eigen::Translation3d(joint == Joint::hips ? joints[j] : Vec3(joints[j] - joints[joint_index(parent(joint))]));
    character.nodes.push_back(node);
    character.bones.push_back({static_cast<Index>(j), Affine(Eigen::Translation3d(-joints[j]))});
  }
  mesh::MirroredMesh skin = make_skin(build, joints);
  bind_skin(character, skin, joints, build.height);
  character.mesh = std::move(skin.mesh);
  character.coloring = paint_figure(character.mesh, build);
  return character;
}

}  // namespace

Character make_mannequin(const MannequinBuild& build) {
  static std::mutex mutex;
  static MannequinBuild last_build;
  static std::optional<Character> last;
  const std::lock_guard lock(mutex);
  if (!last || build != last_build) {
    last.reset();
    last = build_character(build);
    last_build = build;
  }
  return *last;
}

}  // namespace weft::character
