// The water: what it bends, swallows and mirrors.
#include "environment.glsl"
#include "lights.glsl"
#include "screen.glsl"
uniform mat4 projection, view;
uniform sampler2D scene_colour, scene_depth, fluid_depth, fluid_thickness;
uniform float stage_size;  // m
uniform float drop_size;   // m
in vec2 uv;
layout(location = 0) out vec4 colour;

const float NOTHING = 1e5;
const float INDEX = 1.333;
const vec3 SCATTER = vec3(0.010, 0.062, 0.088);
const vec3 FOAM = vec3(0.80, 0.84, 0.86);

vec2 to_uv(vec3 place) {
    vec4 clip = projection * vec4(place, 1.0);
    return clip.xy / clip.w * 0.5 + 0.5;
}

vec3 fluid_place(ivec2 at, vec2 size) {
    return view_place((vec2(at) + 0.5) / size, texelFetch(fluid_depth, clamp(at, ivec2(0), ivec2(size) - 1), 0).r);
}

// Of the two neighbours on an axis the one that is nearer in depth: the other may be another piece of water.
vec3 slope(ivec2 at, ivec2 axis, vec3 here, vec2 size) {
    vec3 ahead = fluid_place(at + axis, size) - here;
    vec3 behind = here - fluid_place(at - axis, size);
    return abs(ahead.z) < abs(behind.z) ? ahead : behind;
}

// Where the bent ray meets the scene, found by walking to the depth of what was met before. Behind the water it turns
// back, nearly all the way: the faces of a sheet are parallel, those of a drop are not. What it meets may hide behind a
// rim that is nearer than the water: then a shorter way has to do.
vec3 refracted(vec3 here, vec3 away, vec3 ray, float thickness, vec2 straight) {
    vec3 leaving = normalize(mix(ray, away, 0.8));
    vec2 met = straight;
    float far = texture(scene_depth, met).r, share = 1.0;
    for (int k = 0; k < 6; ++k) {
        float within = min(thickness, max(far + here.z, 0.0) / max(-ray.z, 0.2));
        vec3 exit = here + share * within * ray;
        float beyond = max(far + exit.z, 0.0) / max(-leaving.z, 0.2);
        vec2 at = clamp(to_uv(exit + min(beyond, 4.0 * stage_size) * leaving), 0.001, 0.999);
        float depth = texture(scene_depth, at).r;
        if (depth < -here.z) {
            share *= 0.75;
        } else {
            met = at;
            far = depth;
        }
    }
    return texture(scene_colour, met).rgb;
}

// The scene in the mirror where it is in the picture, else the surroundings.
vec3 reflected(vec3 here, vec3 ray) {
    vec3 outside = surroundings(mat3(camera_to_world) * ray);
    float way = 0.01 * stage_size;
    for (int k = 0; k < 14; ++k) {
        vec3 place = here + way * ray;
        vec2 at = to_uv(place);
        if (place.z > 0.0 || any(lessThan(at, vec2(0.0))) || any(greaterThan(at, vec2(1.0)))) break;
        float behind = -place.z - texture(scene_depth, at).r;
        if (behind > 0.0 && behind < 0.06 * stage_size) return texture(scene_colour, at).rgb;
        way += 0.02 * stage_size * (1.0 + 0.25 * float(k));
    }
    return outside;
}

void main() {
    float depth = texture(fluid_depth, uv).r;
    vec3 behind = texture(scene_colour, uv).rgb;
    if (depth > NOTHING) {
        colour = vec4(behind, 1.0);
        return;
    }
    vec2 size = vec2(textureSize(fluid_depth, 0));
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec3 here = view_place(uv, depth);
    vec3 normal = normalize(cross(slope(at, ivec2(1, 0), here, size), slope(at, ivec2(0, 1), here, size)));
    vec3 away = normalize(here);
    if (dot(normal, away) > -0.05) normal = normalize(normal - away * (dot(normal, away) + 0.05));
    vec2 water = texture(fluid_thickness, uv).rg;

    vec3 place = world_place(uv, depth), facing = mat3(camera_to_world) * normal;
    vec3 sun = SUN_COLOUR * sun_light(place, facing);
    vec3 open_sky = sky_light(place, facing);
    vec3 light = sun * (0.35 + 0.65 * max(dot(facing, sun_direction), 0.0)) + ambient_light(facing) * open_sky;

    vec3 through = exp(-light_absorption * water.x);
    vec3 body = refracted(here, away, refract(away, normal, 1.0 / INDEX), water.x, uv) * through + SCATTER * light * (1.0 - through);
    float fresnel = 0.02 + 0.98 * pow(1.0 - max(-dot(normal, away), 0.0), 5.0);
    vec3 mirror = reflected(here, reflect(away, normal));
    vec3 halfway = normalize(sun_direction - mat3(camera_to_world) * away);
    vec3 glint = sun * 9.0 * pow(max(dot(facing, halfway), 0.0), 420.0);
    colour = vec4(mix(body, mirror, fresnel) + glint * (0.2 + fresnel), 1.0);

    float foam = 1.0 - exp(-water.y / (1.2 * drop_size));
    colour.rgb = mix(colour.rgb, FOAM * (0.30 * sun + ambient_light(vec3(0.0, 1.0, 0.0)) * open_sky), 0.75 * foam);
}
