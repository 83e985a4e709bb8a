#version 330 core
// Places one shape of a batch in the view of the lamp.
layout(location = 0) in vec3 position;
layout(location = 2) in vec4 orientation;
layout(location = 3) in vec4 place;
layout(location = 4) in vec4 scale;
uniform mat4 clip_from_world;

vec3 rotate(vec4 q, vec3 v) { return v + 2.0 * cross(q.xyz, cross(q.xyz, v) + q.w * v); }

void main() { gl_Position = clip_from_world * vec4(place.xyz + rotate(orientation, position * scale.xyz), 1.0); }
