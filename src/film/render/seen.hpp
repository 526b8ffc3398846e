// Distance and surface that a pixel shows. GeometryBuffer writes them, later passes read them.
#pragma once

namespace weft::render {

/// Surface numbers, as in shaders/frame.glsl; surface i of a picture has the number kFirstSurface + i.
inline constexpr int kNothing = 0, kFloor = 1, kFirstSurface = 2;

/// Heat value of surfaces other than cloth, as in shaders/frame.glsl. (For cloth, heat is strain or speed.)
inline constexpr float kSolid = -1e6f;

/// One pixel: distance along the view axis [m], and the number of the surface, plus 0.5 if the pixel shows its back.
struct Seen {
  float distance = 0, surface = kNothing;
};

}  // namespace weft::render
