// Coloured stripes around a body, with the standard lighting; for looks_bench.sdf. Inputs: visual_node/README.md.
uniform float width_m;
uniform vec3 tint;

vec4 shade() {
  float stripe = step(0.5, fract(at.z / (2.0 * width_m)));
  base.rgb = bounce = mix(base.rgb, tint, stripe);
  return vec4(lit(), base.a);
}
