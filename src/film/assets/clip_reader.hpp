// Converts animations of assimp to clips with times in seconds.
#pragma once

#include <assimp/scene.h>

#include <map>
#include <set>
#include <string>
#include <vector>

#include "film/character/character.hpp"

namespace weft::assets {

/// The objects that channels of animations name.
struct ClipTargets {
  std::map<std::string, Index> nodes;  ///< by name: index of the node
  /// The morph targets of one mesh: first index and count. `morphs`: by the names of the mesh and of its nodes.
  struct Morphs {
    Index first = 0, count = 0;
  };
  std::multimap<std::string, Morphs> morphs;
  std::set<std::string> left_out;  ///< names of meshes that are not read, and of their nodes
};

/// Converts an animation. Skips channels of unknown objects, and the second and later channels of a node, with a
/// warning; skips weights of meshes that are not read. If keys are after the end of the clip, extends the clip to the
/// last key, with a warning unless the difference is a rounding error. Throws std::runtime_error that names the clip if
/// its length is a day or more, and one that names clip and channel if key times decrease, if a key time is a day or
/// more, if numbers are not finite, or if a key names a morph target that does not exist.
character::Clip to_clip(const aiAnimation& animation, const ClipTargets& targets, std::vector<std::string>& warnings);

}  // namespace weft::assets
