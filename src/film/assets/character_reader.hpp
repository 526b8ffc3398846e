// Converts a file that assimp has read (aiScene) to a character.
#pragma once

#include <assimp/scene.h>

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "film/character/character.hpp"

namespace weft::assets {

/// A character in the unit and axes of its file.
struct ReadCharacter {
  character::Character character;
  std::optional<double> metres_per_unit;  ///< as the file states; absent: not stated
  std::optional<int> up;                  ///< result of up_axis(); to_character() leaves it absent
  std::vector<std::string> warnings;      ///< about repaired or skipped parts, with their names
};

/// Selects meshes of a file for a character, by the names of meshes or of their nodes.
struct MeshChoice {
  std::vector<std::string> only;       ///< meshes to use; empty: all
  std::vector<std::string> without;    ///< meshes to leave out
  std::vector<std::string> elsewhere;  ///< meshes to leave out because cloths use them; may contain unknown names
};

/// Converts nodes, meshes with their weights and morph targets, and animations. All meshes share one list of bones. A
/// mesh without bones is copied for each node that refers to it, and each copy is bound to a bone at its node. Reads
/// pictures with read_materials(); if `file` is empty, reads none. Throws std::runtime_error that names the unusable
/// part in these cases: indices out of range, non-finite numbers, bones without a node, decreasing key times, unknown
/// names in `choice.only` or `choice.without`.
ReadCharacter to_character(const aiScene& scene, const std::filesystem::path& file, const MeshChoice& choice = {});

/// Serialises a character that was read from a file, for transfer between two processes of the same program.
std::string to_bytes(ReadCharacter& read);
/// The reverse of to_bytes(). Throws std::runtime_error if the data are incomplete.
ReadCharacter character_from_bytes(std::string_view bytes);

}  // namespace weft::assets
