// Moving particles apart, one kernel at a time, as plain C++: who is found, and that nobody leaves the cell that the
// grid still counts them in.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "check.h"
#include "kernels/kernels.h"

namespace {

StepConstants constants_of(uint particle_count) {
    StepConstants c{};
    c.inverse_rest_density = 1e-3f;
    c.inverse_cell_size = 1.0f;
    c.particle_count = particle_count;
    c.grid_mask_x = c.grid_mask_y = c.grid_mask_z = 7u;
    c.list_stride = 1u;
    return c;
}

void the_dense_who_can_move_are_found() {
    const std::vector<float> density = {1005.0f, 1030.0f, 1030.0f, NAN};
    const std::vector<float4> factor = {{0, 0, 0, 2.0f}, {0, 0, 0, 2.0f}, {0, 0, 0, 0.0f}, {0, 0, 0, 2.0f}};
    std::vector<float> lambda(4, -1.0f);
    std::vector<uint> moved(4, 7u), changed(4, 7u);
    uint found = 0;
    for (uint i = 0; i < 4; ++i)
        find_crowded(i, constants_of(4), 0.01f, density.data(), factor.data(), lambda.data(), moved.data(),
                     changed.data(), &found);
    CHECK(found == 1);
    CHECK(lambda[0] == 0.0f && lambda[2] == 0.0f && lambda[3] == 0.0f);
    CHECK(std::fabs(lambda[1] - CROWDING_RELAXATION * (0.03f - CROWDING_REST * 0.01f) * 2.0f) < 1e-6f);
    for (uint i = 0; i < 4; ++i) CHECK(moved[i] == 0u && changed[i] == 0u);
}

void nobody_leaves_a_cell() {
    const std::vector<float4> gradient = {
        {0.01f, 0.01f, 0.0f, 0.0f}, {-0.01f, 0.0f, 0.02f, 0.0f}, {1.0f, 1.0f, 1.0f, 0}};
    const std::vector<float4> before = {
        {1.005f, 0.5f, 0.5f, 3.0f}, {1.995f, 0.5f, 0.01f, 3.0f}, {0.5f, 0.5f, 0.5f, 3.0f}};
    const std::vector<float4> after = {
        {1.005f, 0.49f, 0.5f, 3.0f}, {1.995f, 0.5f, 0.01f, 3.0f}, {0.5f, 0.5f, 0.5f, 3.0f}};
    const std::vector<uint> moved = {1u, 1u, 0u}, start = {0u, 2u, 4u};
    const std::vector<short> list = {2, 0, 1, 0, 0};  // 0 has 2 for a neighbour, 1 has 2, and 2 nobody
    std::vector<uint> changed(3, 0u);
    std::vector<float4> position = before;
    for (uint i = 0; i < 2; ++i)
        move_apart(i, constants_of(3), moved.data(), gradient.data(), start.data(), list.data(), position.data(),
                   changed.data());
    for (uint i = 0; i < 3; ++i) {
        CHECK(position[i].x == after[i].x && position[i].y == after[i].y && position[i].w == 3.0f);
        CHECK(std::fabs(position[i].z - after[i].z) < 1e-7f);
    }
    CHECK(changed[0] == 1u && changed[1] == 1u && changed[2] == 1u);
    move_apart(2, constants_of(3), moved.data(), gradient.data(), start.data(), list.data(), position.data(),
               changed.data());
    CHECK(position[2].x == 0.5f);
}

}  // namespace

int main() {
    the_dense_who_can_move_are_found();
    nobody_leaves_a_cell();
    if (failed_checks) return EXIT_FAILURE;
    std::puts("particles are moved apart within their cells");
    return EXIT_SUCCESS;
}
