// How much light arrives: from the sun, and from a part of the sky, each with a map of what stands in its way.
struct LightMap {
    mat4 matrix;  // world to the map, 0 to 1 on each axis
    vec3 texel;   // m a texel, m of its depth, width of its edges in texels
};
uniform LightMap sun_map, sky_map;
uniform sampler2D sun_solid, sky_solid;  // depth of the nearest solid
uniform sampler2D sun_fluid, sky_fluid;  // x: metres of water along the ray; w: depth of the first water
uniform vec3 light_absorption;           // 1/m
uniform float ripple_time;               // s

const vec2 DISC[12] = vec2[](vec2(-0.326, -0.406), vec2(-0.840, -0.074), vec2(-0.696, 0.457), vec2(-0.203, 0.621),
                             vec2(0.962, -0.195), vec2(0.473, -0.480), vec2(0.519, 0.767), vec2(0.185, -0.893),
                             vec2(0.507, 0.064), vec2(0.896, 0.412), vec2(-0.322, -0.933), vec2(-0.792, -0.598));

float solid_visibility(sampler2D solid, vec3 at, vec3 texel) {
    vec2 scale = texel.z / vec2(textureSize(solid, 0));
    float angle = 6.2832 * fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));
    mat2 turn = mat2(cos(angle), sin(angle), -sin(angle), cos(angle));
    float seen = 0.0;
    for (int k = 0; k < 12; ++k) seen += step(at.z, texture(solid, at.xy + turn * DISC[k] * scale).r);
    return seen / 12.0;
}

// What water lets through on the way to `at`: only the water above it counts.
vec3 fluid_transmittance(sampler2D fluid, vec3 at, vec3 texel) {
    vec4 water = texture(fluid, at.xy);
    float above = clamp((at.z - water.w) * texel.y, 0.0, water.x);
    return exp(-light_absorption * above);
}

// The net of light that ripples throw on what lies under them: drawn after nature, not traced.
float caustics(vec3 at, vec3 texel) {
    vec4 water = texture(sun_fluid, at.xy);
    float above = clamp((at.z - water.w) * texel.y, 0.0, water.x) * light_absorption.g;
    vec2 p = at.xy * 34.0;
    vec2 warp = vec2(noise(vec3(0.6 * p, ripple_time)), noise(vec3(0.6 * p + 9.0, ripple_time)));
    float first = 1.0 - abs(2.0 * noise(vec3(p + 1.5 * warp, 1.3 * ripple_time)) - 1.0);
    float second = 1.0 - abs(2.0 * noise(vec3(1.7 * p - 1.2 * warp + 5.0, 1.1 * ripple_time)) - 1.0);
    float net = pow(first, 6.0) + 0.8 * pow(first * second, 4.0);
    return mix(1.0, 0.72 + 1.5 * net, smoothstep(0.01, 0.10, above));
}

vec3 on_map(LightMap map, vec3 place, vec3 normal) {
    vec3 at = (map.matrix * vec4(place + normal * map.texel.x * (1.0 + 0.7 * map.texel.z), 1.0)).xyz;
    return at - vec3(0.0, 0.0, 1.5 * map.texel.x / map.texel.y);
}

bool is_outside(vec3 at) { return any(lessThan(at, vec3(0.0))) || any(greaterThan(at, vec3(1.0))); }

vec3 sun_light(vec3 place, vec3 normal) {
    vec3 at = on_map(sun_map, place, normal);
    if (is_outside(at)) return vec3(1.0);
    return solid_visibility(sun_solid, at, sun_map.texel) * fluid_transmittance(sun_fluid, at, sun_map.texel) *
           caustics(at, sun_map.texel);
}

vec3 sky_light(vec3 place, vec3 normal) {
    vec3 at = on_map(sky_map, place, normal);
    if (is_outside(at)) return vec3(1.0);
    return solid_visibility(sky_solid, at, sky_map.texel) * fluid_transmittance(sky_fluid, at, sky_map.texel);
}

vec3 lit(vec3 albedo, vec3 place, vec3 normal, vec3 facing) {
    vec3 sun = SUN_COLOUR * max(dot(facing, sun_direction), 0.0) * sun_light(place, normal);
    return albedo * (sun + ambient_light(facing) * mix(vec3(0.30), vec3(1.0), sky_light(place, normal)));
}
