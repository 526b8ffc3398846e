// Wavefront OBJ files.
#pragma once

#include <filesystem>
#include <vector>

#include "frame/frame_snapshot.hpp"

namespace weft::exporter {

/// Faces as simulated; positions [m] and weft and warp [m], as texture coordinates, of each panel by itself, such that
/// reading gives the same doubles. The axes are those of the scene. Throws Error(output_failed).
void write_obj(const std::filesystem::path& file, const frame::Surface& surface, const std::vector<Vec3>& positions);

}  // namespace weft::exporter
