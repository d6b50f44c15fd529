uniform sampler2D picture;
in vec2 uv;
out vec4 colour;

void main() {
    vec3 c = clamp(texture(picture, uv).rgb, 0.0, 1.0);
    vec3 encoded = mix(12.92 * c, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, c));
    colour = vec4(encoded, 1.0);
}
