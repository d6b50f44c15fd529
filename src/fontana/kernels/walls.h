// Walls that count as fluid at rest density: layers of it a spacing apart, the first half a spacing behind the surface,
// as a lattice would go on. A layer's share of a particle's density is that of a plane (plane_share), in closed form:
// no boundary particles, no bumps, no neighbours. Spheres and cylinders are taken as their tangent plane, which is
// exact as the radius grows over the support radius.
//
// Nearer than half a spacing the distance shrinks faster than it is, so that a particle that reaches the surface meets
// the first layer face to face. Otherwise it could sit there, held by the collision alone, of which the pressure solve
// knows nothing. It does so without a kink: the solve is linear in a step, and particles that rest where the slope
// jumps would be thrown to and fro.
#ifndef FONTANA_WALLS_H
#define FONTANA_WALLS_H

#include "collide.h"
#include "spline.h"

// What walls add to one particle: `share` to its relative density, `gradient` (1/m) to sum_j V_j grad W, and `rate`
// (1/s), that gradient times the walls' velocities.
typedef struct WallTerm {
    float share;
    float gradient_x, gradient_y, gradient_z;
    float rate;
} WallTerm;

// How much nearer than half a spacing, in support radii: 0 to 1/4.
FN float nearness(const StepConstants c, float distance) {
    return max_f(0.0f, 0.25f - distance * c.inverse_support_radius);
}

// How far from the surface the layers think a particle at `distance` (m, outside the wall) is: -H / 4 at the surface.
FN float squeezed_distance(const StepConstants c, float distance) {
    const float near = nearness(c, distance);
    return distance - 4.0f * near * near * c.support_radius;
}

// The derivative of that.
FN float squeeze(const StepConstants c, float distance) { return 1.0f + 8.0f * nearness(c, distance); }

// Layers of the spacing H / 2 that a particle at `distance` sees; and the derivative by it. Within the wall the share
// is that at the surface: there the collision pushes, and a slope would throw what lies on a rim.
FN float wall_share(const StepConstants c, float distance, float thickness) {
    const float spacing = 0.5f * c.support_radius, z = squeezed_distance(c, max_f(distance, 0.0f));
    float share = 0.0f;
    for (uint k = 0u; k < 3u; ++k) {
        const float depth = ((float)k + 0.5f) * spacing;
        if (depth < thickness) share += 0.5f * plane_share(c, max_f((z + depth) * c.inverse_support_radius, 0.0f));
    }
    return share;
}

FN float wall_slope(const StepConstants c, float distance, float thickness) {
    if (distance < 0.0f) return 0.0f;
    const float spacing = 0.5f * c.support_radius, z = squeezed_distance(c, distance);
    float slope = 0.0f;
    for (uint k = 0u; k < 3u; ++k) {
        const float depth = ((float)k + 0.5f) * spacing;
        if (depth < thickness) slope += 0.5f * plane_slope(c, max_f((z + depth) * c.inverse_support_radius, 0.0f));
    }
    return slope * c.inverse_support_radius * squeeze(c, distance);
}

// The share of a cylinder's wall that stands at a height of `above` (m) over its rim: 1 far below, 0 far above.
FN float rim_share(const StepConstants c, float above) {
    const float z = above * c.inverse_support_radius;
    return z >= 0.0f ? half_space_share(c, z) : 1.0f - half_space_share(c, -z);
}

FN float rim_slope(const StepConstants c, float above) {
    const float z = above * c.inverse_support_radius;
    return -plane_share(c, z >= 0.0f ? z : -z) * c.inverse_support_radius;
}

// One surface. A wall of finite thickness has a far side, with the normal the other way.
FN WallTerm wall_of(const StepConstants c, ColliderConstants s, Motion m) {
    Contact contact = surface_distance(s, m);
    float distance = -contact.depth;
    if (contact.depth > 0.5f * s.thickness) {
        distance = contact.depth - s.thickness;
        contact.nx = -contact.nx;
        contact.ny = -contact.ny;
        contact.nz = -contact.nz;
    }
    float share = 0.0f, slope = 0.0f, rim = 1.0f, along_rim = 0.0f;
    if (distance < c.support_radius) {
        share = wall_share(c, distance, s.thickness);
        slope = wall_slope(c, distance, s.thickness);
    }
    if (s.type >= 5u && s.cutoff < 1.0e30f) {
        rim = rim_share(c, m.y - s.cutoff);
        along_rim = share * rim_slope(c, m.y - s.cutoff);
    }
    // The normal points into the fluid, along growing distance.
    WallTerm term;
    term.share = share * rim;
    term.gradient_x = slope * rim * contact.nx;
    term.gradient_y = slope * rim * contact.ny + along_rim;
    term.gradient_z = slope * rim * contact.nz;
    term.rate = term.gradient_x * s.velocity_x + term.gradient_y * s.velocity_y + term.gradient_z * s.velocity_z;
    return term;
}

// All of them. Where two meet, 1 - (1-a)(1-b) is the share of their union if they are at right angles.
FN WallTerm walls_at(const StepConstants c, GLOBAL const ColliderConstants* RESTRICT collider, float4 position) {
    Motion m;
    m.x = position.x;
    m.y = position.y;
    m.z = position.z;
    m.vx = m.vy = m.vz = 0.0f;
    WallTerm sum;
    sum.share = sum.gradient_x = sum.gradient_y = sum.gradient_z = sum.rate = 0.0f;
    for (uint k = 0u; k < c.collider_count; ++k) {
        const WallTerm term = wall_of(c, collider[k], m);
        if (term.share == 0.0f) continue;
        const float free = 1.0f - term.share, open = 1.0f - sum.share;
        sum.gradient_x = sum.gradient_x * free + term.gradient_x * open;
        sum.gradient_y = sum.gradient_y * free + term.gradient_y * open;
        sum.gradient_z = sum.gradient_z * free + term.gradient_z * open;
        sum.rate = sum.rate * free + term.rate * open;
        sum.share = sum.share + term.share - sum.share * term.share;
    }
    return sum;
}

#endif
