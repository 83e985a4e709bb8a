// Removes the share `amount` of the colour; luminance as in ITU-R BT.709-6, table 4.
uniform float amount = 1.0;

vec4 shade() {
  vec4 c = texture(picture, where);
  return vec4(mix(c.rgb, vec3(dot(c.rgb, vec3(0.2126, 0.7152, 0.0722))), amount), c.a);
}
