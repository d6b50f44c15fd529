// The coarse matrices against what defines them: P^T K P, one column at a time, with the kernels of the solve itself
// for K = G^T G and sums over cells for P. All kernels run as plain C++ here.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <vector>

#include "check.h"
#include "kernels/kernels.h"

namespace {

constexpr float k_spacing = 0.1f, k_support = 2.0f * k_spacing;
constexpr uint k_bits = 3, k_side = 1u << k_bits;  // the box of cells; it wraps around
constexpr uint k_words = 128;                      // of a particle's list, at the most

CoarseLevel level_of(uint bits_x, uint bits_y, uint bits_z) {
    return {(1u << bits_x) - 1u, (1u << bits_y) - 1u, (1u << bits_z) - 1u, bits_x, bits_x + bits_y};
}

StepConstants constants_of(uint particle_count) {
    StepConstants c{};
    c.support_radius = k_support;
    c.support_radius_squared = k_support * k_support;
    c.inverse_support_radius = 1.0f / k_support;
    c.rest_density = 1000.0f;
    c.inverse_rest_density = 1e-3f;
    c.kernel_scale = 8.0f / (3.14159265f * k_support * k_support * k_support);
    c.gradient_scale = -6.0f * c.kernel_scale / k_support * c.inverse_rest_density;
    c.inverse_cell_size = 1.0f / k_support;
    c.particle_count = particle_count;
    c.use_grid = 1u;
    c.grid_mask_x = c.grid_mask_y = c.grid_mask_z = k_side - 1u;
    c.grid_shift_y = k_bits;
    c.grid_shift_z = 2u * k_bits;
    c.list_capacity = particle_count * k_words;
    c.list_stride = 1u;
    return c;
}

// A jittered block of water across the border where the box wraps around, sorted by cell, with its lists.
struct Fluid {
    StepConstants c;
    std::vector<float4> position, velocity, factor, viscous, gradient;
    std::vector<uint> cell_start, list_start;
    std::vector<short> list;
    std::vector<float> density, wall_rate, rate, weight;

    Fluid() : c(constants_of(0)) {
        std::mt19937 random(7);
        std::uniform_real_distribution<float> jitter(-0.02f, 0.02f);
        std::vector<std::vector<float4>> cells(k_side * k_side * k_side);
        for (int x = -6; x < 5; ++x)
            for (int y = 0; y < 9; ++y)
                for (int z = 0; z < 7; ++z) {
                    const auto at = [&](int k) { return (static_cast<float>(k) + 0.5f) * k_spacing + jitter(random); };
                    const float4 p{at(x), at(y), at(z), 1000.0f * k_spacing * k_spacing * k_spacing};
                    cells[cell_key(c, cell_of(c, p))].push_back(p);
                }
        cell_start.push_back(0u);
        for (const auto& cell : cells) {
            // Cells too thin for the coarse levels would leave the matrix incomplete, on purpose; not here.
            if (cell.size() >= COARSE_LEAST) position.insert(position.end(), cell.begin(), cell.end());
            cell_start.push_back(static_cast<uint>(position.size()));
        }
        const auto n = static_cast<uint>(position.size());
        c = constants_of(n);
        velocity.resize(n);
        factor.resize(n);
        viscous.resize(n);
        gradient.resize(n);
        list_start.resize(n + 2);
        list.resize(c.list_capacity);
        density.resize(n);
        wall_rate.resize(n);
        rate.resize(n);
        weight.resize(n);
        for (uint i = 0; i < n; ++i)
            build_neighbor_list(i, c, position.data(), cell_start.data(), list_start.data(), list.data());
        for (uint i = 0; i < n; ++i)
            sum_neighborhood(i, c, position.data(), velocity.data(), list_start.data(), list.data(), nullptr,
                             density.data(), factor.data(), wall_rate.data(), rate.data(), viscous.data());
        // A few particles take no part, and on one side none does.
        for (uint i = 0; i < n; ++i)
            weight[i] = factor[i].w > 0.0f && i % 11u != 0u && position[i].x < 0.2f ? position[i].w : 0.0f;
    }

    // K u with the kernels of the solve, as if G u were the velocity; no excess.
    std::vector<float> apply(const std::vector<float>& u) {
        const std::vector<float> excess(u.size(), 0.0f);
        std::vector<float> result(u.size());
        for (uint i = 0; i < c.particle_count; ++i)
            pressure_gradient(i, c, u.data(), list_start.data(), list.data(), position.data(), factor.data(),
                              gradient.data());
        for (uint i = 0; i < c.particle_count; ++i)
            pressure_residual(i, c, gradient.data(), list_start.data(), list.data(), position.data(), factor.data(),
                              excess.data(), result.data());
        return result;
    }

    uint coarse_of(const CoarseLevel& level, uint shift, uint i) const {
        const CellCoordinates cell = cell_of(c, position[i]);
        return coarse_index(level, cell.x >> shift, cell.y >> shift, cell.z >> shift);
    }
};

// Column `to` of P^T K P on a level whose cells are 2^shift cells of the grid wide.
std::vector<double> dense_column(Fluid& fluid, const CoarseLevel& level, uint shift, uint to) {
    std::vector<float> u(fluid.c.particle_count, 0.0f);
    for (uint i = 0; i < u.size(); ++i)
        if (fluid.weight[i] > 0.0f && fluid.coarse_of(level, shift, i) == to) u[i] = 1.0f;
    const std::vector<float> k_u = fluid.apply(u);
    std::vector<double> column(coarse_count(level), 0.0);
    for (uint i = 0; i < u.size(); ++i)
        if (fluid.weight[i] > 0.0f) column[fluid.coarse_of(level, shift, i)] += static_cast<double>(k_u[i]);
    return column;
}

void check_level(Fluid& fluid, const CoarseLevel& level, uint shift, const std::vector<float>& kept) {
    const uint count = coarse_count(level);
    std::vector<std::vector<double>> matrix(count, std::vector<double>(count, 0.0));
    for (uint from = 0; from < count; ++from)
        for (uint s = 0; s < COARSE_STENCIL; ++s)
            matrix[from][coarse_neighbor(level, coarse_cell(level, from), s)] +=
                static_cast<double>(coarse_entry(level, kept.data(), coarse_cell(level, from), from, s));
    double largest = 0.0, worst = 0.0;
    for (uint to = 0; to < count; ++to) {
        const std::vector<double> column = dense_column(fluid, level, shift, to);
        for (uint from = 0; from < count; ++from) {
            largest = std::max(largest, std::abs(column[from]));
            worst = std::max(worst, std::abs(matrix[from][to] - column[from]));
        }
    }
    CHECK(largest > 0.0);
    CHECK(worst < 3e-4 * largest);  // a ten thousandth is added to the diagonal
}

// A trace of the neighbours' pull would do as a diagonal, and what is divided by it would be beyond measure.
void nobody_makes_a_row_of_zeros(const Fluid& fluid, const CoarseLevel& level, const std::vector<float>& kept) {
    std::vector<bool> takes_part(coarse_count(level), false), is_filled(coarse_count(level), false);
    for (uint i = 0; i < fluid.c.particle_count; ++i) {
        is_filled[fluid.coarse_of(level, 1, i)] = true;
        if (fluid.weight[i] > 0.0f) takes_part[fluid.coarse_of(level, 1, i)] = true;
    }
    uint found = 0;
    for (uint k = 0; k < coarse_count(level); ++k)
        if (is_filled[k] && !takes_part[k]) {
            ++found;
            CHECK(coarse_diagonal(kept.data(), k) == 0.0f);
        }
    CHECK(found > 0);
}

void matrices_are_galerkins() {
    Fluid fluid;
    CHECK(fluid.c.particle_count > 500);
    std::vector<float> table((fluid.c.particle_count / COARSE_LEAST + 1) * COARSE_TABLE, 0.0f);
    const uint cell_count = k_side * k_side * k_side;
    for (uint cell = 0; cell < cell_count; ++cell)
        coarse_products(cell, fluid.c, cell_count, fluid.cell_start.data(), fluid.position.data(), fluid.factor.data(),
                        fluid.weight.data(), fluid.list_start.data(), fluid.list.data(), table.data());

    const CoarseLevel fine = level_of(2, 2, 2), coarse = level_of(1, 1, 1);
    std::vector<float> fine_matrix(coarse_count(fine) * COARSE_ROW), next_matrix(coarse_count(coarse) * COARSE_ROW);
    for (uint k = 0; k < coarse_count(fine); ++k)
        coarse_matrix(k, fluid.c, fine, fluid.cell_start.data(), table.data(), fine_matrix.data());
    check_level(fluid, fine, 1, fine_matrix);
    nobody_makes_a_row_of_zeros(fluid, fine, fine_matrix);
    for (uint k = 0; k < coarse_count(coarse); ++k)
        coarser_matrix(k, fine, coarse, fine_matrix.data(), next_matrix.data());
    check_level(fluid, coarse, 2, next_matrix);
}

}  // namespace

int main() {
    matrices_are_galerkins();
    if (failed_checks) return EXIT_FAILURE;
    std::puts("coarse matrices are Galerkin's");
    return EXIT_SUCCESS;
}
