#version 330 core
// Covers the whole picture, behind everything.
uniform mat4 world_from_clip;
out vec3 towards;

void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  vec4 near = world_from_clip * vec4(corner, -1.0, 1.0), far = world_from_clip * vec4(corner, 1.0, 1.0);
  towards = far.xyz / far.w - near.xyz / near.w;
  gl_Position = vec4(corner, 1.0, 1.0);
}
