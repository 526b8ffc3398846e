// Converts animations of assimp to clips, with times in seconds; rejects damaged ones.
#pragma once

#include <assimp/scene.h>

#include <map>
#include <string>
#include <vector>

#include "film/character/character.hpp"

namespace weft::assets {

/// Objects that channels refer to by name.
struct ClipTargets {
  std::map<std::string, Index> nodes;
  /// The morph targets of one mesh: first target and count. `morphs` finds them by the names of the mesh and its nodes.
  struct Morphs {
    Index first = 0, count = 0;
  };
  std::multimap<std::string, Morphs> morphs;
};

/// Converts an animation. Warns if it skips channels of unknown objects or second channels of a node, and if it extends
/// the clip to keys past its end (by more than rounding errors). Throws std::runtime_error that names clip and channel
/// if times run backwards or exceed a day, or numbers are not finite.
character::Clip to_clip(const aiAnimation& animation, const ClipTargets& targets, std::vector<std::string>& warnings);

}  // namespace weft::assets
