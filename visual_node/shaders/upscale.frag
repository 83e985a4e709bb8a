#version 330 core
in vec2 at;
flat in vec4 within;
uniform sampler2D small;
out vec4 colour;
void main() { colour = texture(small, clamp(at, within.xy, within.zw)); }
