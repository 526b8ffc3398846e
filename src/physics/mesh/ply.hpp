// Binary PLY files, the format of the option --meshes.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "core/types.hpp"

namespace weft::mesh {

/// Optional contents of a PLY file.
struct PlyExtras {
  std::span<const std::uint8_t> passed_through = {};  ///< per triangle; 1: cloth passes through
  std::span<const Vec2> uv = {};                      ///< per vertex
  std::span<const float> values = {};                 ///< per vertex, of any quantity
  std::string_view values_name = {};                  ///< name of their property
};

/// Writes positions as double and faces as triangles, binary little endian, first under a temporary name. Quad meshes
/// are written as their triangles, the surface that collision uses. Triangles through which cloth passes are written
/// last; a comment in the header states how many. Pieces of rope, triangles (a, b, b), are written as edges. Texture
/// coordinates are the properties `s` and `t`, before `values`. Throws Error(output_failed) with the system's reason.
void write_ply(const std::filesystem::path& file, std::span<const Vec3> positions,
               std::span<const std::array<Index, 3>> triangles, const PlyExtras& extras = {});

}  // namespace weft::mesh
