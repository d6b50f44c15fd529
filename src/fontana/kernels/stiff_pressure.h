// Pressure without a matrix: the equation of state of WCSPH, and the prediction and correction of PCISPH.
#ifndef FONTANA_STIFF_PRESSURE_H
#define FONTANA_STIFF_PRESSURE_H

#include "incompressible.h"

// Tait's equation, p = rest density c^2 / 7 ((density / rest density)^7 - 1) (Becker and Teschner 2007), as u. The
// pressure constant is c^2.
KERNEL void tait_pressure(THREAD_ARG const StepConstants c, GLOBAL const float* RESTRICT density_in,
                          GLOBAL float* RESTRICT u) {
    const uint i = THREAD_INDEX;
    if (i >= c.particle_count) return;
    const float s = density_in[i] * c.inverse_rest_density, s2 = s * s;
    const float value = c.pressure_constant / 7.0f * (s2 * s2 * s2 * s - 1.0f) / s2;
    u[i] = max_f(c.minimum_pressure, value);
}

// Where the particle would be at the end of the substep under `velocity` and the pressure so far; w: m.
KERNEL void predict_position(THREAD_ARG const StepConstants c, GLOBAL const float4* RESTRICT position,
                             GLOBAL const float4* RESTRICT velocity, GLOBAL const float4* RESTRICT gradient,
                             GLOBAL float4* RESTRICT predicted) {
    const uint i = THREAD_INDEX;
    if (i >= c.particle_count) return;
    const float4 x = position[i], v = velocity[i], g = gradient[i];
    predicted[i] = MAKE_FLOAT4(x.x + c.dt * (v.x - c.dt * g.x), x.y + c.dt * (v.y - c.dt * g.y),
                               x.z + c.dt * (v.z - c.dt * g.z), x.w);
}

// delta is that of a full neighbourhood at rest; where particles are crowded it would overshoot, and half of 1 / D,
// what relaxed Jacobi would take, holds it.
FN void store_correction(const StepConstants c, uint i, float delta, float density, float wall_share,
                         GLOBAL const float4* RESTRICT factor, GLOBAL float* RESTRICT u,
                         GLOBAL float* RESTRICT residual) {
    const float relative = density * c.inverse_rest_density + wall_share;
    const float gain = min_f(delta, 0.5f * factor[i].w) * c.inverse_dt * c.inverse_dt;
    u[i] = max_f(0.0f, u[i] + gain * (relative - 1.0f));
    residual[i] = max_f(0.0f, relative - 1.0f);
}

// The relative density there and the correction u += delta / dt^2 (relative - 1), delta (m^2) for a full neighbourhood
// (Solenthaler and Pajarola 2009, eq. 8). The walls move too: their share at the predicted place is that of the present
// surfaces. Neighbours are those that are near at `position`, wherever they are predicted to be: the only ones on a
// list of one's own, but not on a shared one. `residual` gets what is above rest density.
KERNEL void correct_pressure(THREAD_ARG const StepConstants c, const float delta,
                             GLOBAL const float4* RESTRICT position, GLOBAL const float4* RESTRICT predicted,
                             GLOBAL const uint* RESTRICT list_start, GLOBAL const short* RESTRICT list,
                             GLOBAL const ColliderConstants* RESTRICT collider, GLOBAL const float4* RESTRICT factor,
                             GLOBAL float* RESTRICT u, GLOBAL float* RESTRICT residual) {
    const uint i = THREAD_INDEX;
    if (i >= c.particle_count) return;
    (void)position;
    const float4 x_i = predicted[i];
    float density = x_i.w * kernel_value(c, 0.0f);
    for (Walk walk = first_neighbor(c, i, list_start, list); walk.is_there; walk = next_neighbor(c, walk, list)) {
        const float4 x_j = predicted[walk.j];
        density += x_j.w * kernel_value(c, pair_of(x_i, x_j).r);
    }
    store_correction(c, i, delta, density, walls_at(c, collider, x_i).share, factor, u, residual);
}

#endif
