// Walls that count as fluid at rest density. The volume behind a plane within the support has a closed form
// (half_space_share), so a wall needs no boundary particles, has no bumps and costs no neighbours; spheres and
// cylinders are taken as their tangent plane, exact as the radius grows over the support radius.
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

// The share as a function of the signed distance (m) from the surface into the fluid, over its whole range. The fluid
// behind begins a little deeper (wall_offset), so that a lattice half a spacing from the surface has rest density.
FN float wall_share(const StepConstants c, float distance) {
    const float s = distance * c.inverse_support_radius;
    return s >= 0.0f ? half_space_share(c, s) : 1.0f - half_space_share(c, -s);
}

FN float wall_slope(const StepConstants c, float distance) {
    const float s = distance * c.inverse_support_radius;
    return half_space_slope(c, s >= 0.0f ? s : -s) * c.inverse_support_radius;
}

// One surface. A wall of finite thickness lacks what would be behind it; a cylinder's lacks what would be above its
// rim.
FN WallTerm wall_of(const StepConstants c, ColliderConstants s, Motion m) {
    const Contact contact = surface_distance(s, m);
    const float distance = c.wall_offset - contact.depth;
    float share = wall_share(c, distance), slope = wall_slope(c, distance), rim = 1.0f, rim_slope = 0.0f;
    if (s.thickness < 1.0e30f) {
        share -= wall_share(c, distance + s.thickness);
        slope -= wall_slope(c, distance + s.thickness);
    }
    if (s.type >= 5u && s.cutoff < 1.0e30f) {
        rim = wall_share(c, m.y - s.cutoff);
        rim_slope = wall_slope(c, m.y - s.cutoff);
    }
    WallTerm term;
    term.share = share * rim;
    // The normal points into the fluid, along growing distance: the share falls that way.
    term.gradient_x = -slope * rim * contact.nx;
    term.gradient_y = -slope * rim * contact.ny - share * rim_slope;
    term.gradient_z = -slope * rim * contact.nz;
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
