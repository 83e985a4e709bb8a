#version 330 core
// Places one shape of a batch. The instance attributes are struct Instance in scene_view/draw_list.h.
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 orientation;  // T_world_shape, x, y, z, w
layout(location = 3) in vec4 place;
layout(location = 4) in vec4 scale;        // w: Phong exponent
layout(location = 5) in vec4 diffuse;      // w: opacity
layout(location = 6) in vec4 specular;
layout(location = 7) in vec4 ambient;
layout(location = 8) in vec4 emissive;
#if RELIEF
layout(location = 9) in vec4 body_orientation;  // T_world_body, x, y, z, w
layout(location = 10) in vec4 body_place;
#endif

uniform mat4 clip_from_world;
uniform mat4 shadow_from_world;  // to texture coordinates of the shadow map, before the division

out vec3 at;  // m, world
out vec3 facing;
out vec4 shadow_at;
flat out vec4 base;   // diffuse colour and opacity
flat out vec4 shine;  // specular colour and Phong exponent
flat out vec3 bounce;
flat out vec3 glow;
#if RELIEF
out vec3 at_body;  // m, body frame
out vec3 facing_body;
flat out mat3 body_axes;  // in the world
#endif

vec3 rotate(vec4 q, vec3 v) { return v + 2.0 * cross(q.xyz, cross(q.xyz, v) + q.w * v); }

void main() {
  at = place.xyz + rotate(orientation, position * scale.xyz);
  facing = rotate(orientation, normal);
  base = diffuse;
  shine = vec4(specular.rgb, scale.w);
  bounce = ambient.rgb;
  glow = emissive.rgb;
#if RELIEF
  for (int i = 0; i < 3; ++i) body_axes[i] = rotate(body_orientation, mat3(1.0)[i]);
  at_body = (at - body_place.xyz) * body_axes;  // transposed: back into the body frame
  facing_body = facing * body_axes;
#endif
  // A little along the normal, so that a surface does not shadow itself.
  shadow_at = shadow_from_world * vec4(at + 0.008 * facing, 1.0);
  gl_Position = clip_from_world * vec4(at, 1.0);
}
