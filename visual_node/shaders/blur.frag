// Gaussian blur with a standard deviation of `radius` pixels: 5 x 5 samples, 1 radius apart, first along one side
// of the picture and then along the other. Simulates weak eyesight.
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
