// A character of the scene with its name for messages, its body, and the nodes of its skeleton that are joints.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "film/assets/character_file.hpp"
#include "film/character/character.hpp"
#include "film/character/performance.hpp"
#include "film/scene/scene.hpp"

namespace weft::environment {

/// A body, and the clip that it plays (absent: it does not move).
struct Body {
  std::string source;  ///< its file, for messages
  character::Character character;
  std::optional<character::Clip> clip;
  std::vector<std::string> warnings;
  double scale = 1;                ///< metres per unit of the file, from the file or the scene
  std::vector<Index> joints = {};  ///< result of joints_of()
};

/// A character of the scene, and its name for messages.
struct CharacterContext {
  const scene::Scene& scene;
  const scene::Character& settings;
  std::string where;  ///< scene file, line, column and name, for messages

  Vec3 up() const { return scene::up_vector(scene.up); }
  assets::FileAxes axes() const { return {settings.scale, settings.up, scene.up}; }
  /// Start of the run [s].
  double begin() const { return scene.start_time(); }
  /// Time at which the character begins to move [s].
  double motion_start() const { return settings.dressing + begin(); }
  character::Timing timing() const { return {motion_start(), settings.blend, settings.start, settings.speed}; }

  /// Throws Error(scene_invalid) that names the key `key` of the character and the reason `why`.
  [[noreturn]] void fail(const std::string& key, const std::string& why) const;
};

CharacterContext make_character_context(const scene::Scene& scene, const scene::Character& settings);

/// Throws Error(scene_invalid) if the `start` of the character is after the end of a motion of this duration [s].
/// `motion`: what the message calls it.
void check_start(const CharacterContext& context, const std::string& motion, double duration);

/// "; did you mean ...?" with the most similar of the known names; empty if none is similar.
std::string did_you_mean(const std::string& name, const std::vector<std::string>& known);

/// The number of the node with the name `name`, which the scene gives in a [[character.joint]] or as the `bone` of a
/// [[character.part]]. `key`: key in the scene; `source`: the file of the nodes; both for messages. Throws
/// Error(scene_invalid) if there is no such node.
Index named_node(const CharacterContext& context, const std::string& key, const std::string& name,
                 const std::vector<character::Node>& nodes, const std::string& source);

/// For each of joint_names(), the node of a skeleton with that role; −1 if there is none. The names `given` in the
/// scene override the nodes that are found by common names. A node that the scene names as one joint is not found as
/// another, except as the hips. `name`: the member of JointNames that applies to this file; `source`: the file, for
/// messages. Throws Error(scene_invalid) for names in the scene that do not exist, and for a node that the scene names
/// as two joints, except the hips.
std::vector<Index> joints_of(const CharacterContext& context, const std::vector<scene::JointNames>& given,
                             std::optional<std::string> scene::JointNames::*name, const character::Character& character,
                             const std::string& source);

/// The clip with the name `name`; without a name, the first clip. `source`: file of the clips, for messages. Throws
/// Error(scene_invalid) if there is no such clip.
const character::Clip& choose_clip(const CharacterContext& context, const std::optional<std::string>& name,
                                   const std::vector<character::Clip>& clips, const std::string& source);

/// Throws Error(scene_invalid) if no node is the hips. `joints`: result of joints_of(); `source`: the file of the
/// nodes, for messages.
void check_hips(const CharacterContext& context, const std::vector<Index>& joints,
                const std::vector<character::Node>& nodes, const std::string& source);

}  // namespace weft::environment
