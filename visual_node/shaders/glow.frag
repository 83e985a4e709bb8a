#version 330 core
// A ring that sharpens as it grows, or a soft core. Added to the picture.
in vec2 on_disc;
flat in float growth;
flat in vec3 light;
uniform float exposure;
out vec4 colour;

void main() {
  float r = length(on_disc);
  float core = max(1.0 - r, 0.0);
  float ring = max(1.0 - abs(r - 0.85) / 0.15, 0.0);
  colour = vec4(light * exposure * (growth < 0.0 ? core * core : ring * ring + 0.35 * core), 0.0);
}
