// Pressure and viscosity, the two forces between particles of eq. 2.6. Action equals reaction in each: with V =
// m/density the force on i from j is V_i V_j (...), which changes sign with i and j.
#ifndef FONTANA_FLUID_FORCE_H
#define FONTANA_FLUID_FORCE_H

#include "cells.h"
#include "smoothing.h"

// acceleration_i = (f_pressure + f_viscosity) / density_i, eq. 2.7, with
//   f_pressure  = - sum_j V_j (p_i + p_j)/2 grad W_spiky,    eq. 2.10
//   f_viscosity = mu sum_j V_j (v_j - v_i) lap W_viscosity,  eq. 2.13
KERNEL void fluid_force(THREAD_ARG const StepConstants c, GLOBAL const float4* RESTRICT packed_position,
                        GLOBAL const float4* RESTRICT packed_velocity, GLOBAL const float* RESTRICT density_in,
                        GLOBAL const uint* RESTRICT cell_start, GLOBAL float4* RESTRICT acceleration) {
    const uint i = THREAD_INDEX;
    if (i >= c.particle_count) return;
    const float4 x_i = packed_position[i];
    const float4 v_i = packed_velocity[i];
    const CellCoordinates cell = cell_of(c, x_i);
    const uint range_count = candidate_range_count(c, cell);
    float pressure_x = 0.0f, pressure_y = 0.0f, pressure_z = 0.0f;
    float viscous_x = 0.0f, viscous_y = 0.0f, viscous_z = 0.0f;
    for (uint k = 0u; k < range_count; ++k) {
        const Range range = candidate_range(c, cell, k, cell_start);
        for (uint j = range.begin; j < range.end; ++j) {
            const float4 x_j = packed_position[j];
            const float dx = x_i.x - x_j.x, dy = x_i.y - x_j.y, dz = x_i.z - x_j.z;
            const float r_squared = dx * dx + dy * dy + dz * dz;
            if (r_squared < c.support_radius_squared) {
                const float4 v_j = packed_velocity[j];
                // The floor makes x_ij / r zero, not NaN, for the particle itself and for coincident ones.
                const float r = SQRT(max_f(r_squared, 1.0e-24f));
                const float p = x_j.w * (v_i.w + v_j.w) * spiky_gradient(r, c.support_radius) / r;
                pressure_x += p * dx;
                pressure_y += p * dy;
                pressure_z += p * dz;
                const float m = x_j.w * viscosity_laplacian(r, c.support_radius);
                viscous_x += m * (v_j.x - v_i.x);
                viscous_y += m * (v_j.y - v_i.y);
                viscous_z += m * (v_j.z - v_i.z);
            }
        }
    }
    const float a = 0.5f * c.spiky_gradient_scale / density_in[i];
    const float b = c.viscosity * c.viscosity_laplacian_scale / density_in[i];
    acceleration[i] = MAKE_FLOAT4(a * pressure_x + b * viscous_x, a * pressure_y + b * viscous_y,
                                  a * pressure_z + b * viscous_z, 0.0f);
}

#endif
