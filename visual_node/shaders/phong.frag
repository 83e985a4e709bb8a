// Lit per pixel, with the maps and the mirror of its look.
vec4 shade() { return surface(); }
