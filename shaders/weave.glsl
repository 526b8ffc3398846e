// A plain weave drawn in rest coordinates: threads alternate over and under, each a little different in tone. Every
// feature fades to its mean before it gets smaller than two pixels, so that nothing shimmers.
const float kUneven = 0.04;  // share of its tone by which a yarn differs at most, at each size

float thread_noise(float thread) { return fract(sin(thread * 12.9898) * 43758.5453); }

// From -0.5 to 0.5, another one in each cell.
float speck(ivec2 cell) {
  uint mixed = uint(cell.x) * 0x9E3779B1u ^ uint(cell.y) * 0x85EBCA77u;
  mixed = (mixed ^ (mixed >> 15)) * 0x2C1B3C6Du;
  return float((mixed ^ (mixed >> 13)) & 0xFFFFu) / 65535.0 - 0.5;
}

// Smooth over one unit of `at`.
float unevenness(vec2 at) {
  vec2 whole = floor(at), f = at - whole;
  f = f * f * (3.0 - 2.0 * f);
  ivec2 cell = ivec2(whole);
  return mix(mix(speck(cell), speck(cell + ivec2(1, 0)), f.x),
             mix(speck(cell + ivec2(0, 1)), speck(cell + ivec2(1, 1)), f.x), f.y);
}

struct Weave {
  vec3 normal_world;
  float tone;   // factor on the colour
  float shine;  // factor on the highlight
  vec3 weft_world, warp_world;  // directions of the threads
};

// 1 while a feature of `size` is well above the pixel's footprint, 0 once it is below two pixels.
float visible_feature(float footprint, float size) { return 1.0 - smoothstep(0.22, 0.5, footprint / size); }

Weave weave(vec2 rest_uv, float spacing, vec3 n_world, vec3 p_world) {
  // Pixels of other surfaces take part in the derivatives, with no spacing at all; cloth without threads has a grain.
  vec2 thread = rest_uv / max(spacing, 1e-6);
  vec2 across = dFdx(thread), down = dFdy(thread);
  float footprint = max(length(across), length(down));
  // Gradients of weft and warp in the surface, from screen derivatives.
  vec3 p_dx = dFdx(p_world), p_dy = dFdy(p_world);
  vec3 weft = p_dx * down.y - p_dy * across.y, warp = p_dy * across.x - p_dx * down.x;
  float area = across.x * down.y - across.y * down.x;
  weft *= sign(area) * inversesqrt(max(dot(weft, weft), 1e-20));
  warp *= sign(area) * inversesqrt(max(dot(warp, warp), 1e-20));
  Weave result = Weave(n_world, 1.0, 1.0, weft, warp);
  if (spacing <= 0.0) footprint = 1e6;

  // Yarns are uneven along their way, some threads wide and eight times as long: weft and warp, at three sizes, of
  // which those show that the picture can.
  for (float size = 2.5; size < 64.0; size *= 4.0) {
    float seen = visible_feature(footprint, size);
    if (seen == 0.0) continue;
    vec2 at = thread / size;
    result.tone *= 1.0 + kUneven * seen * (unevenness(at * vec2(0.125, 1.0)) + unevenness(at.yx * vec2(0.125, 1.0) + 71.0));
  }

  float fine = visible_feature(footprint, 1.0);
  if (fine > 0.0) {
    vec2 cell = floor(thread), local = fract(thread) - 0.5;
    bool weft_over = mod(cell.x + cell.y, 2.0) < 1.0;
    // Round yarns: height falls off across the thread and where it dives under the next one.
    vec2 along_across = weft_over ? local : local.yx;
    vec2 bend = vec2(0.9 * along_across.x, 1.5 * along_across.y);
    float height = 1.0 - 1.6 * along_across.y * along_across.y - 1.1 * along_across.x * along_across.x;
    vec2 tilt = weft_over ? bend : bend.yx;
    result.normal_world = normalize(n_world + 0.75 * fine * (tilt.x * weft + tilt.y * warp));
    float yarn = weft_over ? thread_noise(cell.y + 0.5) : thread_noise(cell.x + 37.0);
    // 0.78 is the mean of the height over a cell: the tone stays when the threads fade.
    result.tone *= 1.0 + fine * (0.85 * (height - 0.775) + 0.10 * (yarn - 0.5));
    result.shine = 1.0 + fine * (height - 0.775);
  }
  return result;
}
