#if RELIEF
// Normal with relief: subtracts the gradient of the height along the surface from the outward normal (Blinn 1978,
// "Simulation of Wrinkled Surfaces"). The relief is projected along the dominant axis of the normal in the body
// frame, as in lcmtypes/bump.h.
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

// Normal, view and colours of this pixel, from the inputs and the maps.
void begin() {
  n = normalize(gl_FrontFacing ? facing : -facing);
#if RELIEF
  n = roughened(n);
#endif
#if NORMAL_MAP
  // glTF 2.0, 3.9.3: x along the tangent, y along the binormal, z out of the surface.
  vec3 m = texture(normal_map, uv).xyz * 2.0 - 1.0;
  vec3 along = tangent.xyz - n * dot(n, tangent.xyz);
  if (dot(along, along) > 1e-12) {
    vec3 t = normalize(along);
    n = normalize(m.x * t + m.y * tangent.w * cross(n, t) + m.z * n);
  }
#endif
  v = normalize(eye - at);
  nv = dot(n, v);
  base = paint, shine = polish, bounce = returned;
#if COLOUR_MAP
  vec4 texel = texture(colour_map, uv);
  base *= texel, bounce *= texel.rgb;
#endif
}

// Light of all lamps and of the surroundings that this surface returns, and its own glow; linear.
vec3 lit() {
#if GOURAUD
  vec3 light = lit_here;
#if SHADOWS
  light += lit_by_caster * textureProj(shadow_map, shadow_at);
#else
  light += lit_by_caster;
#endif
#if COLOUR_MAP
  light *= texture(colour_map, uv).rgb;
#endif
  return light;
#else
  return light_on(glow);
#endif
}

// Share of mirrored light (Schlick 1994, "An Inexpensive BRDF Model for Physically-based Rendering", eq. 15).
float fresnel() {
#if MIRROR
  // At the rim of a mesh, interpolated normals may face away from the eye; abs() keeps the share smooth there.
  float c = 1.0 - min(abs(nv), 1.0), cc = c * c;
  return reflectance + (1.0 - reflectance) * cc * cc * c;
#else
  return 0.0;
#endif
}

// Mirrored light; linear.
vec3 mirrored() {
#if MIRROR
  return texture(environment, reflect(-v, n)).rgb;
#else
  return vec3(0.0);
#endif
}

// The complete light: returned light weighted by opacity, and mirrored light independent of opacity. The background
// shows through the rest.
vec4 surface() {
#if MIRROR
  float f = fresnel(), opacity = mix(base.a, 1.0, f);
  return vec4(mix(base.a * lit(), mirrored(), f) / max(opacity, 1e-4), opacity);
#else
  return vec4(lit(), base.a);
#endif
}
