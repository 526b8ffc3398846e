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

}  // namespace weft::mesh
