void main() {
  begin();
  vec4 s = shade();
  colour = vec4(s.rgb * exposure, s.a);
}
