// Reads a body whose key frames are mesh files.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "film/assets/character_file.hpp"
#include "physics/mesh/mesh.hpp"

namespace weft::assets {

struct LoadedSequence {
  mesh::Mesh mesh;                           ///< of the first file
  std::vector<std::vector<Vec3>> positions;  ///< per file, in metres and the axes of the scene
};

/// Reads files with the same faces and the same order of vertices. Merges vertices that coincide in all files.
/// `axes.scale` is a factor on lengths, in addition to the unit that the file states; absent: 1. Throws
/// Error(asset_unreadable) with `where` and the file that differs from the first or cannot be used.
LoadedSequence load_sequence(std::span<const std::filesystem::path> files, const FileAxes& axes,
                             const std::string& where);

}  // namespace weft::assets
