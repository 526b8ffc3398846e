#include "film/environment/character_context.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.hpp"
#include "core/nearest.hpp"
#include "film/character/joints.hpp"

namespace weft::environment {

void CharacterContext::fail(const std::string& key, const std::string& why) const {
  throw Error(ExitCode::scene_invalid, "{}.{}: {}", where, key, why);
}

CharacterContext make_character_context(const scene::Scene& scene, const scene::Character& settings) {
  return {scene, settings,
          fmt::format("{}:{}:{}: character.{}", scene.file.string(), settings.line, settings.column, settings.name)};
}

void check_start(const CharacterContext& context, const std::string& motion, double duration) {
  if (context.settings.start > duration)
    context.fail("start", fmt::format("expected a time of {}, at most {:g} s, got {:g}", motion, duration,
                                      context.settings.start));
}

std::string did_you_mean(const std::string& name, const std::vector<std::string>& known) {
  const std::string nearest = nearest_name(name, known);
  return nearest.empty() ? "" : fmt::format("; did you mean \"{}\"?", nearest);
}

Index named_node(const CharacterContext& context, const std::string& key, const std::string& name,
                 const std::vector<character::Node>& nodes, const std::string& source) {
  std::vector<std::string> names;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    if (nodes[n].name == name) return static_cast<Index>(n);
    names.push_back(nodes[n].name);
  }
  context.fail(key,
               fmt::format("expected the name of a node of {}, got \"{}\"{}", source, name, did_you_mean(name, names)));
}

std::vector<Index> joints_of(const CharacterContext& context, const std::vector<scene::JointNames>& given,
                             std::optional<std::string> scene::JointNames::*name, const character::Character& character,
                             const std::string& source) {
  std::vector<Index> joints = character::find_joints(character), named(joints.size(), -1);
  for (const scene::JointNames& joint : given) {
    const Index number = character::joint_number(joint.name);
    const std::string key = fmt::format("joint.{}", joint.name);
    if (number < 0)
      context.fail(key + ".name", fmt::format("expected a joint of the body ({}), got \"{}\"{}",
                                              fmt::join(character::joint_names(), ", "), joint.name,
                                              did_you_mean(joint.name, character::joint_names())));
    if (joint.*name) named[number] = named_node(context, key, *(joint.*name), character.nodes, source);
  }
  constexpr std::size_t kHips = character::joint_index(character::Joint::hips);  // every body must have them
  for (std::size_t j = 0; j < named.size(); ++j)
    for (std::size_t i = 0; i < j; ++i)
      if (named[j] >= 0 && named[i] == named[j] && i != kHips)
        context.fail(fmt::format("joint.{}", character::joint_names()[j]),
                     fmt::format("expected a node of {} that is no other joint, got \"{}\", which is {} too", source,
                                 character.nodes[named[j]].name, character::joint_names()[i]));
  for (std::size_t j = 0; j < joints.size(); ++j) {
    if (named[j] >= 0)
      joints[j] = named[j];
    else if (j != kHips && std::ranges::find(named, joints[j]) != named.end())
      joints[j] = -1;
  }
  return joints;
}

const character::Clip& choose_clip(const CharacterContext& context, const std::optional<std::string>& name,
                                   const std::vector<character::Clip>& clips, const std::string& source) {
  if (!name) return clips.front();
  std::vector<std::string> names;
  for (const character::Clip& clip : clips) {
    if (clip.name == *name) return clip;
    names.push_back(clip.name);
  }
  if (names.empty())
    context.fail("clip", fmt::format("expected an animation in {}, got none; leave the key out", source));
  context.fail("clip", fmt::format("expected one of the {} clips of {}, \"{}\", got \"{}\"{}", names.size(), source,
                                   fmt::join(names, "\", \""), *name, did_you_mean(*name, names)));
}

void check_hips(const CharacterContext& context, const std::vector<Index>& joints,
                const std::vector<character::Node>& nodes, const std::string& source) {
  if (joints[character::joint_number("Hips")] >= 0) return;
  std::vector<std::string> names;
  for (const character::Node& node : nodes) names.push_back(node.name);
  context.fail("joint", fmt::format("expected a node of {} that is known as the hips, got \"{}\"; name each joint in a "
                                    "[[character.joint]], the hips with name = \"Hips\"",
                                    source, fmt::join(names, "\", \"")));
}

}  // namespace weft::environment
