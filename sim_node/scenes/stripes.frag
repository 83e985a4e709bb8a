// Stripes of a colour around a body, lit by the lamps of the scene; of looks_bench.sdf. visual_node/README.md says what a shader
// like this finds there.
uniform float width_m;
uniform vec3 tint;

vec4 shade() {
  if (fract(at.z / (2.0 * width_m)) >= 0.5) base.rgb = tint;
  return vec4(lit(), base.a);
}
