// A texel of the small picture: x: number of the surface, and openness as the fraction; y, z: shares of the first two
// lights; w: distance [m].
float soft_surface(vec4 texel) { return floor(texel.x); }
float soft_open(vec4 texel) { return fract(texel.x) / 0.9375; }
float pack_soft(float surface, float open) { return surface + 0.9375 * open; }
