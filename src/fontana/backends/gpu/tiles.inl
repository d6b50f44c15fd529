// The passes of mueller over neighbours, with the candidates of a work-group in its local memory: the way to tile that
// the thesis leaves for later (chapter V). The loops alone are other ones; formulas and the order of every sum are those of
// density.h and fluid_force.h, so the results are too.
//
// Particles lie in the order of their cells, so those of a group are mostly in one row of cells and ask for much the
// same ranges. Row by row the group finds the range that covers all of theirs, copies it tile by tile, and each member
// takes its own part of every tile. Where members stand in rows apart and the cover is more than what they ask for
// together, each reads for itself.
#include "cells.h"
#include "density.h"
#include "dialect.h"
#include "fluid_force.h"

#define COVER_BEGIN 0
#define COVER_END 1
#define COVER_ASKED 2
#define COVER_SIZE 3

FN void begin_cover(LOCAL_POINTER uint* cover) {
    BARRIER();  // everyone has read the former one
    if (LANE_INDEX == 0u) {
        cover[COVER_BEGIN] = 0xffffffffu;
        cover[COVER_END] = 0u;
        cover[COVER_ASKED] = 0u;
    }
    BARRIER();
}

// How many ranges the member of a group with the most of them asks for.
FN uint most_ranges(LOCAL_POINTER uint* cover, uint range_count) {
    begin_cover(cover);
    ATOMIC_MAXIMUM(&cover[COVER_END], range_count);
    BARRIER();
    return cover[COVER_END];
}

// A particle's k-th range; none beyond its last.
FN Range own_range(const StepConstants c, CellCoordinates cell, uint k, uint range_count,
                   GLOBAL const uint* RESTRICT cell_start) {
    Range none;
    none.begin = none.end = 0u;
    return k < range_count ? candidate_range(c, cell, k, cell_start) : none;
}

// The range that covers all of the group's; empty where a tile would not pay.
FN Range covering_range(LOCAL_POINTER uint* cover, Range own) {
    begin_cover(cover);
    if (own.begin < own.end) {
        ATOMIC_MINIMUM(&cover[COVER_BEGIN], own.begin);
        ATOMIC_MAXIMUM(&cover[COVER_END], own.end);
        ATOMIC_ADD(&cover[COVER_ASKED], own.end - own.begin);
    }
    BARRIER();
    Range all;
    all.begin = cover[COVER_BEGIN];
    all.end = cover[COVER_END];
    if (all.begin >= all.end || all.end - all.begin > cover[COVER_ASKED]) all.end = all.begin = 0u;
    return all;
}

// The part of `own` within the tile that begins at `first`.
FN Range part_in_tile(Range own, uint first) {
    Range part;
    part.begin = own.begin > first ? own.begin : first;
    part.end = own.end < first + FONTANA_GROUP_SIZE ? own.end : first + FONTANA_GROUP_SIZE;
    return part;
}

FN float add_density(float sum, const StepConstants c, float4 x_i, float4 x_j) {
    const float dx = x_i.x - x_j.x, dy = x_i.y - x_j.y, dz = x_i.z - x_j.z;
    const float r_squared = dx * dx + dy * dy + dz * dz;
    if (r_squared < c.support_radius_squared) sum += x_j.w * poly6(r_squared, c.support_radius_squared);
    return sum;
}

GROUP_KERNEL void density_tiles(const StepConstants c, GLOBAL const float4* RESTRICT position,
                                GLOBAL const float4* RESTRICT velocity, GLOBAL const uint* RESTRICT cell_start,
                                GLOBAL float* RESTRICT density_out, GLOBAL float4* RESTRICT packed_position,
                                GLOBAL float4* RESTRICT packed_velocity, GLOBAL float* RESTRICT pressure) {
    LOCAL float4 tile[FONTANA_GROUP_SIZE];
    LOCAL uint cover[COVER_SIZE];
    const uint i = THREAD_INDEX, lane = LANE_INDEX;
    const uint is_particle = i < c.particle_count ? 1u : 0u;
    const float4 x_i = position[is_particle ? i : 0u];
    const CellCoordinates cell = cell_of(c, x_i);
    const uint range_count = is_particle ? candidate_range_count(c, cell) : 0u;
    const uint row_count = most_ranges(cover, range_count);
    float sum = 0.0f;
    for (uint k = 0u; k < row_count; ++k) {
        const Range own = own_range(c, cell, k, range_count, cell_start);
        const Range all = covering_range(cover, own);
        if (all.begin == all.end)
            for (uint j = own.begin; j < own.end; ++j) sum = add_density(sum, c, x_i, position[j]);
        for (uint first = all.begin; first < all.end; first += FONTANA_GROUP_SIZE) {
            BARRIER();  // everyone is through with the former tile
            if (first + lane < all.end) tile[lane] = position[first + lane];
            BARRIER();
            const Range part = part_in_tile(own, first);
            for (uint j = part.begin; j < part.end; ++j) sum = add_density(sum, c, x_i, tile[j - first]);
        }
    }
    if (is_particle)
        store_pressure_state(c, i, sum, x_i, velocity[i], density_out, packed_position, packed_velocity, pressure);
}

FN ForceSum add_force_within(ForceSum sum, const StepConstants c, float4 x_i, float4 v_i, float4 x_j, float4 v_j) {
    const float dx = x_i.x - x_j.x, dy = x_i.y - x_j.y, dz = x_i.z - x_j.z;
    if (dx * dx + dy * dy + dz * dz < c.support_radius_squared) return add_force(sum, c, x_i, v_i, x_j, v_j);
    return sum;
}

GROUP_KERNEL void fluid_force_tiles(const StepConstants c, GLOBAL const float4* RESTRICT packed_position,
                                    GLOBAL const float4* RESTRICT packed_velocity,
                                    GLOBAL const float* RESTRICT density_in, GLOBAL const uint* RESTRICT cell_start,
                                    GLOBAL float4* RESTRICT acceleration) {
    LOCAL float4 tile_position[FONTANA_GROUP_SIZE], tile_velocity[FONTANA_GROUP_SIZE];
    LOCAL uint cover[COVER_SIZE];
    const uint i = THREAD_INDEX, lane = LANE_INDEX;
    const uint is_particle = i < c.particle_count ? 1u : 0u;
    const float4 x_i = packed_position[is_particle ? i : 0u], v_i = packed_velocity[is_particle ? i : 0u];
    const CellCoordinates cell = cell_of(c, x_i);
    const uint range_count = is_particle ? candidate_range_count(c, cell) : 0u;
    const uint row_count = most_ranges(cover, range_count);
    ForceSum sum = zero_force();
    for (uint k = 0u; k < row_count; ++k) {
        const Range own = own_range(c, cell, k, range_count, cell_start);
        const Range all = covering_range(cover, own);
        if (all.begin == all.end)
            for (uint j = own.begin; j < own.end; ++j)
                sum = add_force_within(sum, c, x_i, v_i, packed_position[j], packed_velocity[j]);
        for (uint first = all.begin; first < all.end; first += FONTANA_GROUP_SIZE) {
            BARRIER();  // everyone is through with the former tile
            if (first + lane < all.end) {
                tile_position[lane] = packed_position[first + lane];
                tile_velocity[lane] = packed_velocity[first + lane];
            }
            BARRIER();
            const Range part = part_in_tile(own, first);
            for (uint j = part.begin; j < part.end; ++j)
                sum = add_force_within(sum, c, x_i, v_i, tile_position[j - first], tile_velocity[j - first]);
        }
    }
    if (is_particle) acceleration[i] = force_to_acceleration(c, sum, density_in[i]);
}
