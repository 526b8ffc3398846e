// Converts animations of assimp to clips in seconds, with checks.
#pragma once

#include <assimp/scene.h>

#include <map>
#include <string>
#include <vector>

#include "character/character.hpp"

namespace weft::assets {

/// Objects that channels refer to by name.
struct ClipTargets {
  std::map<std::string, Index> nodes;
  /// Morph targets by the names of their mesh and of the nodes that show it: first target and count.
  struct Morphs {
    Index first = 0, count = 0;
  };
  std::multimap<std::string, Morphs> morphs;
};

/// Skips channels of unknown objects and second channels of a node, and extends the clip to keys past its end, with
/// warnings (none for ends within rounding errors). Throws std::runtime_error naming clip and channel for times that
/// run backwards and non-finite numbers.
character::Clip to_clip(const aiAnimation& animation, const ClipTargets& targets, std::vector<std::string>& warnings);

}  // namespace weft::assets
