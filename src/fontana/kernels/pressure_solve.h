// The pressure solve of DFSPH as a complementarity problem: find u >= 0 such that r = target - K u is <= 0 where u = 0
// and 0 where u > 0 (K = G^T G, incompressible.h). Projected Anderson acceleration of depth 2 over relaxed Jacobi, and
// a residual that counts both sides: too much pressure as well as too little, which is what makes the full warm start
// safe. With no history it is plain relaxed Jacobi, the reference.
#ifndef FONTANA_PRESSURE_SOLVE_H
#define FONTANA_PRESSURE_SOLVE_H

#include "incompressible.h"

// What the device keeps between iterations (floats): the host reads it every few.
#define SOLVE_RESIDUAL 0u  // mean of the two-sided residual, 1/s^2
#define SOLVE_PREVIOUS 1u  // the one before
#define SOLVE_HISTORY 2u   // differences in use, 0 to 2
#define SOLVE_GAMMA_0 3u   // coefficient of the older or only difference
#define SOLVE_GAMMA_1 4u
#define SOLVE_DONE 5u  // 0 running, 1 converged: one plain step to go, 2 at rest
#define SOLVE_ITERATIONS 6u
#define SOLVE_LARGEST 7u  // largest residual, 1/s^2
#define SOLVE_STATE_SIZE 8u
#define SOLVE_SUMS 8u  // sums of one lane: residual, largest, M00, M01, M11, y0, y1, unused

// In place, from the rate of the relative density to the target of the solve, (relative - 1 + dt rate) / dt^2.
KERNEL void density_target(THREAD_ARG const StepConstants c, GLOBAL const float* RESTRICT density_in,
                           GLOBAL float* RESTRICT target) {
    const uint i = THREAD_INDEX;
    if (i >= c.particle_count) return;
    const float excess = density_in[i] * c.inverse_rest_density - 1.0f;
    target[i] = (excess * c.inverse_dt + target[i]) * c.inverse_dt;
}

// One relaxed step from zero against growing density: at the tolerances in use, all that the divergence solve needs.
// Particles with less than 0.63 of a full neighbourhood (20 of 32 neighbours) are left alone: a splash may converge.
KERNEL void divergence_step(THREAD_ARG const StepConstants c, const float relaxation,
                            GLOBAL const float* RESTRICT density_in, GLOBAL const float* RESTRICT rate,
                            GLOBAL const float4* RESTRICT factor, GLOBAL float* RESTRICT u) {
    const uint i = THREAD_INDEX;
    if (i >= c.particle_count) return;
    const float relative = density_in[i] * c.inverse_rest_density;
    u[i] = relative > 0.63f ? relaxation * max_f(rate[i], 0.0f) * c.inverse_dt * factor[i].w : 0.0f;
}

FN void store_jacobi_step(uint i, float relaxation, float k_u, GLOBAL const float4* RESTRICT factor,
                          GLOBAL const float* RESTRICT target, GLOBAL const float* RESTRICT u,
                          GLOBAL float* RESTRICT residual, GLOBAL float* RESTRICT step) {
    const float u_i = u[i], inverse_diagonal = factor[i].w, r = target[i] - k_u;
    const bool is_free = inverse_diagonal == 0.0f;
    residual[i] = is_free ? 0.0f : r > 0.0f ? r : u_i > 0.0f ? -r : 0.0f;
    step[i] = is_free ? -u_i : max_f(0.0f, u_i + relaxation * inverse_diagonal * r) - u_i;
}

// K u from G u, the residual, and the relaxed Jacobi step f = max(0, u + omega r / D) - u.
KERNEL void jacobi_step(THREAD_ARG const StepConstants c, const float relaxation,
                        GLOBAL const float4* RESTRICT gradient, GLOBAL const uint* RESTRICT neighbor_count,
                        GLOBAL const uint* RESTRICT list, GLOBAL const float4* RESTRICT volume_position,
                        GLOBAL const float4* RESTRICT factor, GLOBAL const float* RESTRICT target,
                        GLOBAL const float* RESTRICT u, GLOBAL float* RESTRICT residual, GLOBAL float* RESTRICT step) {
    const uint i = THREAD_INDEX;
    if (i >= c.particle_count) return;
    const float k_u = divergence_at(c, i, neighbor_count, list, volume_position, factor, gradient);
    store_jacobi_step(i, relaxation, k_u, factor, target, u, residual, step);
}

// Per lane: puts this iteration's differences (if it is not the first) into slot `slot` of the history, and adds up the
// residual and the inner products of the differences, weighted by D and V.
KERNEL void anderson_sums(THREAD_ARG const StepConstants c, const uint lane_count, const uint is_first,
                          GLOBAL const float4* RESTRICT volume_position, GLOBAL const float4* RESTRICT factor,
                          GLOBAL const float* RESTRICT residual, GLOBAL const float* RESTRICT u,
                          GLOBAL const float* RESTRICT step, GLOBAL const float* RESTRICT u_before,
                          GLOBAL const float* RESTRICT step_before, GLOBAL const float* RESTRICT df_older,
                          GLOBAL float* RESTRICT du_newer, GLOBAL float* RESTRICT df_newer,
                          GLOBAL float* RESTRICT sums) {
    const uint lane = THREAD_INDEX;
    if (lane >= lane_count) return;
    float total = 0.0f, largest = 0.0f, m00 = 0.0f, m01 = 0.0f, m11 = 0.0f, y0 = 0.0f, y1 = 0.0f;
    for (uint i = lane; i < c.particle_count; i += lane_count) {
        const float inverse = factor[i].w, weight = inverse > 0.0f ? volume_position[i].w / inverse : 0.0f;
        total += residual[i];
        if (!(residual[i] <= largest)) largest = residual[i];
        if (is_first) continue;
        const float f = step[i], f0 = df_older[i], f1 = f - step_before[i];
        df_newer[i] = f1;
        du_newer[i] = u[i] - u_before[i];
        m00 += weight * f0 * f0;
        m01 += weight * f0 * f1;
        m11 += weight * f1 * f1;
        y0 += weight * f0 * f;
        y1 += weight * f1 * f;
    }
    GLOBAL float* RESTRICT out = sums + lane * SOLVE_SUMS;
    out[0] = total;
    out[1] = largest;
    out[2] = m00;
    out[3] = m01;
    out[4] = m11;
    out[5] = y0;
    out[6] = y1;
    out[7] = 0.0f;
}

// Adds lanes t, t + thread_count, ... of the sums into lane t of `folded`.
KERNEL void fold_sums(THREAD_ARG const uint lane_count, const uint thread_count, GLOBAL const float* RESTRICT sums,
                      GLOBAL float* RESTRICT folded) {
    const uint thread = THREAD_INDEX;
    if (thread >= thread_count) return;
    for (uint k = 0u; k < SOLVE_SUMS; ++k) {
        float total = 0.0f;
        for (uint lane = thread; lane < lane_count; lane += thread_count) {
            const float value = sums[lane * SOLVE_SUMS + k];
            total = k == 1u ? (value <= total ? total : value) : total + value;
        }
        folded[thread * SOLVE_SUMS + k] = total;
    }
}

// One thread: the last fold, the two coefficients (a 2 by 2 system), and whether the solve has converged.
KERNEL void anderson_coefficients(THREAD_ARG const StepConstants c, const uint lane_count, const uint is_first,
                                  const uint is_accelerated, const uint minimum_iterations, const float tolerance,
                                  GLOBAL const float* RESTRICT sums, GLOBAL float* RESTRICT state) {
    if (THREAD_INDEX != 0u) return;
    if (is_first) state[SOLVE_HISTORY] = state[SOLVE_DONE] = state[SOLVE_ITERATIONS] = 0.0f;
    if (state[SOLVE_DONE] > 0.0f) {
        state[SOLVE_DONE] = 2.0f;
        return;
    }
    float s[SOLVE_SUMS];
    for (uint k = 0u; k < SOLVE_SUMS; ++k) s[k] = 0.0f;
    for (uint lane = 0u; lane < lane_count; ++lane)
        for (uint k = 0u; k < SOLVE_SUMS; ++k) {
            const float value = sums[lane * SOLVE_SUMS + k];
            s[k] = k == 1u ? (value <= s[k] ? s[k] : value) : s[k] + value;
        }
    const float mean = s[0] / (float)c.particle_count;
    // Safeguard: where acceleration has made it worse, the older difference is forgotten.
    if (!is_first && mean > 2.0f * state[SOLVE_RESIDUAL]) state[SOLVE_HISTORY] = 0.0f;
    if (!is_first && is_accelerated) state[SOLVE_HISTORY] = min_f(2.0f, state[SOLVE_HISTORY] + 1.0f);
    state[SOLVE_PREVIOUS] = state[SOLVE_RESIDUAL];
    state[SOLVE_RESIDUAL] = mean;
    state[SOLVE_LARGEST] = s[1];
    state[SOLVE_ITERATIONS] += 1.0f;
    if (state[SOLVE_ITERATIONS] >= (float)minimum_iterations && mean <= tolerance) state[SOLVE_DONE] = 1.0f;

    // [m00 m01; m01 m11] gamma = y with a touch of damping; a pivot that is not positive drops its difference.
    const float damping = 1.0f + 1.0e-6f;
    float gamma_0 = 0.0f, gamma_1 = 0.0f;
    const float m00 = s[2] * damping, m11 = s[4] * damping;
    if (state[SOLVE_HISTORY] >= 2.0f && m00 > 0.0f && m11 * m00 - s[3] * s[3] > 0.0f) {
        const float determinant = m00 * m11 - s[3] * s[3];
        gamma_0 = (s[5] * m11 - s[6] * s[3]) / determinant;
        gamma_1 = (s[6] * m00 - s[5] * s[3]) / determinant;
    } else if (state[SOLVE_HISTORY] >= 1.0f && m11 > 0.0f) {
        gamma_1 = s[6] / m11;
    }
    state[SOLVE_GAMMA_0] = gamma_0;
    state[SOLVE_GAMMA_1] = gamma_1;
}

// u = max(0, u + f - sum gamma (dU + dF)); the last step of a converged solve is the plain one.
KERNEL void anderson_update(THREAD_ARG const uint count, GLOBAL const float* RESTRICT state,
                            GLOBAL const float* RESTRICT step, GLOBAL const float* RESTRICT du_older,
                            GLOBAL const float* RESTRICT df_older, GLOBAL const float* RESTRICT du_newer,
                            GLOBAL const float* RESTRICT df_newer, GLOBAL float* RESTRICT u,
                            GLOBAL float* RESTRICT u_before, GLOBAL float* RESTRICT step_before) {
    const uint i = THREAD_INDEX;
    if (i >= count || state[SOLVE_DONE] >= 2.0f) return;
    const float u_i = u[i], f = step[i];
    u_before[i] = u_i;
    step_before[i] = f;
    float next = u_i + f;
    if (state[SOLVE_DONE] == 0.0f) {
        if (state[SOLVE_GAMMA_0] != 0.0f) next -= state[SOLVE_GAMMA_0] * (du_older[i] + df_older[i]);
        if (state[SOLVE_GAMMA_1] != 0.0f) next -= state[SOLVE_GAMMA_1] * (du_newer[i] + df_newer[i]);
    }
    u[i] = max_f(0.0f, next);
}

#endif
