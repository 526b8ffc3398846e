// Binary PLY files, the format of `--meshes`.
#pragma once

#include <array>
#include <filesystem>
#include <span>
#include <vector>

#include "core/types.hpp"

namespace weft::mesh {

/// Writes positions as double and faces as triangles, binary little endian, under a temporary name first. Quad meshes
/// are written as the triangles of their split too: one surface, the one that collision uses. Throws
/// Error(output_failed) with the system's reason.
void write_ply(const std::filesystem::path& file, std::span<const Vec3> positions,
               std::span<const std::array<Index, 3>> triangles);

struct PlyMesh {
  std::vector<Vec3> positions;
  std::vector<std::array<Index, 3>> triangles;
};

/// Reads back what write_ply wrote, bit for bit; files of other programs go through assets::load_mesh. Throws
/// Error(asset_unreadable) where header, size or a vertex index is not as written.
PlyMesh read_ply(const std::filesystem::path& file);

}  // namespace weft::mesh
