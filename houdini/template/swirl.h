// The kernel: one step of points carried round a vertical axis, in the dialect of src/fontana/kernels/.
#ifndef SWIRL_H
#define SWIRL_H

#include "dialect.h"

// Travels as one argument: 4-byte members only.
typedef struct {
    float centre_x, centre_z;
    float angle;   // radians a step, at the axis
    float radius;  // where it is half of that
    uint point_count;
} SwirlConstants;

// How far a point at (x, z) from the axis turns in a step: a vortex that is fastest at its axis.
FN float swirl_angle(float x, float z, float angle, float radius) {
    return angle / (1.0f + (x * x + z * z) / (radius * radius));
}

// The midpoint rule: half a step to find the direction, then the whole step along it. Three floats a point, as in
// Houdini's P.
KERNEL void swirl(THREAD_ARG const SwirlConstants c, GLOBAL float* RESTRICT position) {
    const uint i = THREAD_INDEX;
    if (i >= c.point_count) return;
    const float x = position[3u * i] - c.centre_x, z = position[3u * i + 2u] - c.centre_z;
    const float half_turn = 0.5f * swirl_angle(x, z, c.angle, c.radius);
    const float middle_x = x + half_turn * z, middle_z = z - half_turn * x;
    const float turn = swirl_angle(middle_x, middle_z, c.angle, c.radius);
    position[3u * i] = c.centre_x + x + turn * middle_z;
    position[3u * i + 2u] = c.centre_z + z - turn * middle_x;
}

#endif
