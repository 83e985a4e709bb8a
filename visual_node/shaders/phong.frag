// Lit per pixel; with maps and a mirror where its look has them.
vec4 shade() {
#if MIRROR
  float f = fresnel();
  return vec4(mix(lit(), mirrored(), f), mix(base.a, 1.0, f));
#else
  return vec4(lit(), base.a);
#endif
}
