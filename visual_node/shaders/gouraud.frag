// Lit per vertex (Gouraud 1971); only what a shadow takes away is told per pixel.
vec4 shade() {
#if MIRROR
  float f = fresnel();
  return vec4(mix(lit(), mirrored(), f), mix(base.a, 1.0, f));
#else
  return vec4(lit(), base.a);
#endif
}
