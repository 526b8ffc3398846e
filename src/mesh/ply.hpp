// Binary PLY files, the format of `--meshes`.
#pragma once

#include <array>
#include <filesystem>
#include <span>
#include <vector>

#include "core/types.hpp"

namespace weft::mesh {

/// Writes positions as double and faces as triangles, or as quads where `quads` is not empty, binary little endian, under a temporary name first.
/// Throws Error(output_failed).
void write_ply(const std::filesystem::path& file, std::span<const Vec3> positions,
               std::span<const std::array<Index, 3>> triangles, std::span<const std::array<Index, 4>> quads = {});

}  // namespace weft::mesh
