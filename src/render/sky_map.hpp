// How high and how low things are over each spot, as seen from straight above: what hides the sky;
// shaders/soft_light.frag.
#pragma once

#include <span>
#include <vector>

#include "render/lighting.hpp"
#include "render/shaded_mesh.hpp"

namespace weft::render {

inline constexpr int kSkySize = 256;  ///< texels along a side: the dark under things is soft anyway

/// Depths of a SkyView; 1 and 0 where nothing is.
struct SkyTexel {
  float highest = 1, lowest = 0;
};

/// kSkySize x kSkySize texels, row by row, each of what lies over its centre. On the processor: triangles of cloth are
/// about as small as texels, for which OpenGL takes ten times as long and once more from below.
void draw_sky_map(std::span<const DrawnMesh> meshes, const SkyView& view, std::vector<SkyTexel>& map);

}  // namespace weft::render
