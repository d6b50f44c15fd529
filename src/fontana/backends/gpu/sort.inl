// The counting sort of the grid, III.6 of the thesis, for keys below a known bound:
//   sort_histogram     counts each key; the count a value finds is its rank among those with its key
//   sort_scan_blocks,  turn the counts into the place where each key starts (exclusive scan, in blocks, level by level)
//   sort_add_offsets
//   sort_scatter       puts each value's index at start + rank
//   sort_order_ties    sorts the indices of each key: ranks depend on who came first, the result must not
#include "dialect.h"

// Values a thread of the scan takes after each other, so that a block of them costs one round of barriers.
#define VALUES_PER_THREAD 4u
// Up to here insertion sort beats a heap; beyond it its quadratic cost would show.
#define INSERTION_SORT_LIMIT 64u

KERNEL void sort_histogram(const uint count, GLOBAL const uint* RESTRICT key, GLOBAL uint* RESTRICT key_count,
                           GLOBAL uint* RESTRICT rank) {
    const uint i = THREAD_INDEX;
    if (i < count) rank[i] = ATOMIC_INCREMENT(&key_count[key[i]]);
}

// Scans each block of FONTANA_GROUP_SIZE * VALUES_PER_THREAD values in place and writes its total.
GROUP_KERNEL void sort_scan_blocks(const uint count, GLOBAL uint* RESTRICT value, GLOBAL uint* RESTRICT block_total) {
    LOCAL uint total[FONTANA_GROUP_SIZE];
    const uint lane = LANE_INDEX;
    const uint begin = min(count, THREAD_INDEX * VALUES_PER_THREAD);
    const uint end = min(count, begin + VALUES_PER_THREAD);
    uint sum = 0u;
    for (uint k = begin; k < end; ++k) sum += value[k];
    total[lane] = sum;
    for (uint distance = 1u; distance < FONTANA_GROUP_SIZE; distance *= 2u) {
        BARRIER();
        const uint before = lane >= distance ? total[lane - distance] : 0u;
        BARRIER();
        total[lane] += before;
    }
    uint running = total[lane] - sum;
    for (uint k = begin; k < end; ++k) {
        const uint here = value[k];
        value[k] = running;
        running += here;
    }
    if (lane == FONTANA_GROUP_SIZE - 1u) block_total[GROUP_INDEX] = total[lane];
}

KERNEL void sort_add_offsets(const uint count, GLOBAL uint* RESTRICT value, GLOBAL const uint* RESTRICT block_offset) {
    const uint i = THREAD_INDEX;
    if (i < count) value[i] += block_offset[i / (FONTANA_GROUP_SIZE * VALUES_PER_THREAD)];
}

KERNEL void sort_scatter(const uint count, GLOBAL const uint* RESTRICT key, GLOBAL const uint* RESTRICT rank,
                         GLOBAL const uint* RESTRICT start, GLOBAL uint* RESTRICT order) {
    const uint i = THREAD_INDEX;
    if (i < count) order[start[key[i]] + rank[i]] = i;
}

FN void insertion_sort(GLOBAL uint* value, uint count) {
    for (uint i = 1u; i < count; ++i) {
        const uint moving = value[i];
        uint k = i;
        for (; k > 0u && value[k - 1u] > moving; --k) value[k] = value[k - 1u];
        value[k] = moving;
    }
}

// Lets value[root] sink into the heap of `count` values below it.
FN void sift_down(GLOBAL uint* value, uint root, uint count) {
    const uint sinking = value[root];
    uint child = 2u * root + 1u;
    while (child < count) {
        if (child + 1u < count && value[child + 1u] > value[child]) ++child;
        if (value[child] <= sinking) break;
        value[root] = value[child];
        root = child;
        child = 2u * root + 1u;
    }
    value[root] = sinking;
}

FN void heap_sort(GLOBAL uint* value, uint count) {
    for (uint root = count / 2u; root > 0u; --root) sift_down(value, root - 1u, count);
    for (uint last = count - 1u; last > 0u; --last) {
        const uint largest = value[0];
        value[0] = value[last];
        value[last] = largest;
        sift_down(value, 0u, last);
    }
}

KERNEL void sort_order_ties(const uint key_count, GLOBAL const uint* RESTRICT start, GLOBAL uint* RESTRICT order) {
    const uint key = THREAD_INDEX;
    if (key >= key_count) return;
    const uint begin = start[key], count = start[key + 1u] - begin;
    if (count <= INSERTION_SORT_LIMIT)
        insertion_sort(order + begin, count);
    else
        heap_sort(order + begin, count);
}
