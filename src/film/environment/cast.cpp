#include "film/environment/cast.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.hpp"
#include "core/nearest.hpp"
#include "film/character/joints.hpp"

namespace weft::environment {

void Cast::fail(const std::string& key, const std::string& why) const {
  throw Error(ExitCode::scene_invalid, "{}.{}: {}", where, key, why);
}

Cast make_cast(const scene::Scene& scene, const scene::Character& settings) {
  return {scene, settings,
          fmt::format("{}:{}:{}: character.{}", scene.file.string(), settings.line, settings.column, settings.name)};
}

void check_start(const Cast& cast, const std::string& motion, double duration) {
  if (cast.settings.start > duration)
    cast.fail("start",
              fmt::format("expected a time of {}, at most {:g} s, got {:g}", motion, duration, cast.settings.start));
}

std::string did_you_mean(const std::string& name, const std::vector<std::string>& known) {
  const std::string nearest = nearest_name(name, known);
  return nearest.empty() ? "" : fmt::format("; did you mean \"{}\"?", nearest);
}

Index named_node(const Cast& cast, const std::string& key, const std::string& name,
                 const std::vector<character::Node>& nodes, const std::string& source) {
  std::vector<std::string> names;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    if (nodes[n].name == name) return static_cast<Index>(n);
    names.push_back(nodes[n].name);
  }
  cast.fail(key,
            fmt::format("expected the name of a node of {}, got \"{}\"{}", source, name, did_you_mean(name, names)));
}

std::vector<Index> joints_of(const Cast& cast, const std::vector<scene::JointNames>& given,
                             std::optional<std::string> scene::JointNames::*name, const character::Character& character,
                             const std::string& source) {
  std::vector<Index> joints = character::find_joints(character), named(joints.size(), -1);
  for (const scene::JointNames& joint : given) {
    const Index number = character::joint_number(joint.name);
    const std::string key = fmt::format("joint.{}", joint.name);
    if (number < 0)
      cast.fail(key + ".name", fmt::format("expected a joint of the body ({}), got \"{}\"{}",
                                           fmt::join(character::joint_names(), ", "), joint.name,
                                           did_you_mean(joint.name, character::joint_names())));
    if (joint.*name) named[number] = named_node(cast, key, *(joint.*name), character.nodes, source);
  }
  constexpr std::size_t kHips = character::joint_index(character::Joint::hips);  // every body must have them
  for (std::size_t j = 0; j < named.size(); ++j)
    for (std::size_t i = 0; i < j; ++i)
      if (named[j] >= 0 && named[i] == named[j] && i != kHips)
        cast.fail(fmt::format("joint.{}", character::joint_names()[j]),
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

}  // namespace weft::environment
