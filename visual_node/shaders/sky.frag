#version 330 core
in vec3 towards;
uniform samplerCube environment;
uniform float exposure;
out vec4 colour;
void main() { colour = vec4(texture(environment, towards).rgb * exposure, 1.0); }
