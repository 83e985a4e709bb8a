#version 330 core
// The colour is already sRGB.
flat in vec4 fill;
out vec4 colour;
void main() { colour = fill; }
