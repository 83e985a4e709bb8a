void main() { colour = vec4(shade().rgb, 1.0); }
