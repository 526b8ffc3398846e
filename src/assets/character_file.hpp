// Skinned, animated characters and motions from files, through assimp.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "assets/character_reader.hpp"
#include "character/character.hpp"
#include "scene/scene.hpp"

namespace weft::assets {

/// How lengths and axes of a file are meant.
struct FileAxes {
  std::optional<double> scale;  ///< metres per unit of the file; absent: what the file says, else 1
  scene::FileUp up = scene::FileUp::as_file;
  scene::UpAxis scene_up = scene::UpAxis::z;
};

struct LoadedCharacter {
  character::Character character;     ///< in metres and the axes of the scene
  std::vector<std::string> warnings;  ///< with `where`, file and part
  double scale = 1;                   ///< metres per unit of the file that were taken
};

/// Reads hierarchy, skin, morph targets and clips of glTF, FBX, Collada, X, B3D, BVH and what else assimp knows, in a
/// process of its own. A skeleton without a mesh gets one of sticks. `where` names what refers to the file. Throws
/// Error(asset_unreadable) with `where`, file and part.
LoadedCharacter load_character(const std::filesystem::path& file, const FileAxes& axes, const std::string& where,
                               const MeshChoice& choice = {});

/// The same of a file that is only there for its skeleton and clips, at least one; its mesh is left out.
LoadedCharacter load_motion(const std::filesystem::path& file, const FileAxes& axes, const std::string& where);

/// Whether a file is a BVH file by its name, in any case.
bool is_bvh(const std::filesystem::path& file);

/// Turns and scales a character: every length by `scale`, every direction by `axes`, which sends axes to axes.
void transform(character::Character& character, double scale, const Mat3& axes);

/// The rotation that turns an up axis (0 x, 1 y, 2 z) to that of the scene.
Mat3 turn_up(int up, scene::UpAxis scene_up);

}  // namespace weft::assets
