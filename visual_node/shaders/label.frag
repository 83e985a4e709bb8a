#version 330 core
// The colour is already sRGB.
uniform sampler2D coverage;  // of the text picture
in vec2 texel;
flat in vec4 fill;
out vec4 colour;
void main() { colour = vec4(fill.rgb, fill.a * texelFetch(coverage, ivec2(texel), 0).r); }
