// A Gaussian of `radius` pixels (its standard deviation), within 5 x 5 samples of 1 radius apart, first along one side of the
// picture and then along the other: what weak eyes see.
uniform float radius = 1.5;
uniform vec2 along;

vec4 shade() {
  vec4 sum = vec4(0.0);
  float weights = 0.0;
  for (int i = -2; i <= 2; ++i) {
    float w = exp(-0.5 * float(i * i));
    sum += w * texture(picture, where + float(i) * radius * along * texel);
    weights += w;
  }
  return sum / weights;
}
