#include "environment.glsl"
#include "lights.glsl"
uniform int material;      // 0 ground, 1 stone, 2 rock, 3 wall
uniform float stage_size;  // m
uniform vec3 stage_middle;
in vec3 place, local, normal;
in float view_depth;
layout(location = 0) out vec4 colour;
layout(location = 1) out float depth;

const float PLAZA = 2.6;  // its radius over the size of the stage

struct Surface {
    vec3 albedo;
    vec3 facing;
};

vec3 bumped(vec3 n, vec3 p, float strength) {
    const float step_size = 0.15;
    float here = fractal_noise(p);
    vec3 slope = vec3(fractal_noise(p + vec3(step_size, 0.0, 0.0)), fractal_noise(p + vec3(0.0, step_size, 0.0)),
                      fractal_noise(p + vec3(0.0, 0.0, step_size))) - here;
    slope -= n * dot(slope, n);
    return normalize(n - strength * slope / step_size);
}

// Slabs in running bond, with joints that fade where they get too fine to see.
vec3 paving() {
    vec2 scaled = place.xz / (vec2(0.21, 0.14) * stage_size);
    vec2 blur = max(fwidth(scaled), 1e-5);
    vec2 at = scaled + vec2(0.5 * mod(floor(scaled.y), 2.0), 0.0);
    vec2 slab = floor(at), within = at - slab;
    vec2 edge = min(within, 1.0 - within) * vec2(1.5, 1.0);
    vec2 joint = (1.0 - smoothstep(vec2(0.008), 0.018 + 1.5 * blur, edge)) * clamp(0.06 / blur, 0.0, 1.0);
    float tone = mix(noise(vec3(slab * 1.7, 0.5)), 0.5, clamp(2.0 * max(blur.x, blur.y), 0.0, 1.0));
    float stain = fractal_noise(place * 7.0 / stage_size);
    float grain = fractal_noise(place * 120.0 / stage_size);
    vec3 albedo = mix(vec3(0.125, 0.122, 0.120), vec3(0.195, 0.186, 0.176), tone);
    return albedo * (0.62 + 0.50 * stain + 0.36 * grain) * (1.0 - 0.5 * max(joint.x, joint.y));
}

vec3 grass() {
    vec3 p = place / stage_size;
    float patches = fractal_noise(p * 1.3) + 0.4 * fractal_noise(p * 11.0);
    return mix(vec3(0.045, 0.065, 0.026), vec3(0.092, 0.108, 0.046), clamp(patches - 0.1, 0.0, 1.0));
}

// A paved square in a park.
Surface ground() {
    float away = length(place.xz - stage_middle.xz) / stage_size;
    float edge = PLAZA + 0.06 * noise(place * 6.0 / stage_size);
    vec3 albedo = away < edge ? paving() : grass();
    if (abs(away - PLAZA + 0.05) < 0.05) albedo = vec3(0.24, 0.23, 0.215);
    return Surface(albedo, bumped(normal, place * 60.0 / stage_size, 0.05));
}

Surface stone() {
    vec3 p = place / stage_size;
    float speckle = noise(p * 260.0) * noise(p * 170.0 + 3.0);
    vec3 albedo = vec3(0.40, 0.378, 0.342) * (0.66 + 0.55 * fractal_noise(p * 14.0) + 0.22 * (speckle - 0.25));
    return Surface(albedo, bumped(normal, p * 60.0, 0.07));
}

Surface rock() {
    vec3 p = local / length(local + 1e-9) * 2.1;
    float veins = smoothstep(0.03, 0.0, abs(fractal_noise(p * 1.1 + 4.0) - 0.46));
    vec3 albedo = mix(vec3(0.17, 0.145, 0.125), vec3(0.34, 0.30, 0.265), fractal_noise(p * 2.0 + 9.0) * 1.4 - 0.1);
    albedo *= 1.0 - 0.35 * veins;
    return Surface(albedo, bumped(bumped(normal, p * 1.6, 0.9), p * 8.0, 0.28));
}

Surface wall() { return Surface(vec3(0.56, 0.57, 0.58) * (0.85 + 0.25 * fractal_noise(place * 12.0 / stage_size)), normal); }

void main() {
    Surface surface;
    if (material == 0) surface = ground();
    else if (material == 1) surface = stone();
    else if (material == 2) surface = rock();
    else surface = wall();
    vec3 n = normalize(normal);
    vec3 shaded = lit(surface.albedo, place, n, normalize(surface.facing));
    if (material == 0) {
        float far = length(place - stage_middle) / stage_size;
        shaded = mix(shaded, FAR_GROUND, 1.0 - exp(-max(far - 3.0, 0.0) / 34.0));
    }
    colour = vec4(shaded, 1.0);
    depth = view_depth;
}
