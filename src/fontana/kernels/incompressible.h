// The operators that all production methods are made of, in relative density (density / rest density), with rest
// volumes V = m / rest density and u = p / (rest density * relative density^2), in m^2/s^2:
//   S_i     = sum_j V_j grad W_ij + walls                 (1/m)
//   G u     = u_i S_i + sum_j V_j u_j grad W_ij           the acceleration by pressure, with a minus sign
//   G^T a   = S_i . a_i - sum_j V_j grad W_ij . a_j       the rate at which the relative density grows under a
// so that K = G^T G is symmetric with the diagonal D_i = |S_i|^2 + sum_j V_i V_j |grad W_ij|^2 (Bender and Koschier
// 2017, where 1 / D_i is called alpha).
#ifndef FONTANA_INCOMPRESSIBLE_H
#define FONTANA_INCOMPRESSIBLE_H

#include "neighbor_list.h"
#include "pair.h"
#include "walls.h"

// G^T a from its sum over neighbours; s: S_i.
FN float divergence_of(const StepConstants c, float4 s, float4 a, float sum) {
    return s.x * a.x + s.y * a.y + s.z * a.z - c.gradient_scale * sum;
}

// S_i and 1 / D_i.
FN float4 factor_of(const StepConstants c, float mass, Real3 gradient, float squares, WallTerm walls) {
    const float scale = c.gradient_scale;
    const float x = scale * gradient.x + walls.gradient_x, y = scale * gradient.y + walls.gradient_y,
                z = scale * gradient.z + walls.gradient_z;
    const float diagonal = x * x + y * y + z * z + (mass * scale) * (scale * squares);
    // Next to nobody the system is singular; and a particle pinched between surfaces has nowhere to go, so that no
    // pressure would ever be enough. Either feels none.
    const bool is_free = diagonal * c.support_radius_squared > 4.0e-4f && walls.share < 0.9f;
    return MAKE_FLOAT4(x, y, z, is_free ? 1.0f / diagonal : 0.0f);
}

// Viscosity as Monaghan (2005) writes the Laplacian, 2 (dimension + 2) = 10:
//   a_i = 10 nu sum_j V_j (v_ij . x_ij) / (r^2 + 0.01 H^2) grad W_ij.
FN float4 viscosity_of(const StepConstants c, Real3 shear) {
    const float scale = 10.0f * c.viscosity * c.inverse_rest_density * c.gradient_scale;
    return MAKE_FLOAT4(scale * shear.x, scale * shear.y, scale * shear.z, 0.0f);
}

// All that a substep has to know before pressure acts, in one visit to every neighbour. `position`: x, y, z, m. Out:
// the density; `factor` = S, 1 / D (0 where a particle feels no pressure); `wall_rate`; `rate`, that of the relative
// density under the present velocities (1/s); and the acceleration by viscosity.
FN void sum_neighborhood_of(const StepConstants c, uint i, GLOBAL const float4* RESTRICT position,
                            GLOBAL const float4* RESTRICT velocity, GLOBAL const uint* RESTRICT list_start,
                            GLOBAL const short* RESTRICT list, GLOBAL const ColliderConstants* RESTRICT collider,
                            GLOBAL float* RESTRICT density_out, GLOBAL float4* RESTRICT factor,
                            GLOBAL float* RESTRICT wall_rate, GLOBAL float* RESTRICT rate,
                            GLOBAL float4* RESTRICT viscous) {
    const float4 x_i = position[i], v_i = velocity[i];
    NeighborhoodSums sums = no_neighborhood();
    sums.density = x_i.w * kernel_value(c, 0.0f);
    for (Walk walk = first_neighbor(c, i, list_start, list); walk.is_there; walk = next_neighbor(c, walk, list)) {
        const uint j = walk.j;
        const float4 x_j = position[j];
        sums = add_neighbor(sums, c, x_j.w, pair_of(x_i, x_j), v_i, velocity[j]);
    }
    const WallTerm walls = walls_at(c, collider, x_i);
    const float4 s = factor_of(c, x_i.w, sums.gradient, sums.squares, walls);
    density_out[i] = sums.density + c.rest_density * walls.share;
    factor[i] = s;
    wall_rate[i] = walls.rate;
    rate[i] = divergence_of(c, s, v_i, sums.flow) - walls.rate;
    viscous[i] = viscosity_of(c, sums.shear);
}

KERNEL void sum_neighborhood(THREAD_ARG const StepConstants c, GLOBAL const float4* RESTRICT position,
                             GLOBAL const float4* RESTRICT velocity, GLOBAL const uint* RESTRICT list_start,
                             GLOBAL const short* RESTRICT list, GLOBAL const ColliderConstants* RESTRICT collider,
                             GLOBAL float* RESTRICT density_out, GLOBAL float4* RESTRICT factor,
                             GLOBAL float* RESTRICT wall_rate, GLOBAL float* RESTRICT rate,
                             GLOBAL float4* RESTRICT viscous) {
    const uint i = THREAD_INDEX;
    if (i < c.particle_count)
        sum_neighborhood_of(c, i, position, velocity, list_start, list, collider, density_out, factor, wall_rate, rate,
                            viscous);
}

// G^T applied to `field`, without the walls' own motion.
FN float divergence_at(const StepConstants c, uint i, GLOBAL const uint* RESTRICT list_start,
                       GLOBAL const short* RESTRICT list, GLOBAL const float4* RESTRICT position,
                       GLOBAL const float4* RESTRICT factor, GLOBAL const float4* RESTRICT field) {
    const float4 x_i = position[i];
    float sum = 0.0f;
    for (Walk walk = first_neighbor(c, i, list_start, list); walk.is_there; walk = next_neighbor(c, walk, list)) {
        const uint j = walk.j;
        const float4 x_j = position[j];
        sum += divergence_term(c, x_j.w, quick_pair_of(x_i, x_j), field[j]);
    }
    return divergence_of(c, factor[i], field[i], sum);
}

// G u from its sum over neighbours; s: S_i.
FN float4 gradient_of(const StepConstants c, float u_i, float4 s, Real3 sum) {
    const float scale = c.gradient_scale;
    return MAKE_FLOAT4(u_i * s.x + scale * sum.x, u_i * s.y + scale * sum.y, u_i * s.z + scale * sum.z, 0.0f);
}

FN float4 gradient_at(const StepConstants c, uint i, GLOBAL const float* RESTRICT u,
                      GLOBAL const uint* RESTRICT list_start, GLOBAL const short* RESTRICT list,
                      GLOBAL const float4* RESTRICT position, GLOBAL const float4* RESTRICT factor) {
    const float4 x_i = position[i];
    Real3 sum = zero_vector();
    for (Walk walk = first_neighbor(c, i, list_start, list); walk.is_there; walk = next_neighbor(c, walk, list)) {
        const uint j = walk.j;
        const float4 x_j = position[j];
        sum = add_gradient(sum, c, x_j.w * u[j], quick_pair_of(x_i, x_j));
    }
    return gradient_of(c, u[i], factor[i], sum);
}

// G u, into `gradient`.
KERNEL void pressure_gradient(THREAD_ARG const StepConstants c, GLOBAL const float* RESTRICT u,
                              GLOBAL const uint* RESTRICT list_start, GLOBAL const short* RESTRICT list,
                              GLOBAL const float4* RESTRICT position, GLOBAL const float4* RESTRICT factor,
                              GLOBAL float4* RESTRICT gradient) {
    const uint i = THREAD_INDEX;
    if (i < c.particle_count) gradient[i] = gradient_at(c, i, u, list_start, list, position, factor);
}

// v / dt - G u, m/s^2: over dt, the velocity that pressure leaves.
FN float4 pressed(const StepConstants c, float4 v, float4 g) {
    return MAKE_FLOAT4(c.inverse_dt * v.x - g.x, c.inverse_dt * v.y - g.y, c.inverse_dt * v.z - g.z, 0.0f);
}

KERNEL void pressed_velocity(THREAD_ARG const StepConstants c, GLOBAL const float* RESTRICT u,
                             GLOBAL const uint* RESTRICT list_start, GLOBAL const short* RESTRICT list,
                             GLOBAL const float4* RESTRICT position, GLOBAL const float4* RESTRICT factor,
                             GLOBAL const float4* RESTRICT velocity, GLOBAL float4* RESTRICT out) {
    const uint i = THREAD_INDEX;
    if (i < c.particle_count)
        out[i] = pressed(c, velocity[i], gradient_at(c, i, u, list_start, list, position, factor));
}

// v -= dt G u, with G u in `gradient`.
KERNEL void push_by_pressure(THREAD_ARG const StepConstants c, GLOBAL const float4* RESTRICT gradient,
                             GLOBAL float4* RESTRICT velocity) {
    const uint i = THREAD_INDEX;
    if (i >= c.particle_count) return;
    const float4 g = gradient[i], v = velocity[i];
    velocity[i] = MAKE_FLOAT4(v.x - c.dt * g.x, v.y - c.dt * g.y, v.z - c.dt * g.z, v.w);
}

// v += dt a and the drag factor: the prediction that the pressure corrects.
KERNEL void predict_velocity(THREAD_ARG const StepConstants c, GLOBAL const float4* RESTRICT acceleration,
                             GLOBAL float4* RESTRICT velocity) {
    const uint i = THREAD_INDEX;
    if (i >= c.particle_count) return;
    const float4 a = acceleration[i], v = velocity[i];
    velocity[i] =
        MAKE_FLOAT4(c.drag * (v.x + c.dt * a.x), c.drag * (v.y + c.dt * a.y), c.drag * (v.z + c.dt * a.z), v.w);
}

// Friction of a surface on what slides within half a spacing of it: for every spacing travelled along it the share
// `friction` of the sliding velocity is lost, whatever the length of the step; a drag that grows with the square of the
// velocity, as that of a rough wall does. A hit (collide) takes its own share beside.
FN Motion slide(const StepConstants c, ColliderConstants s, Motion m) {
    if (s.friction == 0.0f) return m;
    const float spacing = 0.5f * c.support_radius;
    const Contact contact = surface_distance(s, m);
    if (contact.depth < -0.5f * spacing || contact.depth > s.thickness) return m;
    if (s.type >= 5u && m.y > s.cutoff) return m;
    const float ux = m.vx - s.velocity_x, uy = m.vy - s.velocity_y, uz = m.vz - s.velocity_z;
    const float normal = ux * contact.nx + uy * contact.ny + uz * contact.nz;
    const float tx = ux - normal * contact.nx, ty = uy - normal * contact.ny, tz = uz - normal * contact.nz;
    const float travelled = c.dt * SQRT(tx * tx + ty * ty + tz * tz) / spacing;
    const float lost = min_f(1.0f, s.friction * travelled);
    m.vx -= lost * tx;
    m.vy -= lost * ty;
    m.vz -= lost * tz;
    return m;
}

// x += dt v, with the surfaces' friction before and, as a net, their collisions after: what keeps the fluid off them is
// the walls' share of the density.
KERNEL void advect(THREAD_ARG const StepConstants c, GLOBAL const ColliderConstants* RESTRICT collider,
                   GLOBAL float4* RESTRICT position, GLOBAL float4* RESTRICT velocity) {
    const uint i = THREAD_INDEX;
    if (i >= c.particle_count) return;
    const float4 x = position[i], v = velocity[i];
    Motion m;
    m.x = x.x;
    m.y = x.y;
    m.z = x.z;
    m.vx = v.x;
    m.vy = v.y;
    m.vz = v.z;
    for (uint k = 0u; k < c.collider_count; ++k) m = slide(c, collider[k], m);
    m.x = x.x + c.dt * m.vx;
    m.y = x.y + c.dt * m.vy;
    m.z = x.z + c.dt * m.vz;
    for (uint k = 0u; k < c.collider_count; ++k) m = collide(collider[k], m);
    position[i] = MAKE_FLOAT4(m.x, m.y, m.z, x.w);
    velocity[i] = MAKE_FLOAT4(m.vx, m.vy, m.vz, v.w);
}

// The warm start travels as the fourth component of the velocity, so that it follows its particle through every sort,
// checkpoint and change of backend.
KERNEL void load_warm_start(THREAD_ARG const uint count, GLOBAL const float4* RESTRICT velocity,
                            GLOBAL const float4* RESTRICT factor, GLOBAL float* RESTRICT u) {
    const uint i = THREAD_INDEX;
    if (i < count) u[i] = factor[i].w > 0.0f ? velocity[i].w : 0.0f;
}

// And the pressure that goes with it, Pa: p = rest density * u * relative density^2.
KERNEL void store_pressure(THREAD_ARG const StepConstants c, GLOBAL const float* RESTRICT u,
                           GLOBAL const float* RESTRICT density_in, GLOBAL float4* RESTRICT velocity,
                           GLOBAL float* RESTRICT pressure) {
    const uint i = THREAD_INDEX;
    if (i >= c.particle_count) return;
    const float4 v = velocity[i];
    const float relative = density_in[i] * c.inverse_rest_density;
    velocity[i] = MAKE_FLOAT4(v.x, v.y, v.z, u[i]);
    pressure[i] = c.rest_density * u[i] * relative * relative;
}

#endif
