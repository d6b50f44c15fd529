// Surface tension by the colour field, Mueller et al. 2003, section 3.3.
#ifndef FONTANA_SURFACE_TENSION_H
#define FONTANA_SURFACE_TENSION_H

#include "cells.h"
#include "smoothing.h"

// With the colour field c = sum_j V_j W_poly6 and its gradient n: f = - sigma lap(c) n / |n| (eq. 19), where |n| shows
// that the particle is at a surface. Adds f / density_i to the acceleration. packed_position: x, y, z and, times
// `volume_scale`, V.
KERNEL void surface_tension(THREAD_ARG const StepConstants c, const float volume_scale,
                            GLOBAL const float4* RESTRICT packed_position, GLOBAL const float* RESTRICT density_in,
                            GLOBAL const uint* RESTRICT cell_start, GLOBAL float4* RESTRICT acceleration) {
    const uint i = THREAD_INDEX;
    if (i >= c.particle_count) return;
    const float4 x_i = packed_position[i];
    const CellCoordinates cell = cell_of(c, x_i);
    const uint range_count = candidate_range_count(c, cell);
    float normal_x = 0.0f, normal_y = 0.0f, normal_z = 0.0f, laplacian = 0.0f;
    for (uint k = 0u; k < range_count; ++k) {
        const Range range = candidate_range(c, cell, k, cell_start);
        for (uint j = range.begin; j < range.end; ++j) {
            const float4 x_j = packed_position[j];
            const float dx = x_i.x - x_j.x, dy = x_i.y - x_j.y, dz = x_i.z - x_j.z;
            const float r_squared = dx * dx + dy * dy + dz * dz;
            if (r_squared < c.support_radius_squared) {
                const float g = x_j.w * poly6_gradient(r_squared, c.support_radius_squared);
                normal_x -= g * dx;
                normal_y -= g * dy;
                normal_z -= g * dz;
                laplacian -= x_j.w * poly6_laplacian(r_squared, c.support_radius_squared);
            }
        }
    }
    normal_x *= volume_scale;
    normal_y *= volume_scale;
    normal_z *= volume_scale;
    laplacian *= volume_scale;
    const float length = SQRT(normal_x * normal_x + normal_y * normal_y + normal_z * normal_z);
    if (c.poly6_gradient_scale * length <= c.minimum_normal) return;
    const float s = -c.surface_tension * c.poly6_gradient_scale * laplacian / (length * density_in[i]);
    float4 a = acceleration[i];
    a.x += s * normal_x;
    a.y += s * normal_y;
    a.z += s * normal_z;
    acceleration[i] = a;
}

#endif
