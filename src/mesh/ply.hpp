// Binary PLY files, the format of `--meshes`.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "core/types.hpp"

namespace weft::mesh {

/// Writes positions as double and faces as triangles, binary little endian, under a temporary name first. Quad meshes
/// are written as the triangles of their split too: one surface, the one that collision uses. Those that cloth passes
/// through (1 in `passed_through`, which has one entry for each or none) come last, and a comment says how many they
/// are. Throws Error(output_failed) with the system's reason.
void write_ply(const std::filesystem::path& file, std::span<const Vec3> positions,
               std::span<const std::array<Index, 3>> triangles, std::span<const std::uint8_t> passed_through = {});

}  // namespace weft::mesh
