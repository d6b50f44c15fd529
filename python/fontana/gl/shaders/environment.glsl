// The world around the scene: a sun, a hazy sky, and what the ground reflects. Linear colours, 1 is a white wall in light.
uniform vec3 sun_direction;    // towards the sun, unit
uniform sampler3D noise_cube;  // white noise, repeated

const vec3 SUN_COLOUR = vec3(2.35, 2.12, 1.78);
const vec3 SKY_ZENITH = vec3(0.11, 0.26, 0.58);
const vec3 SKY_HORIZON = vec3(0.62, 0.74, 0.86);
const vec3 GROUND_COLOUR = vec3(0.33, 0.30, 0.27);

float noise(vec3 p) {
    vec3 cell = floor(p);
    vec3 f = p - cell;
    return texture(noise_cube, (cell + f * f * (3.0 - 2.0 * f) + 0.5) / 32.0).r;
}

float fractal_noise(vec3 p) {
    return 0.5 * noise(p) + 0.25 * noise(2.03 * p + 7.1) + 0.125 * noise(4.1 * p + 3.7) + 0.0625 * noise(8.3 * p);
}

vec3 sky(vec3 direction) {
    float height = max(direction.y, 0.0);
    vec3 colour = mix(SKY_HORIZON, SKY_ZENITH, 1.0 - exp(-3.2 * height));
    float toward_sun = max(dot(direction, sun_direction), 0.0);
    colour += vec3(0.30, 0.24, 0.16) * pow(toward_sun, 12.0);
    vec2 plane = direction.xz / (height + 0.12);
    float cover = smoothstep(0.42, 0.66, fractal_noise(vec3(1.1 * plane, 2.0)));
    vec3 cloud = mix(vec3(0.70, 0.74, 0.80), vec3(1.05, 1.02, 0.98), smoothstep(0.4, 0.75, fractal_noise(vec3(2.3 * plane, 5.0))));
    return mix(colour, cloud, 0.75 * cover * smoothstep(0.02, 0.25, height));
}

// What a ray that leaves the scene meets.
vec3 surroundings(vec3 direction) {
    vec3 below = mix(SKY_HORIZON * 0.9, GROUND_COLOUR, smoothstep(0.0, 0.12, -direction.y));
    return mix(below, sky(direction), smoothstep(-0.01, 0.01, direction.y));
}

// The light of sky and ground on a surface that sees all of both.
vec3 ambient_light(vec3 normal) {
    vec3 above = 0.5 * (SKY_ZENITH + SKY_HORIZON) * 1.15;
    return mix(GROUND_COLOUR * 0.55, above, 0.5 + 0.5 * normal.y);
}
