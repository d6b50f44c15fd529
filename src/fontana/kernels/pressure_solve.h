// The pressure solve of DFSPH as a complementarity problem: find u >= 0 such that r = target - K u is <= 0 where u = 0
// and 0 where u > 0 (K = G^T G, incompressible.h; target: the relative density above rest that the step would end with
// without pressure, over dt^2). Projected Anderson acceleration of depth 2 over relaxed Jacobi, and
// a residual that counts both sides: too much pressure as well as too little, which is what makes the full warm start
// safe. With no history it is plain relaxed Jacobi, the reference.
#ifndef FONTANA_PRESSURE_SOLVE_H
#define FONTANA_PRESSURE_SOLVE_H

#include "anderson.h"
#include "coarse.h"
#include "incompressible.h"

// What the device keeps between iterations (floats): the host reads it every few.
#define SOLVE_RESIDUAL 0u  // mean of the two-sided residual, 1/s^2
#define SOLVE_HISTORY 1u   // differences in use, 0 to 2
#define SOLVE_GAMMA_0 2u   // coefficient of the older or only difference
#define SOLVE_GAMMA_1 3u
#define SOLVE_DONE 4u  // 0 running, 1 converged: one plain step to go, 2 at rest
#define SOLVE_ITERATIONS 5u
#define SOLVE_STATE_SIZE 6u

// The relative density above rest that the step would end with if only the walls moved, over dt^2.
KERNEL void density_excess(THREAD_ARG const StepConstants c, GLOBAL const float* RESTRICT density_in,
                           GLOBAL const float* RESTRICT wall_rate, GLOBAL float* RESTRICT excess) {
    const uint i = THREAD_INDEX;
    if (i >= c.particle_count) return;
    const float now = density_in[i] * c.inverse_rest_density - 1.0f;
    excess[i] = (now * c.inverse_dt - wall_rate[i]) * c.inverse_dt;
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

// r = target - K u, 1/s^2, as the excess that pressed_velocity leads to; 0 where no pressure acts.
KERNEL void pressure_residual(THREAD_ARG const StepConstants c, GLOBAL const float4* RESTRICT pressed_velocity,
                              GLOBAL const uint* RESTRICT list_start, GLOBAL const short* RESTRICT list,
                              GLOBAL const float4* RESTRICT position, GLOBAL const float4* RESTRICT factor,
                              GLOBAL const float* RESTRICT excess, GLOBAL float* RESTRICT residual) {
    const uint i = THREAD_INDEX;
    if (i >= c.particle_count) return;
    const float rate = divergence_at(c, i, list_start, list, position, factor, pressed_velocity);
    residual[i] = factor[i].w > 0.0f ? excess[i] + rate : 0.0f;
}

KERNEL void relax(THREAD_ARG const StepConstants c, const float relaxation, const uint with_coarse,
                  const CoarseLevel level, GLOBAL const float4* RESTRICT position,
                  GLOBAL const uint* RESTRICT cell_start, GLOBAL const float4* RESTRICT factor,
                  GLOBAL const float* RESTRICT weight, GLOBAL const float* RESTRICT residual,
                  GLOBAL const float* RESTRICT z, GLOBAL const float* RESTRICT u, GLOBAL float* RESTRICT step) {
    const uint i = THREAD_INDEX;
    if (i >= c.particle_count) return;
    float z_i = 0.0f;
    if (with_coarse && is_pressed(weight[i], residual[i], u[i]))
        z_i = coarse_correction(c, level, position[i], cell_start, z);
    step[i] = relaxed_step(relaxation, factor[i].w, residual[i], z_i, u[i]);
}

// Per lane: the residual and the inner products of the last two differences of steps, weighted by D; `step` is this
// iteration's, step_1 and step_2 those of the one and two before.
KERNEL void anderson_sums(THREAD_ARG const uint count, const uint lane_count, GLOBAL const float4* RESTRICT factor,
                          GLOBAL const float* RESTRICT residual, GLOBAL const float* RESTRICT u,
                          GLOBAL const float* RESTRICT step, GLOBAL const float* RESTRICT step_1,
                          GLOBAL const float* RESTRICT step_2, GLOBAL float* RESTRICT sums) {
    const uint lane = THREAD_INDEX;
    if (lane >= lane_count) return;
    SolveSums s = zero_sums();
    for (uint i = lane; i < count; i += lane_count)
        s = add_to_sums(s, factor[i].w, residual[i], u[i], step[i], step_1[i], step_2[i]);
    sums[lane] = s.residual;
    sums[lane_count + lane] = s.m00;
    sums[2u * lane_count + lane] = s.m01;
    sums[3u * lane_count + lane] = s.m11;
    sums[4u * lane_count + lane] = s.y0;
    sums[5u * lane_count + lane] = s.y1;
}

// Adds lanes t, t + thread_count, ... of each of the sums into lane t of `folded`.
KERNEL void fold_sums(THREAD_ARG const uint lane_count, const uint thread_count, GLOBAL const float* RESTRICT sums,
                      GLOBAL float* RESTRICT folded) {
    const uint thread = THREAD_INDEX;
    if (thread >= thread_count) return;
    for (uint k = 0u; k < SOLVE_SUMS; ++k) {
        float total = 0.0f;
        for (uint lane = thread; lane < lane_count; lane += thread_count) total += sums[k * lane_count + lane];
        folded[k * thread_count + thread] = total;
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
    for (uint k = 0u; k < SOLVE_SUMS; ++k) {
        s[k] = 0.0f;
        for (uint lane = 0u; lane < lane_count; ++lane) s[k] += sums[k * lane_count + lane];
    }
    const float mean = s[0] / (float)c.particle_count;
    // Safeguard: where acceleration has made it worse, the older difference is forgotten.
    if (!is_first && mean > 2.0f * state[SOLVE_RESIDUAL]) state[SOLVE_HISTORY] = 0.0f;
    if (!is_first && is_accelerated) state[SOLVE_HISTORY] = min_f(2.0f, state[SOLVE_HISTORY] + 1.0f);
    state[SOLVE_RESIDUAL] = mean;
    state[SOLVE_ITERATIONS] += 1.0f;
    if (state[SOLVE_ITERATIONS] >= (float)minimum_iterations && mean <= tolerance) state[SOLVE_DONE] = 1.0f;

    // [m00 m01; m01 m11] gamma = y with a touch of damping; a pivot that is not positive drops its difference.
    const float damping = 1.0f + 1.0e-6f;
    float gamma_0 = 0.0f, gamma_1 = 0.0f;
    const float m00 = s[1] * damping, m01 = s[2], m11 = s[3] * damping, y0 = s[4], y1 = s[5];
    if (state[SOLVE_HISTORY] >= 2.0f && m00 > 0.0f && m11 * m00 - m01 * m01 > 0.0f) {
        const float determinant = m00 * m11 - m01 * m01;
        gamma_0 = (y0 * m11 - y1 * m01) / determinant;
        gamma_1 = (y1 * m00 - y0 * m01) / determinant;
    } else if (state[SOLVE_HISTORY] >= 1.0f && m11 > 0.0f) {
        gamma_1 = y1 / m11;
    }
    state[SOLVE_GAMMA_0] = gamma_0;
    state[SOLVE_GAMMA_1] = gamma_1;
}

// u_next = max(0, u + f - sum gamma (dU + dF)); the last step of a converged solve is the plain one, and none follows.
// u_next may be u_2, the oldest.
KERNEL void anderson_update(THREAD_ARG const uint count, GLOBAL const float* RESTRICT state,
                            GLOBAL const float* RESTRICT u, GLOBAL const float* RESTRICT u_1, GLOBAL const float* u_2,
                            GLOBAL const float* RESTRICT step, GLOBAL const float* RESTRICT step_1,
                            GLOBAL const float* RESTRICT step_2, GLOBAL float* u_next) {
    const uint i = THREAD_INDEX;
    if (i >= count) return;
    const float done = state[SOLVE_DONE], gamma_0 = state[SOLVE_GAMMA_0], gamma_1 = state[SOLVE_GAMMA_1];
    float next = u[i];
    if (done < 2.0f) next += step[i];
    if (done == 0.0f) {
        if (gamma_0 != 0.0f) next -= gamma_0 * ((u_1[i] - u_2[i]) + (step_1[i] - step_2[i]));
        if (gamma_1 != 0.0f) next -= gamma_1 * ((u[i] - u_1[i]) + (step[i] - step_1[i]));
    }
    u_next[i] = max_f(0.0f, next);
}

#endif
