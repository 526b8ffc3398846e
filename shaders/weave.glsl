// Draws threads in rest coordinates: plain weave, 3/1 twill, face side of a jersey, or loose fibres. Yarns differ
// slightly in tone. To avoid shimmer, every feature fades to its mean before it becomes smaller than two pixels.
const int kPlain = 0, kTwill = 1, kDenim = 2, kKnit = 3, kNone = 4;  // weft::Threads
// Maximum relative deviation of a yarn's tone in the smallest patches of uneven_tone(). Patches of each larger size
// have 0.7 times the deviation of the size before.
const float kUneven = 0.15;

// Random number from 0 to 1 for a thread.
float noise(float thread) { return fract(sin(thread * 12.9898) * 43758.5453); }
// Random number from -1 to 1 for a thread. In a sum over neighbouring threads, these numbers almost cancel. Therefore
// the mean tone of many threads varies little; otherwise, bands would be visible after the threads themselves have
// faded.
float thread_noise(float thread) { return noise(thread + 1.0) - noise(thread); }

// Random value from -0.5 to 0.5 for each cell.
float cell_noise(ivec2 cell) {
  uint mixed = uint(cell.x) * 0x9E3779B1u ^ uint(cell.y) * 0x85EBCA77u;
  mixed = (mixed ^ (mixed >> 15)) * 0x2C1B3C6Du;
  return float((mixed ^ (mixed >> 13)) & 0xFFFFu) / 65535.0 - 0.5;
}

// Value noise from -0.5 to 0.5, with cells of side 1.
float unevenness(vec2 at) {
  vec2 whole = floor(at), f = at - whole;
  f = f * f * (3.0 - 2.0 * f);
  ivec2 cell = ivec2(whole);
  return mix(mix(cell_noise(cell), cell_noise(cell + ivec2(1, 0)), f.x),
             mix(cell_noise(cell + ivec2(0, 1)), cell_noise(cell + ivec2(1, 1)), f.x), f.y);
}

struct Weave {
  vec3 normal_world;
  float tone;   // factor on the colour
  float shine;  // factor on the highlight
  float weft;   // visible fraction of weft, for denim, whose weft and warp differ in colour
  vec3 weft_world, warp_world;  // directions of the threads
  bool at_outline;              // derivatives cross an outline and are therefore invalid
};

// Weight of a feature: 0 if its size is below two footprints of a pixel; rises to 1 at 4.5 footprints.
float visible_feature(float footprint, float size) { return 1.0 - smoothstep(0.22, 0.5, footprint / size); }

// The yarn on top at one point.
struct TopYarn {
  float height;  // relative to its mean
  vec2 tilt;     // tilt of the normal along weft and warp
  float yarn;    // random seed, different for each thread
  bool weft;
};

// Plain weave of round yarns: the height of a yarn falls across it, and along it toward the yarns that cross above it.
// `thread`: position [threads].
TopYarn plain_top(vec2 thread) {
  vec2 cell = floor(thread), local = fract(thread) - 0.5;
  bool weft_over = mod(cell.x + cell.y, 2.0) < 1.0;
  vec2 at = weft_over ? local : local.yx, bend = vec2(0.9 * at.x, 1.5 * at.y);
  float height = 1.0 - 1.6 * at.y * at.y - 1.1 * at.x * at.x;
  return TopYarn(height - 0.775, weft_over ? bend : bend.yx, weft_over ? cell.y + 0.5 : cell.x + 37.0, weft_over);
}

// 3/1 twill: each warp thread passes over three weft threads and under one, offset by one for the next warp thread.
TopYarn twill_top(vec2 thread) {
  vec2 cell = floor(thread), local = fract(thread) - 0.5;
  float place = mod(cell.y - cell.x, 4.0);
  bool weft_over = place < 0.5;
  vec2 at = weft_over ? local : vec2((place - 2.0 + local.y) / 3.0, local.x);
  float height = 1.0 - 1.6 * at.y * at.y - 1.1 * at.x * at.x;
  vec2 bend = vec2(0.9 * at.x, 1.5 * at.y);
  return TopYarn(height - 0.775, weft_over ? bend : bend.yx, weft_over ? cell.y + 0.5 : cell.x + 37.0, weft_over);
}

// Jersey: columns of stitches, each stitch with two legs that diverge upward.
TopYarn knit_top(vec2 thread) {
  float column = fract(thread.x) - 0.5, side = column < 0.0 ? -1.0 : 1.0, off = abs(column) - 0.25;
  float course = fract(1.25 * thread.y - 1.4 * abs(column)) - 0.5;
  float height = 1.0 - 8.0 * off * off - 1.4 * course * course;
  vec2 tilt = vec2(side * (4.0 * off - 0.9 * course), 0.8 * course);
  return TopYarn(height - 0.717, tilt, floor(thread.x) + 37.0, false);
}

// Tone variation of yarns, in patches of three sizes: 3, 9 and 27 threads wide and eight times as long (without
// threads, 1.4 times). Patches that are too small for the pixels fade. The warp of denim is dyed unevenly, and
// protruding fibres vary in tone. `footprint`: size of the pixel along weft and along warp [threads]; both are needed,
// because at oblique view only the yarns of one direction may be visible.
float uneven_tone(vec2 thread, vec2 footprint, int threads, float fuzz) {
  vec2 strength = threads == kDenim ? vec2(0.5, 3.0) : threads == kKnit ? vec2(0.3, 1.5) : vec2(1.0);
  float aspect = threads == kNone ? 0.7 : 0.125, fibres = smoothstep(0.6, 1.0, fuzz), tone = 1.0;
  float uneven = kUneven / 0.7;
  for (float size = 3.0; size < 30.0; size *= 3.0) {
    vec2 seen = vec2(visible_feature(max(footprint.y, aspect * footprint.x), size),
                     visible_feature(max(footprint.x, aspect * footprint.y), size));
    uneven *= 0.7;
    if (max(seen.x, seen.y) == 0.0) continue;
    vec2 at = thread / size;
    tone *= 1.0 + uneven * (1.0 + fibres) *
                      (seen.x * strength.x * unevenness(at * vec2(aspect, 1.0)) +
                       seen.y * strength.y * unevenness(at.yx * vec2(aspect, 1.0) + 71.0));
  }
  float seen = visible_feature(max(footprint.x, footprint.y), 1.0) * fibres;
  // Fibres of felt have all directions, spun fibres that of their yarns.
  mat2 lie = threads == kNone ? mat2(0.9, 0.5, -0.5, 0.9) : mat2(1.3, 0.0, 0.0, 0.4);
  if (seen > 0.0) tone *= 1.0 + 0.5 * seen * (unevenness(lie * thread) + unevenness(lie * thread.yx + 31.0));
  return tone;
}

// Computes the threads at a pixel. spacing: distance between threads [m]; fuzz: 0 to 1; n_world: smooth normal;
// p_world: position [m].
Weave weave(vec2 rest_uv, float spacing, int threads, float fuzz, vec3 n_world, vec3 p_world) {
  // `spacing` is 0 for cloth without drawn threads, and for pixels of other surfaces, because derivatives may read
  // these. The lower bound avoids undefined directions of weft and warp.
  vec2 thread = rest_uv / max(spacing, 1e-6);
  vec2 across = dFdx(thread), down = dFdy(thread);
  // Pixel footprints [threads]: along weft and warp, along the pixel's longer side, and across the lines of a twill.
  vec2 along_axes = vec2(length(vec2(across.x, down.x)), length(vec2(across.y, down.y)));
  float footprint = max(length(across), length(down)), across_lines = length(vec2(across.y - across.x, down.y - down.x));
  // Gradients of weft and warp in the surface, from screen derivatives.
  vec3 p_dx = dFdx(p_world), p_dy = dFdy(p_world);
  vec3 weft = p_dx * down.y - p_dy * across.y, warp = p_dy * across.x - p_dx * down.x;
  float area = across.x * down.y - across.y * down.x;
  weft *= sign(area) * inversesqrt(max(dot(weft, weft), 1e-20));
  warp *= sign(area) * inversesqrt(max(dot(warp, warp), 1e-20));
  // Threads hardly stretch. If rest coordinates and positions change by very different lengths, the pixel is at an
  // outline.
  float along_threads = spacing * spacing * max(dot(across, across), dot(down, down)),
        in_space = max(dot(p_dx, p_dx), dot(p_dy, p_dy));
  bool at_outline = spacing > 0.0 && (along_threads > 4.0 * in_space || in_space > 4.0 * along_threads);
  if (at_outline) {
    weft = normalize(cross(n_world, frame.right_world.xyz) + 1e-6);
    warp = cross(n_world, weft);
  }
  Weave result = Weave(n_world, 1.0, 1.0, 0.25, weft, warp, at_outline);
  if (spacing <= 0.0 || at_outline) {
    footprint = across_lines = 1e6;
    along_axes = vec2(1e6);
  }
  result.tone = uneven_tone(thread, along_axes, threads, fuzz);

  // The lines of a twill are farther apart than its threads, and thus are visible at larger distances.
  if (threads == kTwill || threads == kDenim) {
    float line = visible_feature(0.7071 * across_lines, 2.8) * cos(1.5707963 * (thread.y - thread.x));
    result.weft *= 1.0 + line;
    if (threads == kTwill) result.tone *= 1.0 - 0.08 * line;
  }
  float fine = visible_feature(footprint, 1.0);
  if (fine > 0.0 && threads != kNone) {
    TopYarn top = threads == kPlain ? plain_top(thread) : threads == kKnit ? knit_top(thread) : twill_top(thread);
    result.normal_world = normalize(n_world + 0.75 * fine * (top.tilt.x * weft + top.tilt.y * warp));
    // top.height has the mean 0, so that the mean tone does not change when threads fade.
    result.tone *= 1.0 + fine * (0.85 * top.height + 0.07 * thread_noise(top.yarn));
    result.shine = 1.0 + fine * top.height;
    result.weft = mix(result.weft, top.weft ? 1.0 : 0.0, fine);
  }
  return result;
}

// Colour of denim if undyed weft is on top in the fraction `weft` of the area. `cloth`: mean colour of the cloth, which
// corresponds to a fraction of one quarter.
vec3 denim_color(vec3 cloth, float weft) {
  const float kPaler = 2.2, kDye = 0.35;
  vec3 undyed = kPaler * mix(vec3(dot(cloth, vec3(0.2126, 0.7152, 0.0722))), cloth, kDye);
  return mix(max((cloth - 0.25 * undyed) / 0.75, vec3(0.0)), undyed, weft);
}
