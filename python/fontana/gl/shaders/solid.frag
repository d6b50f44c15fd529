#include "environment.glsl"
#include "lights.glsl"
uniform int material;      // 0 ground, 1 stone, 2 rock, 3 wall
uniform float stage_size;  // m
uniform vec3 stage_middle;
in vec3 place, local, normal;
in float view_depth;
layout(location = 0) out vec4 colour;
layout(location = 1) out float depth;

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

// Square slabs with joints that fade where they get too fine to see.
Surface ground() {
    vec2 at = place.xz / (0.16 * stage_size);
    vec2 slab = floor(at), within = at - slab;
    float tone = noise(vec3(slab * 1.7, 0.5));
    vec2 blur = max(fwidth(at), 1e-5);
    vec2 edge = min(within, 1.0 - within);
    vec2 joint = (1.0 - smoothstep(vec2(0.012), 0.012 + 1.5 * blur, edge)) * clamp(0.05 / blur, 0.0, 1.0);
    float stain = fractal_noise(place * 9.0 / stage_size);
    float grain = fractal_noise(place * 90.0 / stage_size);
    vec3 albedo = mix(vec3(0.36, 0.335, 0.305), vec3(0.46, 0.43, 0.39), tone);
    albedo *= 0.72 + 0.35 * stain + 0.30 * grain;
    albedo *= 1.0 - 0.55 * max(joint.x, joint.y);
    return Surface(albedo, normal);
}

Surface stone() {
    vec3 p = place / stage_size;
    float speckle = noise(p * 260.0) * noise(p * 170.0 + 3.0);
    vec3 albedo = vec3(0.52, 0.48, 0.42) * (0.66 + 0.55 * fractal_noise(p * 14.0) + 0.22 * (speckle - 0.25));
    return Surface(albedo, bumped(normal, p * 60.0, 0.10));
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
        shaded = mix(shaded, SKY_HORIZON * 0.9, 1.0 - exp(-max(far - 3.0, 0.0) / 16.0));
    }
    colour = vec4(shaded, 1.0);
    depth = view_depth;
}
