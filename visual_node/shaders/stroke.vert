#version 330 core
// One straight line per instance, of constant width in the picture: struct Stroke in scene_view/draw_list.h.
layout(location = 0) in vec4 from;  // w: width, pixels
layout(location = 1) in vec4 to;
layout(location = 2) in vec4 tint;
uniform mat4 clip_from_world;
uniform vec2 size;  // size of the picture, pixels
flat out vec4 fill;

void main() {
  const float nearest = 1e-3;  // m before the eye: nearer parts are cut off
  vec4 a = clip_from_world * vec4(from.xyz, 1.0), b = clip_from_world * vec4(to.xyz, 1.0);
  fill = tint;
  if (a.w < nearest && b.w < nearest) {
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
    return;
  }
  if (a.w < nearest) a = mix(b, a, (b.w - nearest) / (b.w - a.w));
  if (b.w < nearest) b = mix(a, b, (a.w - nearest) / (a.w - b.w));
  vec2 p = a.xy / a.w * size, q = b.xy / b.w * size;
  vec2 along = q - p;
  along = dot(along, along) > 1e-6 ? normalize(along) : vec2(1.0, 0.0);
  vec2 end = (gl_VertexID & 1) == 0 ? p - along * from.w * 0.5 : q + along * from.w * 0.5;
  vec2 aside = vec2(-along.y, along.x) * from.w * ((gl_VertexID >> 1) == 0 ? -1.0 : 1.0);
  gl_Position = vec4((end + aside) / size, 0.0, 1.0);
}
