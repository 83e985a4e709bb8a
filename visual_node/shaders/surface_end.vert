void main() {
  at = place.xyz + rotate(orientation, position * scale.xyz);
  facing = rotate(orientation, normal);
  paint = diffuse;
  polish = vec4(specular.rgb, scale.w);
  returned = ambient.rgb;
  glow = emissive.rgb;
#if RELIEF
  for (int i = 0; i < 3; ++i) body_axes[i] = rotate(body_orientation, mat3(1.0)[i]);
  at_body = (at - body_place.xyz) * body_axes;  // multiplication from the left: inverse rotation, into the body frame
  facing_body = facing * body_axes;
#endif
#if MAPPED
  uv = texcoord;
  tangent = vec4(rotate(orientation, tangent_in.xyz * scale.xyz), tangent_in.w);
#endif
#if GOURAUD
  base = paint, shine = polish, bounce = returned;
  n = normalize(facing), v = normalize(eye - at), nv = dot(n, v);
  shaded = vec3(0.0);
  lit_here = light_on(glow), lit_by_caster = shaded;
#endif
#ifdef MOVES
  at = moved(at);
#endif
  // Shifts the point along the normal, so that a surface does not shadow itself. Inside a transparent shape it
  // shifts inwards: otherwise the surface below would shadow its bottom.
  float side = dot(facing, eye - at) < 0.0 ? 1.0 - 2.0 * see_through : 1.0;
  shadow_at = shadow_from_world * vec4(at + 0.008 * side * facing, 1.0);
  gl_Position = clip_from_world * vec4(at, 1.0);
}
