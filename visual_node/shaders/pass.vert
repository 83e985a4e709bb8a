// Covers the whole picture.
out vec2 where;  // 0 .. 1, from the lower left

void main() {
  where = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  gl_Position = vec4(where * 2.0 - 1.0, 0.0, 1.0);
}
