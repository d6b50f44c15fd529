// Lists of neighbours, built once a substep and walked by every pass after that. These are for loops that take one
// particle at a time; loops over several share a list between them (backends/cpu/wide_lists.h).
#ifndef FONTANA_NEIGHBOR_LIST_H
#define FONTANA_NEIGHBOR_LIST_H

#include "cells.h"

FN uint neighbor(const StepConstants c, GLOBAL const uint* RESTRICT list, uint i, uint k) {
    return list[i * c.list_particle_stride + k * c.list_neighbor_stride];
}

// A list that ran over its capacity is walked as far as it goes; the host sees the true count and builds it anew.
FN uint list_length(const StepConstants c, uint neighbor_count) {
    return neighbor_count < c.list_capacity ? neighbor_count : c.list_capacity;
}

// Where, in the array of counts, the length of all the shared lists together is: after two words a list.
FN uint shared_list_total(uint particle_count, uint group) { return (particle_count + group - 1u) / group * 2u; }

// Everyone within the support radius but the particle itself, in the order of the cells: how many they are. As many as
// there is room for go into the list.
FN uint find_neighbors(const StepConstants c, uint i, GLOBAL const float4* RESTRICT position,
                       GLOBAL const uint* RESTRICT cell_start, GLOBAL uint* list) {
    const float4 x_i = position[i];
    const CellCoordinates cell = cell_of(c, x_i);
    const uint range_count = candidate_range_count(c, cell);
    uint count = 0u;
    for (uint k = 0u; k < range_count; ++k) {
        const Range range = candidate_range(c, cell, k, cell_start);
        for (uint j = range.begin; j < range.end; ++j) {
            const float4 x_j = position[j];
            const float dx = x_i.x - x_j.x, dy = x_i.y - x_j.y, dz = x_i.z - x_j.z;
            if (dx * dx + dy * dy + dz * dz < c.support_radius_squared && j != i) {
                if (count < c.list_capacity) list[i * c.list_particle_stride + count * c.list_neighbor_stride] = j;
                ++count;
            }
        }
    }
    return count;
}

KERNEL void build_neighbor_list(THREAD_ARG const StepConstants c, GLOBAL const float4* RESTRICT position,
                                GLOBAL const uint* RESTRICT cell_start, GLOBAL uint* RESTRICT neighbor_count,
                                GLOBAL uint* RESTRICT list) {
    const uint i = THREAD_INDEX;
    if (i < c.particle_count) neighbor_count[i] = find_neighbors(c, i, position, cell_start, list);
}

// For hosts that ask how many they are. Its constants have a list_capacity of 0, so nothing is written through the last
// argument.
KERNEL void count_neighbors(THREAD_ARG const StepConstants c, GLOBAL const float4* RESTRICT position,
                            GLOBAL const uint* RESTRICT cell_start, GLOBAL uint* RESTRICT neighbor_count) {
    const uint i = THREAD_INDEX;
    if (i < c.particle_count) neighbor_count[i] = find_neighbors(c, i, position, cell_start, neighbor_count);
}

#endif
