// Animations as assimp gives them, checked and in seconds.
#pragma once

#include <assimp/scene.h>

#include <map>
#include <string>
#include <vector>

#include "character/character.hpp"

namespace weft::assets {

/// Where the parts that channels name are to be found.
struct ClipTargets {
  std::map<std::string, Index> nodes;
  /// Morph targets of the meshes by the name of the mesh and of the nodes that show it: first target of each, and how
  /// many it has.
  struct Morphs {
    Index first = 0, count = 0;
  };
  std::multimap<std::string, Morphs> morphs;
};

/// Channels that name nothing are left out, keys past the end lengthen the clip; both are warned about. Throws
/// std::runtime_error naming clip and channel for times that run backwards and numbers that are not finite.
character::Clip to_clip(const aiAnimation& animation, const ClipTargets& targets, std::vector<std::string>& warnings);

}  // namespace weft::assets
