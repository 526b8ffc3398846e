#include "film/environment/body_parts.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "film/character/joints.hpp"
#include "film/character/parts.hpp"
#include "physics/mesh/topology.hpp"

namespace weft::environment {
namespace {

/// Finds the vertices of a part by its bone, material or name.
class PartFinder {
 public:
  PartFinder(const CharacterContext& context, const Body& body) : context_(context), body_(body) {}

  /// The vertices of a part. Throws if the part contains no triangle. `key`: key of the part in the scene, for
  /// messages.
  character::VertexMask find(const scene::BodyPart& part, const std::string& key) const {
    character::VertexMask mask = vertices_of(part, key);
    const auto holds = [&](const auto& t) { return mask[t[0]] + mask[t[1]] + mask[t[2]] >= 2; };
    if (std::ranges::none_of(body_.character.mesh.topology.triangles, holds))
      context_.fail(key, fmt::format("expected a part with vertices of {}, got \"{}\", which holds none", body_.source,
                                     part.bone.value_or(part.material.value_or(part.name))));
    return mask;
  }

 private:
  character::VertexMask vertices_of(const scene::BodyPart& part, const std::string& key) const {
    const character::Character& body = body_.character;
    if (part.bone)
      return character::vertices_below(body, named_node(context_, key + ".bone", *part.bone, body.nodes, body_.source));
    if (part.material) {
      const auto found = std::ranges::find(body.materials, *part.material);
      if (found != body.materials.end())
        return character::vertices_of_material(body, static_cast<Index>(found - body.materials.begin()));
      context_.fail(key + ".material", fmt::format("expected a material of {}, got \"{}\"{}", body_.source,
                                                   *part.material, did_you_mean(*part.material, body.materials)));
    }
    const std::vector<Index> joints = character::joints_of_part(part.name);
    if (joints.empty())
      context_.fail(key, fmt::format("expected {} or a joint, or a part with bone or material, got \"{}\"{}",
                                     "hands, feet, arms, legs, head, torso", part.name,
                                     did_you_mean(part.name, character::part_names())));
    return character::vertices_of(body, body_.joints, joints);
  }

  const CharacterContext& context_;
  const Body& body_;
};

/// Whether the scene has a [[character.part]] that includes a hand.
bool has_hand_settings(const std::vector<scene::BodyPart>& parts) {
  const std::vector<Index> hands = character::joints_of_part("hands");
  return std::ranges::any_of(parts, [&](const scene::BodyPart& part) {
    const std::vector<Index> joints = character::joints_of_part(part.name);
    return !part.bone && !part.material &&
           std::ranges::any_of(hands, [&](Index hand) { return std::ranges::find(joints, hand) != joints.end(); });
  });
}

scene::BodyPart part_named(const std::string& name) {
  scene::BodyPart part;
  part.name = name;
  return part;
}

}  // namespace

std::vector<Part> parts_of(const CharacterContext& context, std::span<const FollowerPoints> following, Body& body) {
  const PartFinder finder(context, body);
  std::vector<scene::BodyPart> wanted = context.settings.parts;
  if (!has_hand_settings(wanted) && context.settings.collide && character::has_fingers(body.character, body.joints)) {
    wanted.push_back(part_named("hands"));
    wanted.back().collide = false;
    body.warnings.push_back(
        fmt::format("{}: the hands have fingers, which would catch cloth: cloth passes through them; to let them "
                    "collide, write [[character.part]] name = \"hands\"",
                    context.where));
  }
  const std::size_t settings = wanted.size();
  for (const FollowerPoints& pin : following)
    if (!pin.part.empty() && std::ranges::find(wanted, pin.part, &scene::BodyPart::name) == wanted.end())
      wanted.push_back(part_named(pin.part));
  std::vector<Part> parts;
  for (const scene::BodyPart& part : wanted)
    parts.push_back({part.name, finder.find(part, "part." + part.name), part.collide, part.friction, part.thickness,
                     parts.size() >= settings});
  return parts;
}

std::vector<Index> shells_of_limbs(const Body& body) {
  const std::vector<character::Limb> limbs = character::limbs_of(body.character, body.joints);
  std::vector<Index> shells = mesh::components(body.character.mesh.topology.triangles, limbs.size());
  constexpr Index kLimbCount = static_cast<Index>(character::Limb::right_leg) + 1;
  for (std::size_t v = 0; v < limbs.size(); ++v) shells[v] = shells[v] * kLimbCount + static_cast<Index>(limbs[v]);
  return shells;
}

}  // namespace weft::environment
