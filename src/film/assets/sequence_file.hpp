// Reads key frames from mesh files.
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

/// Reads files with the same faces and the same order of vertices. Vertices that coincide in all of them are merged. If
/// `axes.up` is as_file, the axis that the file states is up, else y. `axes.scale` multiplies lengths after their
/// conversion to metres by the unit that the file states, if any. Throws Error(asset_unreadable) with `where` and the
/// file that differs from the first or cannot be used.
LoadedSequence load_sequence(std::span<const std::filesystem::path> files, const FileAxes& axes,
                             const std::string& where);

}  // namespace weft::assets
