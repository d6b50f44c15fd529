// A kernel that is not of the core, for own_kernel_test.cpp: it uses one of the core's headers, a struct by value and
// buffers of two types.
#ifndef FONTANA_TEST_OWN_KERNEL_H
#define FONTANA_TEST_OWN_KERNEL_H

#include "smoothing.h"

typedef struct {
    float support_radius, scale;
    uint count;
} WeighConstants;

// weight[i] = scale * poly6(|position[i]|), without its constant factor.
KERNEL void weigh(THREAD_ARG const WeighConstants c, GLOBAL const float4* RESTRICT position,
                  GLOBAL float* RESTRICT weight) {
    const uint i = THREAD_INDEX;
    if (i >= c.count) return;
    const float4 x = position[i];
    const float r_squared = x.x * x.x + x.y * x.y + x.z * x.z;
    const float support_squared = c.support_radius * c.support_radius;
    weight[i] = r_squared < support_squared ? c.scale * poly6(r_squared, support_squared) : 0.0f;
}

#endif
