// Density and pressure.
#ifndef FONTANA_DENSITY_H
#define FONTANA_DENSITY_H

#include "cells.h"
#include "smoothing.h"

// p = k (density - rest density), eq. 2.11
FN float equation_of_state(const StepConstants c, float density) {
    return max_f(c.minimum_pressure, c.pressure_constant * (density - c.rest_density));
}

// What `density` ends with: from the sum without its constant to what it puts out.
FN void store_pressure_state(const StepConstants c, uint i, float sum, float4 x_i, float4 v_i,
                             GLOBAL float* RESTRICT density_out, GLOBAL float4* RESTRICT packed_position,
                             GLOBAL float4* RESTRICT packed_velocity, GLOBAL float* RESTRICT pressure) {
    const float density_i = c.poly6_scale * sum, p_i = equation_of_state(c, density_i);
    density_out[i] = density_i;
    packed_position[i] = MAKE_FLOAT4(x_i.x, x_i.y, x_i.z, x_i.w / density_i);
    packed_velocity[i] = MAKE_FLOAT4(v_i.x, v_i.y, v_i.z, p_i);
    pressure[i] = p_i;
}

// density_i = sum_j m_j W_poly6(x_ij), eq. 2.8.
//
// position: x, y, z, mass. Out: `packed_position` = x, y, z, m/density and `packed_velocity` = vx, vy, vz, p, the
// 32 bytes a neighbour costs in the force pass.
KERNEL void density(THREAD_ARG const StepConstants c, GLOBAL const float4* RESTRICT position,
                    GLOBAL const float4* RESTRICT velocity, GLOBAL const uint* RESTRICT cell_start,
                    GLOBAL float* RESTRICT density_out, GLOBAL float4* RESTRICT packed_position,
                    GLOBAL float4* RESTRICT packed_velocity, GLOBAL float* RESTRICT pressure) {
    const uint i = THREAD_INDEX;
    if (i >= c.particle_count) return;
    const float4 x_i = position[i];
    const CellCoordinates cell = cell_of(c, x_i);
    const uint range_count = candidate_range_count(c, cell);
    float sum = 0.0f;
    for (uint k = 0u; k < range_count; ++k) {
        const Range range = candidate_range(c, cell, k, cell_start);
        for (uint j = range.begin; j < range.end; ++j) {
            const float4 x_j = position[j];
            const float dx = x_i.x - x_j.x, dy = x_i.y - x_j.y, dz = x_i.z - x_j.z;
            const float r_squared = dx * dx + dy * dy + dz * dz;
            if (r_squared < c.support_radius_squared) sum += x_j.w * poly6(r_squared, c.support_radius_squared);
        }
    }
    store_pressure_state(c, i, sum, x_i, velocity[i], density_out, packed_position, packed_velocity, pressure);
}

#endif
