// Sums and maxima over all particles, in a fixed shape: lane k takes particles k, k + lanes, k + 2 lanes, ... in turn,
// and the host adds the lanes up in order. So the result is the same on every device, whatever runs in parallel.
#ifndef FONTANA_REDUCE_H
#define FONTANA_REDUCE_H

#include "step_constants.h"

// A NaN wins over every number, whichever of the two it is, so that it is not lost.
FN float max_or_nan(float a, float b) { return a < b || b != b ? b : a; }

// What a particle's speed counts for in the length of a step. One that is alone, with neither a neighbour nor a wall
// within the support radius of two spacings, may travel a whole spacing and meets nobody closer than that, where others
// may travel 0.4 of one. Otherwise a single droplet would slow down all of a splash. (With mueller walls have no
// density and only collide: there a droplet near a wall is alone too.)
FN float travel_weight(const StepConstants c, float mass, float density) {
    return density <= 1.01f * mass * c.own_value ? 0.4f : 1.0f;
}

// One particle more for max |weight v|^2, max |a|^2, sum and max of the density error.
FN float4 add_to_step(const StepConstants c, float4 e, float mass, float4 v, float4 a, float density) {
    const float weight = travel_weight(c, mass, density);
    const float v_squared = weight * weight * (v.x * v.x + v.y * v.y + v.z * v.z);
    const float a_squared = a.x * a.x + a.y * a.y + a.z * a.z;
    const float error = max_f(0.0f, density * c.inverse_rest_density - 1.0f);
    return MAKE_FLOAT4(max_or_nan(e.x, v_squared), max_or_nan(e.y, a_squared), e.z + error, max_or_nan(e.w, error));
}

// Per lane: those four.
KERNEL void reduce_step(THREAD_ARG const StepConstants c, const uint lane_count, GLOBAL const float4* RESTRICT position,
                        GLOBAL const float4* RESTRICT velocity, GLOBAL const float4* RESTRICT acceleration,
                        GLOBAL const float* RESTRICT density_in, GLOBAL float4* RESTRICT extremes) {
    const uint lane = THREAD_INDEX;
    if (lane >= lane_count) return;
    float4 e = MAKE_FLOAT4(0.0f, 0.0f, 0.0f, 0.0f);
    for (uint i = lane; i < c.particle_count; i += lane_count)
        e = add_to_step(c, e, position[i].w, velocity[i], acceleration[i], density_in[i]);
    extremes[lane] = e;
}

// Per lane: the smallest and largest position.
KERNEL void reduce_bounds(THREAD_ARG const StepConstants c, const uint lane_count,
                          GLOBAL const float4* RESTRICT position, GLOBAL float4* RESTRICT low,
                          GLOBAL float4* RESTRICT high) {
    const uint lane = THREAD_INDEX;
    if (lane >= lane_count) return;
    float4 a = MAKE_FLOAT4(1.0e30f, 1.0e30f, 1.0e30f, 0.0f), b = MAKE_FLOAT4(-1.0e30f, -1.0e30f, -1.0e30f, 0.0f);
    for (uint i = lane; i < c.particle_count; i += lane_count) {
        const float4 x = position[i];
        a = MAKE_FLOAT4(min_f(a.x, x.x), min_f(a.y, x.y), min_f(a.z, x.z), 0.0f);
        b = MAKE_FLOAT4(max_f(b.x, x.x), max_f(b.y, x.y), max_f(b.z, x.z), 0.0f);
    }
    low[lane] = a;
    high[lane] = b;
}

// Per lane: (sum of m x, m y, m z, m), and (kinetic energy, sum and max of the density error, max |v|^2).
KERNEL void reduce_diagnostics(THREAD_ARG const StepConstants c, const uint lane_count,
                               GLOBAL const float4* RESTRICT position, GLOBAL const float4* RESTRICT velocity,
                               GLOBAL const float* RESTRICT density_in, GLOBAL float4* RESTRICT moment,
                               GLOBAL float4* RESTRICT measure) {
    const uint lane = THREAD_INDEX;
    if (lane >= lane_count) return;
    float4 m = MAKE_FLOAT4(0.0f, 0.0f, 0.0f, 0.0f), d = m;
    for (uint i = lane; i < c.particle_count; i += lane_count) {
        const float4 x = position[i], v = velocity[i];
        const float v_squared = v.x * v.x + v.y * v.y + v.z * v.z;
        const float error = max_f(0.0f, density_in[i] / c.rest_density - 1.0f);
        m = MAKE_FLOAT4(m.x + x.w * x.x, m.y + x.w * x.y, m.z + x.w * x.z, m.w + x.w);
        d = MAKE_FLOAT4(d.x + 0.5f * x.w * v_squared, d.y + error, max_or_nan(d.z, error), max_or_nan(d.w, v_squared));
    }
    moment[lane] = m;
    measure[lane] = d;
}

// Per lane: the sum.
KERNEL void reduce_sum(THREAD_ARG const uint count, const uint lane_count, GLOBAL const float* RESTRICT value,
                       GLOBAL float* RESTRICT out) {
    const uint lane = THREAD_INDEX;
    if (lane >= lane_count) return;
    float total = 0.0f;
    for (uint i = lane; i < count; i += lane_count) total += value[i];
    out[lane] = total;
}

#endif
