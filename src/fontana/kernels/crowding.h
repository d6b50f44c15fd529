// Crowding: where water strikes something a step leaves a few particles denser than its solve, linear in the step, has
// seen. These are moved apart, as position based fluids move all (Macklin and Mueller 2013, section 3): by -G lambda,
// lambda = (error - what may stay) / D, down the gradient of the density of each. Velocities stay as they are, and so
// does the centre of mass, nearly, where no wall has a share.
//
// Only they, their neighbours, and for new sums the neighbours of those are visited. `moved` and `changed` say who: 1,
// else 0. Moves are by hundredths of a spacing, and lists stay as they are: who comes within the support radius so late
// weighs next to nothing.
#ifndef FONTANA_CROWDING_H
#define FONTANA_CROWDING_H

#include "incompressible.h"

#define CROWDING_REST 0.5f         // of the bound: what may stay, since neighbours get a part of what goes
#define CROWDING_RELAXATION 0.65f  // many at once share neighbours; as in the pressure solve safe up to 0.7
#define CROWDING_MOST 0.1f         // of the rest density, at a time

// lambda, in m^2, and into `found` for how many it is not 0. Without pressure (factor_of) a particle has nowhere to go.
KERNEL void find_crowded(THREAD_ARG const StepConstants c, const float bound, GLOBAL const float* RESTRICT density_in,
                         GLOBAL const float4* RESTRICT factor, GLOBAL float* RESTRICT lambda,
                         GLOBAL uint* RESTRICT moved, GLOBAL uint* RESTRICT changed, GLOBAL uint* found) {
    const uint i = THREAD_INDEX;
    if (i >= c.particle_count) return;
    const float error = density_in[i] * c.inverse_rest_density - 1.0f;
    const bool is_crowded = error > bound && factor[i].w > 0.0f;
    const float excess = min_f(CROWDING_MOST, error - CROWDING_REST * bound);
    lambda[i] = is_crowded ? CROWDING_RELAXATION * excess * factor[i].w : 0.0f;
    moved[i] = changed[i] = 0u;
    if (is_crowded) ATOMIC_ADD(found, 1u);
}

FN void mark_with_neighbors(const StepConstants c, uint i, GLOBAL const uint* RESTRICT list_start,
                            GLOBAL const short* RESTRICT list, GLOBAL uint* mark) {
    STORE_SAME(mark + i, 1u);
    for (Walk walk = first_neighbor(c, i, list_start, list); walk.is_there; walk = next_neighbor(c, walk, list))
        STORE_SAME(mark + walk.j, 1u);
}

// Who has a lambda, and their neighbours.
KERNEL void mark_crowded(THREAD_ARG const StepConstants c, GLOBAL const float* RESTRICT lambda,
                         GLOBAL const uint* RESTRICT list_start, GLOBAL const short* RESTRICT list,
                         GLOBAL uint* moved) {
    const uint i = THREAD_INDEX;
    if (i < c.particle_count && lambda[i] > 0.0f) mark_with_neighbors(c, i, list_start, list, moved);
}

// G lambda of those who are to be moved.
KERNEL void crowding_gradient(THREAD_ARG const StepConstants c, GLOBAL const uint* RESTRICT moved,
                              GLOBAL const float* RESTRICT lambda, GLOBAL const uint* RESTRICT list_start,
                              GLOBAL const short* RESTRICT list, GLOBAL const float4* RESTRICT position,
                              GLOBAL const float4* RESTRICT factor, GLOBAL float4* RESTRICT gradient) {
    const uint i = THREAD_INDEX;
    if (i < c.particle_count && moved[i] != 0u)
        gradient[i] = gradient_at(c, i, lambda, list_start, list, position, factor);
}

// x - g, but never out of the cell that x was sorted into: along an axis that leads out of it a particle stays.
FN float4 moved_down(const StepConstants c, float4 x, float4 g) {
    const float4 to = MAKE_FLOAT4(x.x - g.x, x.y - g.y, x.z - g.z, x.w);
    const CellCoordinates home = cell_of(c, x), cell = cell_of(c, to);
    return MAKE_FLOAT4(cell.x == home.x ? to.x : x.x, cell.y == home.y ? to.y : x.y, cell.z == home.z ? to.z : x.z,
                       x.w);
}

// x -= G lambda, with G lambda in `gradient`; marks whose sums that changes.
KERNEL void move_apart(THREAD_ARG const StepConstants c, GLOBAL const uint* RESTRICT moved,
                       GLOBAL const float4* RESTRICT gradient, GLOBAL const uint* RESTRICT list_start,
                       GLOBAL const short* RESTRICT list, GLOBAL float4* RESTRICT position, GLOBAL uint* changed) {
    const uint i = THREAD_INDEX;
    if (i >= c.particle_count || moved[i] == 0u) return;
    position[i] = moved_down(c, position[i], gradient[i]);
    mark_with_neighbors(c, i, list_start, list, changed);
}

// sum_neighborhood for those whom that has changed.
KERNEL void sum_changed(THREAD_ARG const StepConstants c, GLOBAL const uint* RESTRICT changed,
                        GLOBAL const float4* RESTRICT position, GLOBAL const float4* RESTRICT velocity,
                        GLOBAL const uint* RESTRICT list_start, GLOBAL const short* RESTRICT list,
                        GLOBAL const ColliderConstants* RESTRICT collider, GLOBAL float* RESTRICT density_out,
                        GLOBAL float4* RESTRICT factor, GLOBAL float* RESTRICT wall_rate, GLOBAL float* RESTRICT rate,
                        GLOBAL float4* RESTRICT viscous) {
    const uint i = THREAD_INDEX;
    if (i < c.particle_count && changed[i] != 0u)
        sum_neighborhood_of(c, i, position, velocity, list_start, list, collider, density_out, factor, wall_rate, rate,
                            viscous);
}

#endif
