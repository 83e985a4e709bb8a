// Lit per vertex (Gouraud 1971); only what a shadow takes away is told per pixel.
vec4 shade() { return surface(); }
