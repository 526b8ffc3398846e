// Key frames as mesh files.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "assets/character_file.hpp"
#include "mesh/mesh.hpp"

namespace weft::assets {

struct LoadedSequence {
  mesh::Mesh mesh;                           ///< of the first file
  std::vector<std::vector<Vec3>> positions;  ///< of each file, in metres and the axes of the scene
};

/// Reads files that hold the same faces over vertices in the same order. Vertices at the same place in all of them
/// become one. Throws Error(asset_unreadable) with `where` and the file that differs from the first or cannot be used.
LoadedSequence load_sequence(std::span<const std::filesystem::path> files, const FileAxes& axes,
                             const std::string& where);

}  // namespace weft::assets
