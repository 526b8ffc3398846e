// Reads a body whose key frames are mesh files.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "film/assets/character_file.hpp"
#include "physics/mesh/mesh.hpp"

namespace weft::assets {

/// A mesh with its positions in each file.
struct LoadedSequence {
  mesh::Mesh mesh;                           ///< the mesh in the first file
  std::vector<std::vector<Vec3>> positions;  ///< per file, in metres and the axes of the scene
};

/// Reads files with the same faces and the same order of vertices. Merges vertices that coincide in all files. Lengths
/// are multiplied by the unit that the file states and by `axes.scale` (absent: 1). Throws Error(asset_unreadable) with
/// `where` and the file if a file differs from the first or cannot be used.
LoadedSequence load_sequence(std::span<const std::filesystem::path> files, const FileAxes& axes,
                             const std::string& where);

}  // namespace weft::assets
