// Collisions with implicit surfaces, III.7 of the thesis: push the particle out along the normal, reflect the normal
// part of its velocity relative to the surface by the elasticity, take the friction from the tangential part.
//
// A surface is a half-space, the inside or the outside of a sphere or of a vertical cylinder; what is behind it is
// solid however far the particle went, so nothing tunnels. A wall of finite thickness is solid only within it, so that
// two of them make a basin with water on both sides; a cylinder stands up to its cutoff and has a flat rim there.
#ifndef FONTANA_COLLIDE_H
#define FONTANA_COLLIDE_H

#include "step_constants.h"

typedef struct Motion {
    float x, y, z;     // m
    float vx, vy, vz;  // m/s
} Motion;

// depth > 0: how far the particle is behind the surface, along the normal.
typedef struct Contact {
    float depth;
    float nx, ny, nz;
} Contact;

FN Contact plane_contact(ColliderConstants s, Motion m) {
    Contact contact;
    contact.nx = s.type == 0u ? s.side : 0.0f;
    contact.ny = s.type == 1u ? s.side : 0.0f;
    contact.nz = s.type == 2u ? s.side : 0.0f;
    contact.depth =
        -((m.x - s.centre_x) * contact.nx + (m.y - s.centre_y) * contact.ny + (m.z - s.centre_z) * contact.nz);
    return contact;
}

// inside: +1 keeps the fluid within the radius, -1 without.
FN Contact round_distance(ColliderConstants s, Motion m, float inside, uint is_cylinder) {
    const float dx = m.x - s.centre_x;
    const float dy = is_cylinder ? 0.0f : m.y - s.centre_y;
    const float dz = m.z - s.centre_z;
    const float r = SQRT(dx * dx + dy * dy + dz * dz);
    const float inverse_r = r > 1.0e-12f ? 1.0f / r : 0.0f;
    Contact contact;
    contact.depth = inside * (r - s.radius);
    contact.nx = -inside * dx * inverse_r;
    contact.ny = -inside * dy * inverse_r;
    contact.nz = -inside * dz * inverse_r;
    // On the axis or in the centre any way out is as good as another.
    if (inverse_r == 0.0f) contact.nx = 1.0f;
    return contact;
}

// How far behind the bare surface a particle is, negative in front of it, and the normal into the fluid.
FN Contact surface_distance(ColliderConstants s, Motion m) {
    if (s.type <= 2u) return plane_contact(s, m);
    return round_distance(s, m, s.type == 3u || s.type == 5u ? 1.0f : -1.0f, s.type >= 5u ? 1u : 0u);
}

// The same with the ends of a wall: its thickness, and the rim that a cylinder has at the cutoff.
FN Contact contact_with(ColliderConstants s, Motion m) {
    Contact contact = surface_distance(s, m);
    if (s.type <= 2u) return contact;
    if (contact.depth > s.thickness) contact.depth = 0.0f;
    if (s.type >= 5u && contact.depth > 0.0f) {
        const float below_rim = s.cutoff - m.y;
        if (below_rim <= contact.depth) {
            contact.depth = below_rim;
            contact.nx = 0.0f;
            contact.ny = 1.0f;
            contact.nz = 0.0f;
        }
    }
    return contact;
}

FN Motion collide(ColliderConstants s, Motion m) {
    const Contact contact = contact_with(s, m);
    if (!(contact.depth > 0.0f)) return m;
    m.x += contact.depth * contact.nx;
    m.y += contact.depth * contact.ny;
    m.z += contact.depth * contact.nz;
    const float ux = m.vx - s.velocity_x, uy = m.vy - s.velocity_y, uz = m.vz - s.velocity_z;
    const float approach = ux * contact.nx + uy * contact.ny + uz * contact.nz;
    if (approach >= 0.0f) return m;
    const float tangential = 1.0f - s.friction, normal = -s.elasticity * approach;
    m.vx = s.velocity_x + tangential * (ux - approach * contact.nx) + normal * contact.nx;
    m.vy = s.velocity_y + tangential * (uy - approach * contact.ny) + normal * contact.ny;
    m.vz = s.velocity_z + tangential * (uz - approach * contact.nz) + normal * contact.nz;
    return m;
}

#endif
