// Pressure and viscosity as an acceleration.
#ifndef FONTANA_FLUID_FORCE_H
#define FONTANA_FLUID_FORCE_H

#include "cells.h"
#include "force_pair.h"

// acceleration_i = (f_pressure + f_viscosity) / density_i, eq. 2.7, with
//   f_pressure  = - sum_j V_j (p_i + p_j)/2 grad W_spiky,    eq. 2.10
//   f_viscosity = mu sum_j V_j (v_j - v_i) lap W_viscosity,  eq. 2.13
FN float4 force_to_acceleration(const StepConstants c, ForceSum sum, float density) {
    const float a = 0.5f * c.spiky_gradient_scale / density;
    const float b = c.viscosity * c.viscosity_laplacian_scale / density;
    return MAKE_FLOAT4(a * sum.pressure_x + b * sum.viscous_x, a * sum.pressure_y + b * sum.viscous_y,
                       a * sum.pressure_z + b * sum.viscous_z, 0.0f);
}

KERNEL void fluid_force(THREAD_ARG const StepConstants c, GLOBAL const float4* RESTRICT packed_position,
                        GLOBAL const float4* RESTRICT packed_velocity, GLOBAL const float* RESTRICT density_in,
                        GLOBAL const uint* RESTRICT cell_start, GLOBAL float4* RESTRICT acceleration) {
    const uint i = THREAD_INDEX;
    if (i >= c.particle_count) return;
    const float4 x_i = packed_position[i];
    const float4 v_i = packed_velocity[i];
    const CellCoordinates cell = cell_of(c, x_i);
    const uint range_count = candidate_range_count(c, cell);
    ForceSum sum = zero_force();
    for (uint k = 0u; k < range_count; ++k) {
        const Range range = candidate_range(c, cell, k, cell_start);
        for (uint j = range.begin; j < range.end; ++j) {
            const float4 x_j = packed_position[j];
            const float dx = x_i.x - x_j.x, dy = x_i.y - x_j.y, dz = x_i.z - x_j.z;
            if (dx * dx + dy * dy + dz * dz < c.support_radius_squared)
                sum = add_force(sum, c, x_i, v_i, x_j, packed_velocity[j]);
        }
    }
    acceleration[i] = force_to_acceleration(c, sum, density_in[i]);
}

#endif
