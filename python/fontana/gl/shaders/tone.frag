// Light to what a screen can show: straight up to 0.7, then a shoulder towards 1.
uniform sampler2D light;
uniform float share;
in vec2 uv;
out vec4 colour;

void main() {
    vec3 c = texture(light, uv).rgb;
    vec3 over = max(c - 0.7, 0.0);
    colour = vec4(share * (min(c, 0.7) + 0.3 * over / (over + 0.55)), share);
}
