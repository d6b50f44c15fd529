#include "environment.glsl"
#include "lights.glsl"
#include "sphere.glsl"
uniform mat4 camera_to_world;
uniform sampler2D color_map;
in float value;
layout(location = 0) out vec4 colour;
layout(location = 1) out float depth;

void main() {
    vec3 hit;
    float chord;
    if (!meet_sphere(hit, chord)) discard;
    vec3 normal = mat3(camera_to_world) * normalize(hit - view_centre);
    vec3 place = (camera_to_world * vec4(hit, 1.0)).xyz;
    vec3 albedo = texture(color_map, vec2(clamp(value, 0.002, 0.998), 0.5)).rgb;
    // Even light: what counts is that a colour can be found again in the legend.
    float sun = max(dot(normal, sun_direction), 0.0) * sun_light(place, normal).g;
    colour = vec4(albedo * (0.42 + 0.16 * normal.y + 0.55 * sun), 1.0);
    depth = -hit.z;
    gl_FragDepth = clip_depth(hit);
}
