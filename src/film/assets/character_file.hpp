// Reads skinned, animated characters and motions from files, through assimp.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "film/assets/character_reader.hpp"
#include "film/character/character.hpp"
#include "film/scene/scene.hpp"

namespace weft::assets {

/// How to interpret the lengths and axes of a file. If `up` is as_file, the up axis is that stated in the file, or y if
/// the file states none.
struct FileAxes {
  std::optional<double> scale;  ///< metres per unit of the file; absent: as stated in the file, or 1
  scene::FileUp up = scene::FileUp::as_file;
  scene::UpAxis scene_up = scene::UpAxis::z;

  /// The rotation to the axes of the scene. `stated_up`: up axis that the file states (0 x, 1 y, 2 z); absent: none.
  Mat3 rotation(std::optional<int> stated_up) const;
};

/// A character from a file.
struct LoadedCharacter {
  character::Character character;     ///< converted to metres and to the axes of the scene
  std::vector<std::string> warnings;  ///< each names the scene entry and the file
  double scale = 1;                   ///< applied scale: metres per unit of the file
};

/// Reads skeleton, skin, morph targets and clips in a child process. Formats: glTF, FBX, Collada, X, B3D, BVH and
/// others of assimp. A skeleton without a mesh gets a mesh of sticks. `where` names the scene entry. Throws
/// Error(asset_unreadable) with `where`, the file and the reason, also if no face has an area.
LoadedCharacter load_character(const std::filesystem::path& file, const FileAxes& axes, const std::string& where,
                               const MeshChoice& choice = {});

/// Reads only skeleton and clips. Arguments and exceptions are those of load_character(); also throws if there is no
/// clip.
LoadedCharacter load_motion(const std::filesystem::path& file, const FileAxes& axes, const std::string& where);

/// Whether the extension of a file is .bvh, in upper or lower case.
bool is_bvh(const std::filesystem::path& file);

/// Multiplies all lengths of a character by `scale`, and rotates all directions by `axes`, a signed permutation.
void transform(character::Character& character, double scale, const Mat3& axes);

/// The rotation from the axes of a file to those of the scene. `up`: up axis of the file (0 x, 1 y, 2 z).
Mat3 rotation_to_scene_axes(int up, scene::UpAxis scene_up);

}  // namespace weft::assets
