// Height range of what lies above each spot, as seen from straight above, for sky occlusion (shaders/soft_light.frag).
#pragma once

#include <span>
#include <vector>

#include "render/lighting.hpp"
#include "render/shaded_mesh.hpp"

namespace weft::render {

inline constexpr int kSkySize = 256;  ///< texels along a side; coarse, because sky occlusion is soft

/// Depths of a SkyView; 1 and 0 if nothing is there.
struct SkyTexel {
  float highest = 1, lowest = 0;
};

/// Fills kSkySize x kSkySize texels, row by row, from what lies over each centre. Works on the CPU: triangles of cloth
/// are about as small as texels, for which OpenGL takes ten times as long and needs a second pass from below.
void draw_sky_map(std::span<const DrawnMesh> meshes, const SkyView& view, std::vector<SkyTexel>& map);

}  // namespace weft::render
