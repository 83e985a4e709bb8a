#version 330 core
// Phong's reflection per pixel in linear light; the framebuffer encodes it as sRGB. gl/renderer.cpp defines SHADOWS, RELIEF
// and, lamp by lamp, LAMPS for the scene: a software renderer pays for every branch of every pixel.
in vec3 at;
in vec3 facing;
in vec4 shadow_at;
flat in vec4 base;
flat in vec4 shine;
flat in vec3 bounce;
flat in vec3 glow;
#if RELIEF
in vec3 at_body;
in vec3 facing_body;
flat in mat3 body_axes;       // in the world
uniform sampler2D slope_map;  // dh/du, dh/dv, m/m
uniform vec2 relief_size;     // of one repetition, m
#endif

struct Light {       // struct Light in scene_view/draw_list.h
  vec4 position;
  vec4 direction;
  vec4 diffuse;      // w: range
  vec4 specular;
  vec4 attenuation;
  vec4 cone;         // factor and offset on the cosine to the axis, exponent of the falloff
};
layout(std140) uniform Lights { Light lights[LIGHTS]; };
uniform vec3 eye;
uniform vec3 ambient_light;
uniform float exposure;
#if SHADOWS
uniform sampler2DShadow shadow_map;
#endif

out vec4 colour;

vec3 n;    // surface normal
vec3 v;    // to the eye
float nv;  // their cosine
vec3 sum;  // light to the eye

// What the lamp at `l` (unit, to the lamp) adds; shiny: it makes highlights. The lobe is Schlick's t / (s - s t + t) in
// place of t^s (Schlick 1994, "A fast alternative to Phong's specular model", Graphics Gems IV): a division instead of a
// power. All bool arguments in this file are known to the compiler.
void add(int i, vec3 l, float strength, bool shiny) {
  float nl = dot(n, l);
  sum += (strength * max(nl, 0.0)) * base.rgb * lights[i].diffuse.rgb;
  if (shiny) {
    float t = max(2.0 * nl * nv - dot(l, v), 0.0) * step(0.0, nl);
    sum += (strength * t / (shine.w - shine.w * t + t)) * shine.rgb * lights[i].specular.rgb;
  }
}

void directional(int i, bool shiny) { add(i, -lights[i].direction.xyz, 1.0, shiny); }

// coned: a spot; falls: with an exponent other than 1; shadowed: through the shadow map.
void lamp(int i, bool shiny, bool coned, bool falls, bool shadowed) {
  vec3 to = lights[i].position.xyz - at;
  float dd = dot(to, to), inverse = inversesqrt(dd), d = dd * inverse;
  vec3 l = to * inverse;
  float strength = step(d, lights[i].diffuse.w) /
                   max(lights[i].attenuation.x + lights[i].attenuation.y * d + lights[i].attenuation.z * dd, 1e-4);
  if (coned) {
    float inside = clamp(lights[i].cone.y - dot(l, lights[i].direction.xyz) * lights[i].cone.x, 0.0, 1.0);
    strength *= falls ? pow(inside, lights[i].cone.z) : inside;
  }
#if SHADOWS
  if (shadowed) strength *= textureProj(shadow_map, shadow_at);  // 2 x 2 texels, filtered by the sampler
#endif
  add(i, l, strength, shiny);
}

#if RELIEF
// The normal of the relief: the height's gradient along the surface, taken off the outward normal (Blinn 1978, "Simulation
// of Wrinkled Surfaces"). Projected along the dominant axis of the normal in the body frame, as in lcmtypes/bump.h.
vec3 roughened(vec3 smooth_n) {
  vec3 a = abs(facing_body);
  bool z = a.z >= a.x && a.z >= a.y, x = !z && a.x >= a.y;
  vec2 place = z ? at_body.xy : x ? at_body.yz : at_body.zx;
  vec2 slope = texture(slope_map, place / relief_size).rg;
  vec3 g = body_axes * (z ? vec3(slope, 0.0) : x ? vec3(0.0, slope) : vec3(slope.y, 0.0, slope.x));
  g -= dot(g, smooth_n) * smooth_n;
  return normalize(smooth_n - (gl_FrontFacing ? g : -g));
}
#endif

void main() {
  n = normalize(gl_FrontFacing ? facing : -facing);
#if RELIEF
  n = roughened(n);
#endif
  v = normalize(eye - at);
  nv = dot(n, v);
  // Hemisphere: what looks down gets the dimmer light that the floor returns (half of it, a floor of middling grey).
  sum = glow + bounce * ambient_light * (0.75 + 0.25 * n.z);
  LAMPS
  colour = vec4(sum * exposure, base.a);
}
