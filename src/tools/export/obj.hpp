// Wavefront OBJ files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "film/frame/frame_snapshot.hpp"

namespace weft::exporter {

/// Writes positions [m], the faces (Surface::quads, else the triangles), texture coordinates (weft and warp [m] of each
/// panel), normals, and references to the materials in `<object>.mtl`. Positions and texture coordinates read back
/// exactly as doubles; normals have six decimal places. The axes are those of `positions`. Throws Error(output_failed).
void write_obj(const std::filesystem::path& file, const frame::Surface& surface, const std::vector<Vec3>& positions);

/// The text of the material file, with the linear colour and the roughness in the form that Blender reads.
std::string mtl_text(const frame::Surface& surface);

}  // namespace weft::exporter
