// A texel of the soft light buffer. x: surface number plus openness as the fraction; y, z: fractions of the first two
// lights, minus 2 where a shadow edge is too sharp for this size; w: distance [m].
float soft_surface(vec4 texel) { return floor(texel.x); }
float soft_open(vec4 texel) { return fract(texel.x) / 0.9375; }
float pack_soft(float surface, float open) { return surface + 0.9375 * open; }
vec2 soft_crisp(vec4 texel) { return step(texel.yz, vec2(-0.5)); }
vec2 soft_lit(vec4 texel) { return texel.yz + 2.0 * soft_crisp(texel); }

#ifdef REDUCTION
// The full-size pixel that a texel samples, and the inverse.
ivec2 small_to_full(ivec2 texel) { return texel * REDUCTION + REDUCTION / 2; }
vec2 full_to_small(vec2 pixel_center) { return (pixel_center - (float(REDUCTION / 2) + 0.5)) / float(REDUCTION); }
#endif
