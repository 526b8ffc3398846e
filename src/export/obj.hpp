// Wavefront OBJ files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "frame/frame_snapshot.hpp"

namespace weft::exporter {

/// Faces as simulated; positions [m] and weft and warp [m], as texture coordinates, of each panel by itself, such that
/// reading gives the same doubles; normals to six digits; the material of `<object>.mtl`. The axes are those of the
/// positions. Throws Error(output_failed).
void write_obj(const std::filesystem::path& file, const frame::Surface& surface, const std::vector<Vec3>& positions);

/// The text of its material file: colour in linear light and roughness, as Blender reads them.
std::string mtl_text(const frame::Surface& surface);

}  // namespace weft::exporter
