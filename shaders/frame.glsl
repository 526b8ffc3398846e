// Data that all passes of a picture share. Names of coordinates contain their space: world [m], view (right, up,
// backward [m]), clip.
layout(std140, binding = 0) uniform Frame {
  mat4 clip_from_world;
  mat4 view_from_world;
  vec4 eye_world;          // w: half the diagonal of the box surroundings_bounds() [m]
  vec4 center_world;       // centre of this box; w: roughness of the floor
  vec4 up_world;
  vec4 right_world;        // right axis of the camera
  vec4 sky;                // linear light from above
  vec4 horizon;            // linear light from the sides; w: Style::toe, linear light below which tones are darkened
  vec4 ground;             // linear light from below, for reflections
  vec4 backdrop;           // linear colour at the horizon; w: Style::glow
  vec4 backdrop_top;       // linear colour straight above
  vec4 viewport;           // width, height [pixels], and their reciprocals
  vec4 frustum;            // tangents of half the field of view (x, y), distance of the near plane [m], 0
  vec4 floor_plane_world;  // unit normal, upward; w: height of the eye above it [m]
  vec4 floor_look;         // linear colour; w: exposure, a factor on all light
  vec4 box_axes[3];        // unit vectors to the soft boxes; w: sharpness (surroundings.hpp)
  vec4 box_lights[3];      // linear light of the soft boxes
  vec4 irradiance[9];      // coefficients of irradiance()
} frame;

// Surface numbers. The geometry buffer stores, for each pixel, the distance along the view axis [m] and the number of
// the surface, plus 0.5 if the pixel shows its back.
const float kNothing = 0.0, kFloor = 1.0, kFirstSurface = 2.0;
const float kSolid = -1e6;  // heat value of surfaces other than cloth

// View-space position at `uv` (0 to 1 across the picture), at `distance` along the view axis [m].
vec3 position_view(vec2 uv, float distance) {
  return vec3((uv * 2.0 - 1.0) * frame.frustum.xy * distance, -distance);
}
vec3 world_from_view(vec3 direction_view) { return transpose(mat3(frame.view_from_world)) * direction_view; }

// Interleaved gradient noise (Jimenez, "Next Generation Post Processing in Call of Duty: Advanced Warfare", 2014): the
// values of any 3x3 pixels are evenly spread over [0,1).
float pixel_noise(vec2 pixel) { return fract(52.9829189 * fract(dot(pixel, vec2(0.06711056, 0.00583715)))); }

// Points evenly spread over a disc of radius 1 (Vogel 1979): point k of n is sqrt((k + 1/2) / n) times direction k.
// Each direction is the one before, rotated by the golden angle, because a sine and cosine per point would cost more
// than a texture lookup. `turn` in [0,1) selects the first direction.
vec2 first_direction(float turn) {
  vec2 corner = vec2(abs(4.0 * turn - 2.0) - 1.0, abs(4.0 * fract(turn + 0.25) - 2.0) - 1.0);
  return normalize(corner);
}
vec2 next_direction(vec2 direction) {
  return mat2(-0.73736888, 0.67549029, -0.67549029, -0.73736888) * direction;
}
