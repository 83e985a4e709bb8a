// Stripes of a colour around a body, lit as everything else; of looks_bench.sdf. What is given: visual_node/README.md.
uniform float width_m;
uniform vec3 tint;

vec4 shade() {
  float stripe = step(0.5, fract(at.z / (2.0 * width_m)));
  base.rgb = bounce = mix(base.rgb, tint, stripe);
  return vec4(lit(), base.a);
}
