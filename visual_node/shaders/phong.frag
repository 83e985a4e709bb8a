// Lit per pixel; with maps and a mirror where its look has them.
vec4 shade() { return surface(); }
