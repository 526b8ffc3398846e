// Converts animations of assimp to clips with times in seconds.
#pragma once

#include <assimp/scene.h>

#include <map>
#include <string>
#include <vector>

#include "film/character/character.hpp"

namespace weft::assets {

/// The objects that channels of animations name.
struct ClipTargets {
  std::map<std::string, Index> nodes;
  /// The morph targets of one mesh: first index and count. `morphs`: by the names of the mesh and of its nodes.
  struct Morphs {
    Index first = 0, count = 0;
  };
  std::multimap<std::string, Morphs> morphs;
};

/// Converts an animation. Warns of skipped channels (those of unknown objects, and second ones of a node), and of keys
/// past the end of the clip, to which the clip is extended. Throws std::runtime_error that names clip and channel if
/// key times decrease or exceed a day, or if numbers are not finite.
character::Clip to_clip(const aiAnimation& animation, const ClipTargets& targets, std::vector<std::string>& warnings);

}  // namespace weft::assets
