// Edge image: the length of Sobel's gradient of luminance, times `gain`.
uniform float gain = 1.0;

float luminance(int x, int y) {
  return dot(texture(picture, where + vec2(x, y) * texel).rgb, vec3(0.2126, 0.7152, 0.0722));
}
vec4 shade() {
  float dx = luminance(1, -1) + 2.0 * luminance(1, 0) + luminance(1, 1) - luminance(-1, -1) - 2.0 * luminance(-1, 0) - luminance(-1, 1);
  float dy = luminance(-1, 1) + 2.0 * luminance(0, 1) + luminance(1, 1) - luminance(-1, -1) - 2.0 * luminance(0, -1) - luminance(1, -1);
  return vec4(vec3(gain * length(vec2(dx, dy))), 1.0);
}
