// Common inputs of every surface shader; documented for authors in visual_node/shaders/README.md.
in vec3 at;
in vec3 facing;
in vec4 shadow_at;
flat in vec4 paint;
flat in vec4 polish;
flat in vec3 returned;
flat in vec3 glow;
#if RELIEF
in vec3 at_body;
in vec3 facing_body;
flat in mat3 body_axes;       // axes of the body in the world frame
uniform sampler2D slope_map;  // dh/du, dh/dv, m/m
uniform vec2 relief_size;     // size of one repetition, m
#endif
#if MAPPED
in vec2 uv;
in vec4 tangent;
#endif
#if COLOUR_MAP
uniform sampler2D colour_map;
#endif
#if NORMAL_MAP
uniform sampler2D normal_map;
#endif
#if MIRROR
uniform samplerCube environment;
uniform float reflectance;
#endif
#if GOURAUD
in vec3 lit_here;
in vec3 lit_by_caster;
#endif
uniform vec3 eye;
uniform float exposure;

out vec4 colour;
