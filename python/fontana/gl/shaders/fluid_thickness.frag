// How much water the ray of a pixel passes (x, m), and how much of it is spray (y, m).
#include "sphere.glsl"
uniform sampler2D scene_depth;
uniform ivec2 target_size;
uniform float filling;  // volume of a particle over that of its sphere
in float spray;
layout(location = 0) out vec2 thickness;

void main() {
    vec3 hit;
    float chord;
    if (!meet_sphere(hit, chord)) discard;
    ivec2 at = ivec2(gl_FragCoord.xy) * textureSize(scene_depth, 0) / target_size;
    if (-hit.z > texelFetch(scene_depth, at, 0).r) discard;
    thickness = filling * chord * vec2(1.0, spray);
}
