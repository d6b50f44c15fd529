// The nearest face of the water, where no solid hides it.
#include "sphere.glsl"
uniform sampler2D scene_depth;
in float body;
layout(location = 0) out vec2 surface;  // depth (m); how much of it is to be smoothed

void main() {
    vec3 hit;
    float chord;
    if (!meet_sphere(hit, chord)) discard;
    if (-hit.z > texelFetch(scene_depth, ivec2(gl_FragCoord.xy), 0).r) discard;
    surface = vec2(-hit.z, body);
    gl_FragDepth = clip_depth(hit);
}
