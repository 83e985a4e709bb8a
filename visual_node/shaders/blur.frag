// A Gaussian of `radius` pixels (its standard deviation), within 5 x 5 samples of 1 radius apart: what weak eyes see.
uniform float radius = 1.5;

vec4 shade() {
  vec4 sum = vec4(0.0);
  float weights = 0.0;
  for (int y = -2; y <= 2; ++y)
    for (int x = -2; x <= 2; ++x) {
      float w = exp(-0.5 * float(x * x + y * y));
      sum += w * texture(picture, where + vec2(x, y) * radius * texel);
      weights += w;
    }
  return sum / weights;
}
