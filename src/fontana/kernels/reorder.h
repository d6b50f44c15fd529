// Moving data: particles into the order of the cells, and back into the order of their ids for the host.
#ifndef FONTANA_REORDER_H
#define FONTANA_REORDER_H

#include "dialect.h"

KERNEL void gather_state(THREAD_ARG const uint count, GLOBAL const uint* RESTRICT order,
                         GLOBAL const float4* RESTRICT position_in, GLOBAL const float4* RESTRICT velocity_in,
                         GLOBAL const uint* RESTRICT id_in, GLOBAL float4* RESTRICT position_out,
                         GLOBAL float4* RESTRICT velocity_out, GLOBAL uint* RESTRICT id_out) {
    const uint i = THREAD_INDEX;
    if (i >= count) return;
    const uint from = order[i];
    position_out[i] = position_in[from];
    velocity_out[i] = velocity_in[from];
    id_out[i] = id_in[from];
}

KERNEL void vectors_by_id(THREAD_ARG const uint count, GLOBAL const uint* RESTRICT id,
                          GLOBAL const float4* RESTRICT value, GLOBAL float* RESTRICT out) {
    const uint i = THREAD_INDEX;
    if (i >= count) return;
    const uint to = 3u * id[i];
    out[to] = value[i].x;
    out[to + 1u] = value[i].y;
    out[to + 2u] = value[i].z;
}

KERNEL void fourth_by_id(THREAD_ARG const uint count, GLOBAL const uint* RESTRICT id,
                         GLOBAL const float4* RESTRICT value, GLOBAL float* RESTRICT out) {
    const uint i = THREAD_INDEX;
    if (i < count) out[id[i]] = value[i].w;
}

// Any 4-byte value; counts travel as they are.
KERNEL void words_by_id(THREAD_ARG const uint count, GLOBAL const uint* RESTRICT id, GLOBAL const uint* RESTRICT value,
                        GLOBAL uint* RESTRICT out) {
    const uint i = THREAD_INDEX;
    if (i < count) out[id[i]] = value[i];
}

// What the speed of a device's memory is measured with.
KERNEL void copy_vectors(THREAD_ARG const uint count, GLOBAL const float4* RESTRICT from, GLOBAL float4* RESTRICT to) {
    const uint i = THREAD_INDEX;
    if (i < count) to[i] = from[i];
}

KERNEL void clear_words(THREAD_ARG const uint count, GLOBAL uint* RESTRICT words) {
    const uint i = THREAD_INDEX;
    if (i < count) words[i] = 0u;
}

#endif
