// What a pixel shows. GeometryBuffer writes this, later passes read it.
#pragma once

namespace weft::render {

/// Surface numbers; surface i of a picture is kFirstSurface + i. As in shaders/frame.glsl.
inline constexpr int kNothing = 0, kFloor = 1, kFirstSurface = 2;

/// Marks surfaces other than cloth in the heat channel (strain or speed of cloth). As in shaders/frame.glsl.
inline constexpr float kSolid = -1e6f;

/// One pixel: distance along the view axis [m], and the number of the surface, plus 0.5 if the pixel shows its back.
struct Seen {
  float distance = 0, surface = kNothing;
};

}  // namespace weft::render
