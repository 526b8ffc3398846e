// Microfacet highlight (GGX, Walter et al. 2007; visibility term by Hammon 2017). n: normal; v, l: unit vectors to the
// eye and to the light; alpha: roughness squared; f0: reflectance at normal incidence.
float highlight(vec3 n, vec3 v, vec3 l, float alpha, float f0) {
  vec3 h = normalize(v + l);
  float n_h = max(dot(n, h), 0.0), n_l = max(dot(n, l), 0.0), n_v = max(dot(n, v), 1e-3), l_h = max(dot(l, h), 0.0);
  float a_sq = alpha * alpha, d = n_h * n_h * (a_sq - 1.0) + 1.0;
  float grazing = 1.0 - l_h, fresnel = f0 + (1.0 - f0) * grazing * grazing * grazing * grazing * grazing;
  return fresnel * a_sq / (d * d) * 0.25 / mix(2.0 * n_l * n_v, n_l + n_v, alpha) * 2.0 * n_l;
}

#ifdef METAL
// Same as highlight(), with a reflectance per channel.
vec3 colored_highlight(vec3 n, vec3 v, vec3 l, float alpha, vec3 f0) {
  float grazing = 1.0 - max(dot(l, normalize(v + l)), 0.0);
  return highlight(n, v, l, alpha, 1.0) * (f0 + (1.0 - f0) * (grazing * grazing * grazing * grazing * grazing));
}
#endif

// Reflectance at normal incidence. It is smaller on rough surfaces, whose facets shadow each other.
float head_on(float roughness) { return 0.04 * (1.0 - 0.9 * roughness * roughness); }
