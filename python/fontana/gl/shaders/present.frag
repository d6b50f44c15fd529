uniform sampler2D picture;
in vec2 uv;
out vec4 colour;

void main() {
    vec3 c = clamp(texture(picture, uv).rgb, 0.0, 1.0);
    vec3 encoded = mix(12.92 * c, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, c));
    // Less than a step of eight bits, so that smooth skies show no bands.
    float grain = fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715)))) - 0.5;
    colour = vec4(encoded + grain / 255.0, 1.0);
}
