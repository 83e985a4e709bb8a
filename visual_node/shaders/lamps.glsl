// Phong reflection in linear light, for the stage that evaluates it: per pixel, or per vertex (Gouraud).
// gl/surface_program.cpp defines LIGHTS and, lamp by lamp, LAMPS for the scene: a software renderer pays for every
// branch of every pixel. The stage provides `at` (m, about the origin of the picture); all bool arguments in this file are compile-time
// constants.
struct Light {       // struct Light in scene_view/draw_list.h
  vec4 position;
  vec4 direction;
  vec4 diffuse;      // w: range
  vec4 specular;
  vec4 attenuation;
  vec4 cone;         // factor and offset on the cosine to the axis, exponent of the falloff
};
layout(std140) uniform Lights { Light lights[LIGHTS]; };
// Constant properties of the lamps, known to the compiler: a software renderer pays for every number that it reads
// for every pixel.
const vec4 lamp_diffuse[LIGHTS] = LAMP_DIFFUSE;
const vec4 lamp_specular[LIGHTS] = LAMP_SPECULAR;
const vec4 lamp_attenuation[LIGHTS] = LAMP_ATTENUATION;
const vec4 lamp_cone[LIGHTS] = LAMP_CONE;
uniform vec3 ambient_light;
#if SHADOWS
uniform sampler2DShadow shadow_map;
#endif

vec4 base;     // diffuse colour and opacity
vec4 shine;    // specular colour and Phong exponent
vec3 bounce;   // share of the ambient light that is returned
vec3 n;        // surface normal
vec3 v;        // direction to the eye
float nv;      // cosine of the angle between n and v
vec3 sum;      // light towards the eye
#if GOURAUD
vec3 shaded;   // the part of it that a shadow may remove
#endif

// Adds the light of a lamp in direction `l` (unit, to the lamp). shiny: with highlights. The lobe is Schlick's t /
// (s - s t + t) instead of t^s (Schlick 1994, "A fast alternative to Phong's specular model", Graphics Gems IV): a
// division instead of a power.
void add(int i, vec3 l, float strength, bool shiny) {
  float nl = dot(n, l);
  sum += (strength * max(nl, 0.0)) * base.rgb * lamp_diffuse[i].rgb;
  if (shiny) {
    float t = max(2.0 * nl * nv - dot(l, v), 0.0) * step(0.0, nl);
    sum += (strength * t / (shine.w - shine.w * t + t)) * shine.rgb * lamp_specular[i].rgb;
  }
}

void directional(int i, bool shiny) { add(i, -lights[i].direction.xyz, 1.0, shiny); }

// coned: a spot; falls: with an exponent other than 1; shadowed: through the shadow map.
void lamp(int i, bool shiny, bool coned, bool falls, bool shadowed) {
  vec3 to = lights[i].position.xyz - at;
  float dd = dot(to, to), inverse = inversesqrt(dd), d = dd * inverse;
  vec3 l = to * inverse;
  float strength = step(d, lamp_diffuse[i].w) /
                   max(lamp_attenuation[i].x + lamp_attenuation[i].y * d + lamp_attenuation[i].z * dd, 1e-4);
  if (coned) {
    float inside = clamp(lamp_cone[i].y - dot(l, lights[i].direction.xyz) * lamp_cone[i].x, 0.0, 1.0);
    strength *= falls ? pow(inside, lamp_cone[i].z) : inside;
  }
#if GOURAUD
  vec3 others = sum;
  add(i, l, strength, shiny);
  if (shadowed) shaded = sum - others, sum = others;
#else
#if SHADOWS
  if (shadowed) strength *= textureProj(shadow_map, shadow_at);  // 2 x 2 texels, filtered by the sampler
#endif
  add(i, l, strength, shiny);
#endif
}

// Light of all lamps, of the surroundings and of the surface itself. Hemisphere light: a surface that faces down
// receives the dimmer light that the floor returns (half of it, a medium grey floor).
vec3 light_on(vec3 glowing) {
  sum = glowing + bounce * ambient_light * (0.75 + 0.25 * n.z);
  LAMPS
  return sum;
}
