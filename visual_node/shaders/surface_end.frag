uniform float see_through;  // 1: the background shows through, 0: opaque for any opacity from shade()

void main() {
  begin();
  vec4 s = shade();
  // Weighted here and not by blending, which would clip values brighter than white first.
  colour = vec4(s.rgb * (exposure * mix(1.0, s.a, see_through)), s.a);
}
