// Packed lists of neighbours, word for word: steps of every length, more than one search finds, more than fits. All
// kernels run as plain C++ here; lists side by side are the CUDA backend's (tests/backends/test_own_lists.py).
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "check.h"
#include "kernels/kernels.h"

namespace {

using Indices = std::vector<uint>;

// Particles that are all candidates of all. Those of `near` stand in one place, the others far from it.
struct Lists {
    StepConstants c{};
    std::vector<float4> position;
    std::vector<uint> start;
    std::vector<short> list;

    Lists(uint particle_count, const Indices& near, uint capacity)
        : position(particle_count, float4{1000.0f, 0.0f, 0.0f, 1.0f}), start(particle_count + 2), list(capacity + 1) {
        for (const uint i : near) position[i].x = 0.0f;
        c.support_radius_squared = 1.0f;
        c.particle_count = particle_count;
        c.list_capacity = capacity;
        c.list_stride = 1;
        list.back() = k_guard;
    }

    void build(uint i) { build_neighbor_list(i, c, position.data(), nullptr, start.data(), list.data()); }

    Indices walk(uint i) const {
        Indices found;
        for (Walk walk = first_neighbor(c, i, start.data(), list.data()); walk.is_there;
             walk = next_neighbor(c, walk, list.data()))
            found.push_back(walk.j);
        return found;
    }

    bool is_within_capacity() const { return list.back() == k_guard; }
    uint needed() const { return start[c.particle_count]; }

    static constexpr short k_guard = 12345;
};

Indices without(Indices indices, uint i) {
    Indices others;
    for (const uint j : indices)
        if (j != i) others.push_back(j);
    return others;
}

Indices first_indices(uint count) {
    Indices indices(count);
    for (uint i = 0; i < count; ++i) indices[i] = i;
    return indices;
}

// Forwards and backwards: 1, the longest in one word, the shortest in three, and such as have a half of zeros.
void steps_have_any_length() {
    const Indices near = {0, 1, 32767, 32768, 65536, 131072, 131073, 196608};
    Lists lists(200000, near, 1000);
    for (const uint i : near) lists.build(i);
    for (const uint i : near) CHECK(lists.walk(i) == without(near, i));
    CHECK(lists.start[0] == 0);
    // 1, 32766, 1, and in three words 32768, 65536, 1 in one, 65535 in three, and the end.
    CHECK(lists.start[1] == 14);
}

void nobody_has_an_empty_list() {
    Lists lists(3, {1}, 10);
    lists.build(1);
    CHECK(lists.walk(1).empty());
    CHECK(lists.needed() == 1);
}

// Around what one search has room for: with a neighbour a word and one for the end.
void a_list_may_take_several_searches() {
    for (const uint length : {LIST_ROOM - 1, LIST_ROOM, LIST_ROOM + 1, 2 * LIST_ROOM, 3 * LIST_ROOM + 7}) {
        const Indices near = first_indices(length);
        Lists lists(length + 10, near, 3 * length);
        for (const uint i : {1u, length - 1, length / 2}) lists.build(i);
        for (const uint i : {1u, length - 1, length / 2}) CHECK(lists.walk(i) == without(near, i));
        CHECK(lists.needed() == 3 * length);
        CHECK(lists.is_within_capacity());
    }
}

void what_does_not_fit_is_counted() {
    const Indices near = first_indices(200);
    Lists lists(200, near, 350);
    for (const uint i : {0u, 1u, 2u}) lists.build(i);
    CHECK(lists.walk(0) == without(near, 0));
    CHECK(lists.needed() == 600);
    CHECK(lists.is_within_capacity());
}

// 32 bits do not count them all; the word behind has the rest.
void more_than_32_bits_are_counted() {
    Lists lists(200, first_indices(200), 350);
    lists.start[200] = 0xffffff80u;
    lists.build(0);
    CHECK(lists.needed() == 200 - 128);
    CHECK(lists.start[201] == 1);
    lists.build(1);
    CHECK(lists.start[201] == 1);
}

}  // namespace

int main() {
    steps_have_any_length();
    nobody_has_an_empty_list();
    a_list_may_take_several_searches();
    what_does_not_fit_is_counted();
    more_than_32_bits_are_counted();
    if (failed_checks) return EXIT_FAILURE;
    std::puts("lists of neighbours say who is near");
    return EXIT_SUCCESS;
}
