// The world around the scene: a sun, a hazy sky, and what the ground reflects. Linear colours, 1 is a white wall in light.
uniform vec3 sun_direction;    // towards the sun, unit
uniform sampler3D noise_cube;  // white noise, repeated

const vec3 SUN_COLOUR = vec3(2.85, 2.60, 2.22);
const vec3 SKY_ZENITH = vec3(0.085, 0.23, 0.56);
const vec3 SKY_HORIZON = vec3(0.62, 0.74, 0.86);
const vec3 FAR_GROUND = vec3(0.150, 0.185, 0.120);
const vec3 GROUND_COLOUR = vec3(0.21, 0.19, 0.165);

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

// Trees far away, as high above the horizon as their noise.
vec3 treeline(vec3 direction, vec3 behind) {
    vec2 around = normalize(direction.xz);
    float height = 0.018 + 0.045 * fractal_noise(vec3(5.0 * around, 1.0)) + 0.010 * fractal_noise(vec3(60.0 * around, 3.0));
    float hills = 0.03 + 0.07 * fractal_noise(vec3(1.7 * around, 8.0));
    vec3 colour = mix(behind, vec3(0.36, 0.46, 0.56), 0.75 * smoothstep(0.004, -0.004, direction.y - hills));
    vec3 leaves = vec3(0.065, 0.100, 0.055) * (0.35 + 1.3 * fractal_noise(vec3(90.0 * around, 90.0 * direction.y)));
    return mix(colour, mix(leaves, SKY_HORIZON, 0.09), smoothstep(0.002, -0.002, direction.y - height));
}

// What a ray that leaves the scene meets.
vec3 surroundings(vec3 direction) {
    vec3 below = mix(FAR_GROUND, GROUND_COLOUR, smoothstep(0.0, 0.12, -direction.y));
    vec3 above = direction.y < 0.16 ? treeline(direction, sky(direction)) : sky(direction);
    return mix(below, above, smoothstep(-0.002, 0.002, direction.y));
}

// The light of sky and ground on a surface that sees all of both.
vec3 ambient_light(vec3 normal) {
    vec3 above = 0.5 * (SKY_ZENITH + SKY_HORIZON) * 0.72;
    return mix(GROUND_COLOUR * 0.35, above, 0.5 + 0.5 * normal.y);
}
