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
#if MAPPED
layout(location = 11) in vec2 texcoord;
layout(location = 12) in vec4 tangent_in;  // w: sign of the binormal
#endif

uniform mat4 clip_from_world;
uniform mat4 shadow_from_world;  // to texture coordinates of the shadow map, before the division
uniform vec3 eye;
uniform float see_through;  // 1: the background shows through, 0: opaque

out vec3 at;  // m, about the origin of the picture
out vec3 facing;
out vec4 shadow_at;
flat out vec4 paint;    // diffuse colour and opacity
flat out vec4 polish;   // specular colour and Phong exponent
flat out vec3 returned; // share of ambient light
flat out vec3 glow;
#if RELIEF
out vec3 at_body;  // m, body frame
out vec3 facing_body;
flat out mat3 body_axes;  // axes of the body in the world frame
#endif
#if MAPPED
out vec2 uv;
out vec4 tangent;
#endif
#if GOURAUD
out vec3 lit_here;
out vec3 lit_by_caster;
#endif

vec3 rotate(vec4 q, vec3 v) { return v + 2.0 * cross(q.xyz, cross(q.xyz, v) + q.w * v); }
