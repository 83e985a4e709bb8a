// Common inputs of every screen pass; documented for authors in visual_node/shaders/README.md.
in vec2 where;
uniform sampler2D picture;  // the picture so far, linear
uniform vec2 texel;         // size of a pixel
out vec4 colour;
