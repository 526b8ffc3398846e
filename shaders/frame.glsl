// What all passes of one picture share. Names carry their space: world [m], view (right, up, backward [m]), clip.
layout(std140, binding = 0) uniform Frame {
  mat4 clip_from_world;
  mat4 view_from_world;
  vec4 eye_world;          // w: radius of the subjects [m]
  vec4 center_world;       // of the subjects; w: height of the floor above the origin along up [m]
  vec4 up_world;           // w: 1 where there is a floor
  vec4 right_world;        // of the camera
  vec4 sky_light;          // linear, times the sky's share of all light; w: reach of sky occlusion [m]
  vec4 ground_light;       // the same from below; w: metres of one unit of depth of the sky maps
  vec4 backdrop;           // linear colour at the horizon
  vec4 viewport;           // width, height [pixels], and their inverses
  vec4 frustum;            // tangents of half the opening, near, far [m]
  mat4 above_from_world;   // texture space of the map seen from above
  mat4 below_from_world;   // and from below
} frame;

// Distance along the view axis [m] of a depth-buffer value.
float view_distance(float depth) {
  float near = frame.frustum.z, far = frame.frustum.w;
  return near * far / (far - depth * (far - near));
}

// Interleaved gradient noise (Jimenez, "Next Generation Post Processing in Call of Duty: Advanced Warfare", 2014):
// the values of any 3x3 pixels are spread evenly over [0,1).
float pixel_noise(vec2 pixel) { return fract(52.9829189 * fract(dot(pixel, vec2(0.06711056, 0.00583715)))); }

// Point i of n on a disc of radius 1, evenly spread (Vogel 1979), turned by `turn` revolutions.
vec2 disc_point(int i, int n, float turn) {
  float angle = 2.39996323 * float(i) + 6.28318531 * turn;
  return sqrt((float(i) + 0.5) / float(n)) * vec2(cos(angle), sin(angle));
}
