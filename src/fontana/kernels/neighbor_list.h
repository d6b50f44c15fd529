// Lists of neighbours, built once a substep and walked by every pass after that. These are for loops that take one
// particle at a time; loops over several share a list between them (backends/cpu/wide_lists.h).
//
// A list is a row of 16-bit words: for each neighbour the step to its index from that of the one before, for the first
// from the particle's own. Particles lie in the order of their cells, so most steps are short; a LONG_STEP is followed
// by two words that have it, the low half first. No step is zero, so a zero ends the list.
//
// Processors have packed lists, each behind the one that was finished before it, wherever that is: where they lie
// depends on the threads, what they say does not. On a GPU, whose threads walk side by side, word k of all lists does.
#ifndef FONTANA_NEIGHBOR_LIST_H
#define FONTANA_NEIGHBOR_LIST_H

#include "cells.h"

#define LONG_STEP (-32768)
#define LIST_ROOM 128u  // words of a list that a processor finds at a time: one search will do but in a crowd

typedef struct Walk {
    uint at;        // the next word
    uint j;         // the neighbour
    bool is_there;  // or the list has come to its end
} Walk;

FN Walk next_neighbor(const StepConstants c, Walk walk, GLOBAL const short* RESTRICT list) {
    const int step = list[walk.at];
    walk.at += c.list_stride;
    walk.is_there = step != 0;
    if (step != LONG_STEP) {
        walk.j += (uint)step;
    } else {
        const uint low = (uint)list[walk.at] & 0xffffu, high = (uint)list[walk.at + c.list_stride];
        walk.j += low | high << 16;
        walk.at += 2u * c.list_stride;
    }
    return walk;
}

FN Walk first_neighbor(const StepConstants c, uint i, GLOBAL const uint* RESTRICT list_start,
                       GLOBAL const short* RESTRICT list) {
    Walk walk;
    walk.at = list_start[i];
    walk.j = i;
    walk.is_there = true;
    return next_neighbor(c, walk, list);
}

// Where a search writes a list: in memory of its own, or on a GPU to where the list belongs.
#ifdef FONTANA_PACKED_LISTS
#define DRAFT short*
#else
#define DRAFT GLOBAL short*
#endif

// A search in progress. Of the list it writes the words from `first` on, as many as there is room for.
typedef struct Search {
    uint first, room, stride;
    uint count, length;  // so far: neighbours, and the words of the list
    uint last;           // the neighbour found last
} Search;

FN Search search_for(uint i, uint first, uint room, uint stride) {
    Search search;
    search.first = first;
    search.room = room;
    search.stride = stride;
    search.count = search.length = 0u;
    search.last = i;
    return search;
}

FN Search add_word(Search search, uint word, DRAFT draft) {
    const uint k = search.length - search.first;
    if (k < search.room) draft[k * search.stride] = (short)word;
    ++search.length;
    return search;
}

FN Search add_to_list(Search search, uint j, DRAFT draft) {
    const uint step = j - search.last;
    ++search.count;
    search.last = j;
    if (step + 32767u < 65535u) return add_word(search, step, draft);
    search = add_word(search, (uint)LONG_STEP, draft);
    search = add_word(search, step & 0xffffu, draft);
    return add_word(search, step >> 16, draft);
}

// Everyone within the support radius but the particle itself, in the order of the cells, with the end of the list.
FN Search find_neighbors(const StepConstants c, uint i, GLOBAL const float4* RESTRICT position,
                         GLOBAL const uint* RESTRICT cell_start, Search search, DRAFT draft) {
    const float4 x_i = position[i];
    const CellCoordinates cell = cell_of(c, x_i);
    const uint range_count = candidate_range_count(c, cell);
    for (uint k = 0u; k < range_count; ++k) {
        const Range range = candidate_range(c, cell, k, cell_start);
        for (uint j = range.begin; j < range.end; ++j) {
            const float4 x_j = position[j];
            const float dx = x_i.x - x_j.x, dy = x_i.y - x_j.y, dz = x_i.z - x_j.z;
            if (dx * dx + dy * dy + dz * dz < c.support_radius_squared && j != i)
                search = add_to_list(search, j, draft);
        }
    }
    return add_word(search, 0u, draft);
}

// Two words behind the starts, the low one first, say what room the lists need: packed, all of them together; else the
// longest of those that do not fit. Where they do not, the host makes room and builds them anew before anyone walks
// them.
#ifdef FONTANA_PACKED_LISTS

// Where the words of a list go: behind those that others have taken before.
FN uint take_words(GLOBAL uint* needed, uint length) {
    const uint start = ATOMIC_ADD(needed, length);
    if (start + length < start) ATOMIC_ADD(needed + 1, 1u);
    return start;
}

FN void write_list(const StepConstants c, uint i, GLOBAL const float4* RESTRICT position,
                   GLOBAL const uint* RESTRICT cell_start, GLOBAL uint* RESTRICT list_start,
                   GLOBAL short* RESTRICT list) {
    short draft[LIST_ROOM];
    uint start = 0u, first = 0u, length = 0u;
    do {
        length = find_neighbors(c, i, position, cell_start, search_for(i, first, LIST_ROOM, 1u), draft).length;
        if (first == 0u) start = take_words(list_start + c.particle_count, length);
        if (start > c.list_capacity || length > c.list_capacity - start) return;
        const uint end = length - first < LIST_ROOM ? length : first + LIST_ROOM;
        for (uint k = first; k < end; ++k) list[start + k] = draft[k - first];
        first = end;
    } while (first < length);
    list_start[i] = start;
}

#else

FN void write_list(const StepConstants c, uint i, GLOBAL const float4* RESTRICT position,
                   GLOBAL const uint* RESTRICT cell_start, GLOBAL uint* RESTRICT list_start,
                   GLOBAL short* RESTRICT list) {
    const Search search = search_for(i, 0u, c.list_capacity, c.list_stride);
    const uint length = find_neighbors(c, i, position, cell_start, search, list + i).length;
    list_start[i] = i;
    if (length > c.list_capacity) ATOMIC_MAXIMUM(list_start + c.particle_count, length);
}

#endif

KERNEL void build_neighbor_list(THREAD_ARG const StepConstants c, GLOBAL const float4* RESTRICT position,
                                GLOBAL const uint* RESTRICT cell_start, GLOBAL uint* RESTRICT list_start,
                                GLOBAL short* RESTRICT list) {
    const uint i = THREAD_INDEX;
    if (i < c.particle_count) write_list(c, i, position, cell_start, list_start, list);
}

// For hosts that ask how many they are.
KERNEL void count_neighbors(THREAD_ARG const StepConstants c, GLOBAL const float4* RESTRICT position,
                            GLOBAL const uint* RESTRICT cell_start, GLOBAL uint* RESTRICT neighbor_count) {
    const uint i = THREAD_INDEX;
    if (i >= c.particle_count) return;
    neighbor_count[i] = find_neighbors(c, i, position, cell_start, search_for(i, 0u, 0u, 0u), 0).count;
}

#endif
