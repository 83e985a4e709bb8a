#version 330 core
// Covers the whole picture with the drawn part of a texture.
layout(location = 0) in vec4 part;   // width and height of the part, in texture coordinates
layout(location = 1) in vec4 edges;  // centres of its outermost texels: left, low, right, high
out vec2 at;
flat out vec4 within;

void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  at = part.xy * corner;
  within = edges;
  gl_Position = vec4(corner * 2.0 - 1.0, 0.0, 1.0);
}
