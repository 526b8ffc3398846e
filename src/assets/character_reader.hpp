// From assimp's scene to a character.
#pragma once

#include <assimp/scene.h>

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "character/character.hpp"

namespace weft::assets {

/// A character in the unit and axes of its file, and what the file says about them.
struct ReadCharacter {
  character::Character character;
  std::optional<double> metres_per_unit;
  std::optional<int> up;              ///< axis that points up: 0 x, 1 y, 2 z
  std::vector<std::string> warnings;  ///< what was mended or left out, by the names of the parts
};

/// Which meshes of a file a character has, by their names or those of their nodes.
struct MeshChoice {
  std::vector<std::string> only;       ///< empty: all
  std::vector<std::string> without;    ///< not these
  std::vector<std::string> elsewhere;  ///< nor these, which may be missing: cloths have them
};

/// Takes over nodes, meshes with their weights and morph targets, and animations. Bones of all meshes are merged into
/// one list; a mesh without bones becomes one that a bone at its own node holds, once for each node that shows it.
/// Throws std::runtime_error naming the part that cannot be used: indices out of range, numbers that are not finite,
/// bones that no node belongs to, key times that run backwards, names of the choice that nothing has. Pictures are
/// looked for beside `file`; none where that is empty.
ReadCharacter to_character(const aiScene& scene, const std::filesystem::path& file, const MeshChoice& choice = {});

/// The same as plain bytes, for the way between two processes of the same program, and back.
std::string to_bytes(ReadCharacter& read);
ReadCharacter character_from_bytes(std::string_view bytes);

}  // namespace weft::assets
