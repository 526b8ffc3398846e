// Writes binary PLY files, the format of the option --meshes of `weft run`.
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
  std::span<const std::uint8_t> passed_through = {};  ///< per triangle; 1: cloth passes through it
  std::span<const Vec2> uv = {};                      ///< per vertex
  std::span<const float> values = {};                 ///< one more quantity, per vertex
  std::string_view values_name = {};                  ///< name of the property that `values` are written as
};

/// Writes positions in double precision and faces as triangles, in binary little endian, through a TemporaryFile. A
/// quad mesh is written as its triangles, because collision uses these. Triangles through which cloth passes come last;
/// if there are any, a comment in the header states their number. Pieces of rope, which are
/// triangles (a, b, b), are written as edges. `uv` is written as the properties `s` and `t`, before
/// `values`. Throws Error(output_failed) if `file` cannot be written.
void write_ply(const std::filesystem::path& file, std::span<const Vec3> positions,
               std::span<const std::array<Index, 3>> triangles, const PlyExtras& extras = {});

}  // namespace weft::mesh
