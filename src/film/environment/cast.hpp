// A character of the scene with its file, its name in messages, and the nodes of its skeleton that are joints.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "film/assets/character_file.hpp"
#include "film/character/character.hpp"
#include "film/character/performance.hpp"
#include "film/scene/scene.hpp"

namespace weft::environment {

/// A body, and the data for sampling its motion.
struct Body {
  std::string source;  ///< its file, for messages
  character::Character character;
  std::optional<character::Clip> clip;
  std::vector<std::string> warnings;
  double scale = 1;  ///< metres per unit of the file, from the file or the scene
};

/// A character of the scene, and its name in messages.
struct Cast {
  const scene::Scene& scene;
  const scene::Character& settings;
  std::string where;

  Vec3 up() const { return scene.up == scene::UpAxis::z ? Vec3::UnitZ() : Vec3::UnitY(); }
  assets::FileAxes axes() const { return {settings.scale, settings.up, scene.up}; }
  /// Time at which the character begins to move [s].
  double motion_start() const { return settings.dressing - scene.preroll_frames() / scene.time.fps; }
  character::Timing timing() const { return {motion_start(), settings.blend, settings.start, settings.speed}; }

  /// Throws Error(scene_invalid) for one of the character's keys.
  [[noreturn]] void fail(const std::string& key, const std::string& why) const;
};

Cast make_cast(const scene::Scene& scene, const scene::Character& settings);

/// "; did you mean ...?", or an empty text.
std::string did_you_mean(const std::string& name, const std::vector<std::string>& known);

/// The node of a file that a [[character.joint]] or the `bone` of a [[character.part]] names. Throws
/// Error(scene_invalid) if there is none.
Index named_node(const Cast& cast, const std::string& key, const std::string& name,
                 const std::vector<character::Node>& nodes, const std::string& source);

/// The nodes of a skeleton that are the joints of joint_names(), found by their usual names or as the scene says; −1
/// for a joint that is not found. `name`: the member of JointNames for this file; `source`: the file, for messages.
/// Throws Error(scene_invalid) for names of the scene that do not exist.
std::vector<Index> joints_of(const Cast& cast, const std::vector<scene::JointNames>& given,
                             std::optional<std::string> scene::JointNames::*name, const character::Character& character,
                             const std::string& source);

}  // namespace weft::environment
