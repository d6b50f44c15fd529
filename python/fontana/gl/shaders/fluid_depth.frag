// The nearest face of the water, where no solid hides it.
#include "sphere.glsl"
uniform sampler2D scene_depth;
layout(location = 0) out float depth;

void main() {
    vec3 hit;
    float chord;
    if (!meet_sphere(hit, chord)) discard;
    if (-hit.z > texelFetch(scene_depth, ivec2(gl_FragCoord.xy), 0).r) discard;
    depth = -hit.z;
    gl_FragDepth = clip_depth(hit);
}
