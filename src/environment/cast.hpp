// A character of the scene with its file, how messages name it, and which nodes of its skeleton are which joints.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "assets/character_file.hpp"
#include "character/character.hpp"
#include "character/performance.hpp"
#include "scene/scene.hpp"

namespace weft::environment {

/// What there is to be sampled.
struct Body {
  std::string source;  ///< for messages: the file it is from
  character::Character character;
  std::optional<character::Clip> clip;
  std::vector<std::string> warnings;
  double scale = 1;  ///< metres per unit of the file, as it or the scene says
};

/// A character of the scene, and how messages name it.
struct Cast {
  const scene::Scene& scene;
  const scene::Character& settings;
  std::string where;

  Vec3 up() const { return scene.up == scene::UpAxis::z ? Vec3::UnitZ() : Vec3::UnitY(); }
  assets::FileAxes axes() const { return {settings.scale, settings.up, scene.up}; }
  /// When it begins to move [s].
  double leaves() const { return settings.dressing - scene.preroll_frames() / scene.time.fps; }
  character::Timing timing() const { return {leaves(), settings.blend, settings.start, settings.speed}; }

  /// Throws Error(scene_invalid) for a key of it.
  [[noreturn]] void fail(const std::string& key, const std::string& why) const;
};

Cast make_cast(const scene::Scene& scene, const scene::Character& settings);

/// "; did you mean ...?", or nothing.
std::string did_you_mean(const std::string& name, const std::vector<std::string>& known);

/// The node of a file that a [[character.joint]] names. Throws Error(scene_invalid) where there is none.
Index named_node(const Cast& cast, const std::string& key, const std::string& name,
                 const std::vector<character::Node>& nodes, const std::string& source);

/// The nodes of a skeleton that have the parts of joint_names(), found by their names or as the scene says; −1 for
/// those that are not found. Throws Error(scene_invalid) for names that are none.
std::vector<Index> joints_of(const Cast& cast, const std::vector<scene::JointNames>& given,
                             std::optional<std::string> scene::JointNames::*name, const character::Character& character,
                             const std::string& source);

}  // namespace weft::environment
