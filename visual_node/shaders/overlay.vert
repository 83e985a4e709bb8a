#version 330 core
// One filled rectangle per instance: struct Rect in scene_view/draw_list.h.
layout(location = 0) in vec4 area;  // x, y, width, height in pixels from the top left
layout(location = 1) in vec4 tint;
uniform vec2 size;  // size of the picture, pixels
flat out vec4 fill;

void main() {
  vec2 corner = area.xy + area.zw * vec2(gl_VertexID & 1, gl_VertexID >> 1);
  fill = tint;
  gl_Position = vec4(corner.x / size.x * 2.0 - 1.0, 1.0 - corner.y / size.y * 2.0, 0.0, 1.0);
}
