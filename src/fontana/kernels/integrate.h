// External forces, time integration and collisions of one particle.
#ifndef FONTANA_INTEGRATE_H
#define FONTANA_INTEGRATE_H

#include "collide.h"
#include "push.h"

// What acts on a particle beside its neighbours: gravity (eq. 2.17), the wind, the user's push, and a force per
// particle given by the user, indexed by id. Adds to the acceleration.
KERNEL void external_force(THREAD_ARG const StepConstants c, GLOBAL const float4* RESTRICT position,
                           GLOBAL const float4* RESTRICT velocity, GLOBAL const uint* RESTRICT id,
                           GLOBAL const float4* RESTRICT force_by_id, GLOBAL float4* RESTRICT acceleration) {
    const uint i = THREAD_INDEX;
    if (i >= c.particle_count) return;
    const float4 v = velocity[i];
    float4 a = acceleration[i];
    a.x += c.gravity_x + c.wind_coupling * (c.wind_x - v.x);
    a.y += c.gravity_y + c.wind_coupling * (c.wind_y - v.y);
    a.z += c.gravity_z + c.wind_coupling * (c.wind_z - v.z);
    if (c.inverse_push_radius_squared > 0.0f) {
        const float share = push_share(c, position[i]);
        a.x += share * c.push_x;
        a.y += share * c.push_y;
        a.z += share * c.push_z;
    }
    if (c.has_force) {
        const float4 f = force_by_id[id[i]];
        const float inverse_mass = 1.0f / position[i].w;
        a.x += f.x * inverse_mass;
        a.y += f.y * inverse_mass;
        a.z += f.z * inverse_mass;
    }
    acceleration[i] = a;
}

// Symplectic Euler (velocity first), the thesis's drag factor, then the surfaces in turn.
KERNEL void integrate(THREAD_ARG const StepConstants c, GLOBAL const ColliderConstants* RESTRICT collider,
                      GLOBAL const float4* RESTRICT acceleration, GLOBAL float4* RESTRICT position,
                      GLOBAL float4* RESTRICT velocity) {
    const uint i = THREAD_INDEX;
    if (i >= c.particle_count) return;
    const float4 a = acceleration[i], x = position[i], v = velocity[i];
    Motion m;
    m.vx = c.drag * (v.x + c.dt * a.x);
    m.vy = c.drag * (v.y + c.dt * a.y);
    m.vz = c.drag * (v.z + c.dt * a.z);
    m.x = x.x + c.dt * m.vx;
    m.y = x.y + c.dt * m.vy;
    m.z = x.z + c.dt * m.vz;
    for (uint k = 0u; k < c.collider_count; ++k) m = collide(collider[k], m);
    position[i] = MAKE_FLOAT4(m.x, m.y, m.z, x.w);
    velocity[i] = MAKE_FLOAT4(m.vx, m.vy, m.vz, v.w);
}

#endif
