// Binary PLY files, the format of `--meshes`.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "core/types.hpp"

namespace weft::mesh {

/// What of a mesh is optional.
struct PlyExtras {
  std::span<const std::uint8_t> passed_through = {};  ///< per triangle: 1 where cloth passes through; those come last
  std::span<const Vec2> uv = {};                      ///< per vertex
  std::span<const float> values = {};                 ///< per vertex, of any quantity
  std::string_view values_name = {};                  ///< the property that they are
};

/// Writes positions as double and faces as triangles, binary little endian, under a temporary name first. Quad meshes
/// are written as the triangles of their split too: one surface, the one that collision uses. Of those that cloth
/// passes through a comment says how many they are. Pieces of rope, triangles (a, b, b), are written as edges. Texture
/// coordinates are the properties `s` and `t`, before values. Throws Error(output_failed) with the system's reason.
void write_ply(const std::filesystem::path& file, std::span<const Vec3> positions,
               std::span<const std::array<Index, 3>> triangles, const PlyExtras& extras = {});

}  // namespace weft::mesh
