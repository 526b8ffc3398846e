// Draws hems, stitches and seams of cloth by the distance from borders and seams (trims.hpp). Details finer than a
// pixel count in proportion to the area of the pixel that they cover, which avoids moiré and shimmer. Include after
// weave.glsl.
layout(binding = 11) uniform sampler2D trims;  // distances from border and seam, position along the nearer one [m]

// Lengths [m]. Stitches pull a groove into the cloth.
const float kStitchFromFold = 0.002;  // distance of a hem's stitches from its inner edge
const float kGroove = 0.0011, kThread = 0.00028;  // half widths
const float kStitch = 0.0032;  // distance from stitch to stitch
const float kOnTop = 0.78;     // visible fraction of a stitch's thread
const float kRowDistance = 0.005;  // between both rows of stitches in knits and denim, sewn with two needles
const vec3 kDenimThreadColor = vec3(0.60, 0.27, 0.05);  // linear colour of the thread in denim
const float kSeamGrooveHalfWidth = 0.0013;  // half width of the groove along a seam

// Fraction of a pixel, of width `width` around `at`, that a band of half width `half_width` around `center` covers [m].
float band(float at, float width, float center, float half_width) {
  float from = max(at - 0.5 * width, center - half_width), to = min(at + 0.5 * width, center + half_width);
  return max(to - from, 0.0) / width;
}

// Fraction of a pixel, of length `width` [m] along a stitch line, in which the thread lies on top of the cloth.
// `along`: position on the line [m].
float on_top(float along, float width) {
  float from = (along - 0.5 * width) / kStitch, to = (along + 0.5 * width) / kStitch;
  float sum = (floor(to) - floor(from)) * kOnTop + min(fract(to), kOnTop) - min(fract(from), kOnTop);
  return sum * kStitch / width;
}

// Factor on the colour near a stitch line at `center`: thread on top is paler, there is a dark hole where the thread is
// below the cloth, and the groove is darker. `shown`: result of on_top().
float stitches(float at, float width, float center, float shown) {
  return 1.0 - 0.16 * band(at, width, center, kGroove) + band(at, width, center, kThread) * mix(-0.5, 0.16, shown);
}

// Effect of one stitch line; in knits and denim also of a second one, at the distance `beside` from the first [m].
struct Rows {
  float tone, thread;  // thread: fraction of the pixel that it covers
};
Rows rows(float at, float width, float center, float beside, float shown, int threads) {
  Rows result = Rows(stitches(at, width, center, shown), band(at, width, center, kThread) * shown);
  if (threads == kKnit || threads == kDenim) {
    result.tone *= stitches(at, width, center + beside, shown);
    result.thread += band(at, width, center + beside, kThread) * shown;
  }
  return result;
}

// Slope of the cloth in the groove of a stitch line.
float groove(float at, float width, float center) {
  return band(at, width, center, kGroove) * 0.55 * clamp((at - center) / kGroove, -1.0, 1.0) * step(width, kGroove);
}

struct Trimmed {
  vec3 normal_world;
  float tone;    // factor on the colour
  float layers;  // number of overlapping layers of cloth
  float thread;  // fraction of the pixel that shows stitches of another colour
};

// Draws hems and seams at a pixel. `look`: width of the hem, thickness of the cloth, distance of stitches from seams
// (0: none) [m]. `pixel_width`: width of a pixel on a surface at normal incidence [m].
Trimmed trim(ivec2 pixel, float pixel_width, vec2 rest_uv, vec3 look, bool front, int threads, Weave woven, vec3 n_world) {
  vec3 at = texelFetch(trims, pixel, 0).xyz;
  vec3 right = dFdx(at), up = dFdy(at), width = clamp(abs(right) + abs(up), 1e-6, 1.0);
  // `inward` and `aside` (below): directions in the surface in which the distances from border and seam increase.
  vec2 u_right = dFdx(rest_uv), u_up = dFdy(rest_uv);
  float area = u_right.x * u_up.y - u_right.y * u_up.x, sense = area < 0.0 ? -1.0 : 1.0;
  // `width`: width of the pixel across borders and seams: the derivative of the distance. It needs a lower bound,
  // because the derivative is zero on the seam itself, where neighbouring pixels on both sides have equal distances.
  width.xy = max(width.xy, max(pixel_width, 0.7 * min(sqrt(abs(area)), 1.0)));
  if (woven.at_outline) width = vec3(pixel_width);
  float hem = look.x, thickness = max(look.y, 1e-5), shown = on_top(at.z, width.z);
  vec2 du = (right.xy * u_up.y - up.xy * u_right.y) * sense, dv = (up.xy * u_right.x - right.xy * u_up.x) * sense;
  vec3 inward = du.x * woven.weft_world + dv.x * woven.warp_world, aside = du.y * woven.weft_world + dv.y * woven.warp_world;
  inward *= inversesqrt(max(dot(inward, inward), 1e-20));
  aside *= inversesqrt(max(dot(aside, aside), 1e-20));

  // The edge of the cloth is rounded. A hem ends at a step on the back, which is also slightly visible on the front.
  float fold = hem > 0.0 ? 2.0 * thickness : 0.5 * thickness;
  float rise = band(at.x, width.x, 0.5 * fold, 0.5 * fold) * 0.8, tone = 1.0, thread = 0.0;
  if (hem > 0.0) {
    float line = hem - kStitchFromFold, side = front ? 0.25 : 1.0;
    rise += groove(at.x, width.x, line) - side * 0.7 * band(at.x, width.x, hem, 0.5 * thickness + 1e-4);
    Rows sewn = rows(at.x, width.x, line, -kRowDistance, shown, threads);
    tone = sewn.tone * (1.0 - 0.3 * side * band(at.x, width.x, hem + thickness, thickness));
    thread = sewn.thread;
  }
  float seam_groove = band(at.y, width.y, 0.0, kSeamGrooveHalfWidth);
  // If the groove along a seam (`seam_groove`) is only a few pixels wide, derivatives across the seam are invalid.
  // Then its slopes darken the colour instead of tilting the normal.
  const float kSlope = 0.7;
  float sloped = woven.at_outline ? 0.0 : 1.0 - smoothstep(0.3, 0.6, width.y / kSeamGrooveHalfWidth);
  float fall = kSlope * sloped * seam_groove;
  tone *= 1.0 - seam_groove * (1.0 - sloped) * (1.0 - inversesqrt(1.0 + kSlope * kSlope));
  tone *= 1.0 - 0.22 * seam_groove - band(at.y, width.y, 0.0, 0.0004) * mix(0.5, 0.1, shown);
  if (look.z > 0.0) {
    Rows sewn = rows(at.y, width.y, look.z, kRowDistance, shown, threads);
    tone *= sewn.tone;
    thread += sewn.thread;
    fall += groove(at.y, width.y, look.z);
  }
  float doubled = hem > 0.0 ? clamp((hem - at.x) / width.x + 0.5, 0.0, 1.0) : 0.0;
  rise *= 1.0 - smoothstep(0.3, 0.6, width.x / (fold + kGroove));
  if (woven.at_outline) rise = fall = 0.0;
  vec3 n = normalize(n_world - rise * inward - fall * aside);
  return Trimmed(n, tone, 1.0 + doubled, threads == kDenim ? min(thread, 1.0) : 0.0);
}
