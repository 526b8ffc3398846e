// What a pixel shows, as the geometry buffer tells the passes after it.
#pragma once

namespace weft::render {

/// Numbers of what is seen; surface i of a picture is kFirstSurface + i. As in shaders/frame.glsl.
inline constexpr int kNothing = 0, kFloor = 1, kFirstSurface = 2;

/// In place of the heat of what is no cloth. As in shaders/frame.glsl.
inline constexpr float kSolid = -1e6f;

/// One pixel: distance along the view axis [m], and the number of the surface, half more where its back is seen.
struct Seen {
  float distance = 0, surface = kNothing;
};

}  // namespace weft::render
