#version 330 core
// One disc of light per instance: struct Glow in scene_view/draw_list.h.
layout(location = 0) in vec4 centre;  // w: growth of the flash, 0 .. 1; below 0: a core without a ring
layout(location = 1) in vec4 u;
layout(location = 2) in vec4 v;
layout(location = 3) in vec4 tint;
uniform mat4 clip_from_world;
out vec2 on_disc;
flat out float growth;
flat out vec3 light;

void main() {
  on_disc = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  growth = centre.w;
  light = tint.rgb;
  gl_Position = clip_from_world * vec4(centre.xyz + u.xyz * on_disc.x + v.xyz * on_disc.y, 1.0);
}
