// What every pass over the whole picture has; README.md says it for those who write one.
in vec2 where;
uniform sampler2D picture;  // so far, linear
uniform vec2 texel;         // one pixel
out vec4 colour;
