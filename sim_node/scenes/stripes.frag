#version 330 core
// Stripes of a colour around a body, with light from above; of looks_bench.sdf. at: m, world; facing: the normal.
in vec3 at;
in vec3 facing;
flat in vec4 base;  // diffuse colour and opacity
uniform float width_m;
uniform vec3 tint;
out vec4 colour;

void main() {
  float light = 0.35 + 0.65 * max(normalize(facing).z, 0.0);
  float stripe = step(0.5, fract(at.z / (2.0 * width_m)));
  colour = vec4(light * mix(base.rgb, tint, stripe), base.a);
}
