uniform float see_through;  // 1: what is behind shows through, 0: it is opaque whatever shade() says

void main() {
  begin();
  vec4 s = shade();
  // Weighed here and not by the blending, which would cut off before what is brighter than white.
  colour = vec4(s.rgb * (exposure * mix(1.0, s.a, see_through)), s.a);
}
