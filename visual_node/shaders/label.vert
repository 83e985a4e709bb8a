#version 330 core
// Some rows of a text picture per instance: struct Label in scene_view/draw_list.h.
layout(location = 0) in vec4 area;   // x, y, width, height in pixels from the top left
layout(location = 1) in vec4 place;  // x: first row in the text picture
layout(location = 2) in vec4 tint;
uniform vec2 size;  // size of the picture, pixels
out vec2 texel;     // of the text picture
flat out vec4 fill;

void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * area.zw;
  texel = corner + vec2(0.0, place.x);
  fill = tint;
  vec2 at = area.xy + corner;
  gl_Position = vec4(at.x / size.x * 2.0 - 1.0, 1.0 - at.y / size.y * 2.0, 0.0, 1.0);
}
