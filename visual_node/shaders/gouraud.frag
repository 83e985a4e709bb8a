// Lit per vertex (Gouraud 1971); only the shadow is evaluated per pixel.
vec4 shade() { return surface(); }
