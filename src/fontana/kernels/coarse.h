// The coarse correction of the pressure solve: what relaxation is slow at, pressure over long distances, found on a few
// unknowns. They are one a coarse cell of 2 x 2 x 2 cells of the grid (piecewise constant aggregation), with the
// matrix P^T K P that makes of K = G^T G (Galerkin); then coarser levels, merged two by two along each axis down to
// 2 x 2 x 2 unknowns, and a V-cycle over them with damped Jacobi (as in Trottenberg, Oosterlee and Schueller 2001).
//
// Only particles where pressure acts or is called for take part, and only cells with at least COARSE_LEAST particles:
// then the table of a cell has its place by the index of its first particle, and memory follows the particles. What
// thinner cells would add to the matrix is missing from it; Anderson's acceleration around the cycle forgives that.
#ifndef FONTANA_COARSE_H
#define FONTANA_COARSE_H

#include "coarse_pair.h"
#include "incompressible.h"

#define COARSE_LEAST 4u     // of the 8 particles that a full cell has
#define COARSE_TABLE 36u    // products of the 8 coarse unknowns that one cell's particles feel, symmetric
#define COARSE_STENCIL 27u  // a coarse cell and its neighbours; slot (x+1) + 3 (y+1) + 9 (z+1)
#define COARSE_CENTRE 13u
#define COARSE_ROW 14u  // entries that are kept: the matrix is symmetric, so those from the centre on will do
#define COARSE_SMOOTHING 0.6f
#define COARSE_STRETCH 1.5f  // piecewise constants are too stiff; over-correction makes up for it (Braess 1995)
#define COARSE_BOTTOM_SWEEPS 8u

// A level's box of cells, which wraps around as that of the grid does.
typedef struct CoarseLevel {
    uint mask_x, mask_y, mask_z;
    uint shift_y, shift_z;
} CoarseLevel;

FN uint coarse_index(const CoarseLevel level, uint x, uint y, uint z) {
    return (x & level.mask_x) | (y & level.mask_y) << level.shift_y | (z & level.mask_z) << level.shift_z;
}

FN uint coarse_count(const CoarseLevel level) {
    return coarse_index(level, level.mask_x, level.mask_y, level.mask_z) + 1u;
}

FN CellCoordinates coarse_cell(const CoarseLevel level, uint index) {
    CellCoordinates cell;
    cell.x = index & level.mask_x;
    cell.y = index >> level.shift_y & level.mask_y;
    cell.z = index >> level.shift_z & level.mask_z;
    return cell;
}

// The cell of a slot of the stencil around `cell`.
FN uint coarse_neighbor(const CoarseLevel level, CellCoordinates cell, uint slot) {
    return coarse_index(level, cell.x + slot % 3u - 1u, cell.y + slot / 3u % 3u - 1u, cell.z + slot / 9u - 1u);
}

FN float coarse_diagonal(GLOBAL const float* RESTRICT matrix, uint index) { return matrix[index * COARSE_ROW]; }

// The entry of a slot in the row of `cell`, the cell numbered `index`.
FN float coarse_entry(const CoarseLevel level, GLOBAL const float* RESTRICT matrix, CellCoordinates cell, uint index,
                      uint slot) {
    if (slot >= COARSE_CENTRE) return matrix[index * COARSE_ROW + slot - COARSE_CENTRE];
    return matrix[coarse_neighbor(level, cell, slot) * COARSE_ROW + COARSE_CENTRE - slot];
}

// Adds to the row's entry of a slot, if it is kept.
FN void add_coarse_entry(GLOBAL float* RESTRICT row, uint slot, float value) {
    if (slot >= COARSE_CENTRE) row[slot - COARSE_CENTRE] += value;
}

// The mass where the particle takes part, else 0.
KERNEL void coarse_weights(THREAD_ARG const uint count, GLOBAL const float4* RESTRICT position,
                           GLOBAL const float4* RESTRICT factor, GLOBAL const float* RESTRICT residual,
                           GLOBAL const float* RESTRICT u, GLOBAL float* RESTRICT weight) {
    const uint i = THREAD_INDEX;
    if (i >= count) return;
    weight[i] = factor[i].w > 0.0f && (u[i] > 0.0f || residual[i] > 0.0f) ? position[i].w : 0.0f;
}

// The columns of G P at one particle (coarse_pair.h).
FN CoarseGradient coarse_gradient(const StepConstants c, uint i, GLOBAL const float4* RESTRICT position,
                                  GLOBAL const float4* RESTRICT factor, GLOBAL const float* RESTRICT weight,
                                  GLOBAL const uint* RESTRICT list_start, GLOBAL const short* RESTRICT list) {
    const float4 x_i = position[i], home = home_place(c, x_i);
    CoarseGradient a = no_coarse_gradient();
    for (Walk walk = first_neighbor(c, i, list_start, list); walk.is_there; walk = next_neighbor(c, walk, list)) {
        const uint j = walk.j;
        const float4 x_j = position[j];
        const CoarseShares shares = coarse_shares(home, coarse_place(c, x_j));
        a = add_coarse_gradient(a, coarse_pull(c, c.gradient_scale * weight[j], quick_pair_of(x_i, x_j)), shares);
    }
    if (weight[i] > 0.0f) {
        const float4 s = factor[i];
        a.x.of[0] += s.x;
        a.y.of[0] += s.y;
        a.z.of[0] += s.z;
    }
    return a;
}

// One thread a cell of the grid: the products of the columns of G P that its particles feel, summed over them.
KERNEL void coarse_products(THREAD_ARG const StepConstants c, const uint cell_count,
                            GLOBAL const uint* RESTRICT cell_start, GLOBAL const float4* RESTRICT position,
                            GLOBAL const float4* RESTRICT factor, GLOBAL const float* RESTRICT weight,
                            GLOBAL const uint* RESTRICT list_start, GLOBAL const short* RESTRICT list,
                            GLOBAL float* RESTRICT table) {
    const uint cell = THREAD_INDEX;
    if (cell >= cell_count) return;
    const uint begin = cell_start[cell], end = cell_start[cell + 1u];
    if (end - begin < COARSE_LEAST) return;
    GLOBAL float* RESTRICT sum = table + begin / COARSE_LEAST * COARSE_TABLE;
    for (uint k = 0u; k < COARSE_TABLE; ++k) sum[k] = 0.0f;
    for (uint i = begin; i < end; ++i) {
        const CoarseGradient a = coarse_gradient(c, i, position, factor, weight, list_start, list);
        uint k = 0u;
        for (uint p = 0u; p < 8u; ++p)
            for (uint q = p; q < 8u; ++q, ++k)
                sum[k] += a.x.of[p] * a.x.of[q] + a.y.of[p] * a.y.of[q] + a.z.of[p] * a.z.of[q];
    }
}

FN uint coarse_table_index(uint p, uint q) {
    const uint low = p < q ? p : q, high = p < q ? q : p;
    return low * 8u - low * (low + 1u) / 2u + high;
}

// The cell of the grid that stands x, y, z cells from the first one of a coarse cell.
FN uint coarse_grid_key(const StepConstants c, CellCoordinates home, int x, int y, int z) {
    CellCoordinates cell;
    cell.x = (2u * home.x + (uint)x) & c.grid_mask_x;
    cell.y = (2u * home.y + (uint)y) & c.grid_mask_y;
    cell.z = (2u * home.z + (uint)z) & c.grid_mask_z;
    return cell_key(c, cell);
}

// Whether any of its cells is of use; a coarse cell without has a row of zeros.
FN bool is_occupied(const StepConstants c, CellCoordinates home, GLOBAL const uint* RESTRICT cell_start) {
    for (int k = 0; k < 8; ++k) {
        const uint key = coarse_grid_key(c, home, k & 1, k >> 1 & 1, k >> 2);
        if (cell_start[key + 1u] - cell_start[key] >= COARSE_LEAST) return true;
    }
    return false;
}

// Along one axis, of a cell of the grid that stands -1 to 2 cells from a coarse cell's first one: the coarse cell it is
// in, and the other one its particles feel; -1, 0 or 1 from the coarse cell.
FN int coarse_home(int cell) { return cell < 0 ? -1 : cell / 2; }
FN int coarse_other(int cell) { return cell == 1 ? 1 : cell == 0 ? -1 : 0; }

// Adds the products of one cell's particles to a coarse cell's row of the matrix.
FN void add_products(GLOBAL float* RESTRICT row, GLOBAL const float* RESTRICT products, int x, int y, int z) {
    const uint p = (coarse_home(x) != 0 ? 1u : 0u) | (coarse_home(y) != 0 ? 2u : 0u) | (coarse_home(z) != 0 ? 4u : 0u);
    for (uint q = 0u; q < 8u; ++q) {
        const int to_x = q & 1u ? coarse_other(x) : coarse_home(x), to_y = q & 2u ? coarse_other(y) : coarse_home(y),
                  to_z = q & 4u ? coarse_other(z) : coarse_home(z);
        add_coarse_entry(row, (uint)(to_x + 1 + 3 * (to_y + 1) + 9 * (to_z + 1)), products[coarse_table_index(p, q)]);
    }
}

// The matrix of the finest coarse level. One thread a coarse cell: the 4 x 4 x 4 cells whose particles feel it.
KERNEL void coarse_matrix(THREAD_ARG const StepConstants c, const CoarseLevel level,
                          GLOBAL const uint* RESTRICT cell_start, GLOBAL const float* RESTRICT table,
                          GLOBAL float* RESTRICT matrix) {
    const uint index = THREAD_INDEX;
    if (index >= coarse_count(level)) return;
    GLOBAL float* RESTRICT row = matrix + index * COARSE_ROW;
    for (uint k = 0u; k < COARSE_ROW; ++k) row[k] = 0.0f;
    const CellCoordinates home = coarse_cell(level, index);
    if (!is_occupied(c, home, cell_start)) return;
    for (int z = -1; z <= 2; ++z)
        for (int y = -1; y <= 2; ++y)
            for (int x = -1; x <= 2; ++x) {
                const uint key = coarse_grid_key(c, home, x, y, z), begin = cell_start[key];
                if (cell_start[key + 1u] - begin >= COARSE_LEAST)
                    add_products(row, table + begin / COARSE_LEAST * COARSE_TABLE, x, y, z);
            }
    row[0] *= 1.0001f;
}

// How a level's cells come together in the next: along an axis two by two, or not at all.
typedef struct Merging {
    uint x, y, z;  // 1 or 0
} Merging;

FN Merging merging_of(const CoarseLevel child, const CoarseLevel level) {
    Merging merging;
    merging.x = child.mask_x != level.mask_x ? 1u : 0u;
    merging.y = child.mask_y != level.mask_y ? 1u : 0u;
    merging.z = child.mask_z != level.mask_z ? 1u : 0u;
    return merging;
}

FN uint child_count(Merging merging) { return 1u << (merging.x + merging.y + merging.z); }

// The k-th of them.
FN CellCoordinates child_cell(Merging merging, CellCoordinates home, uint k) {
    CellCoordinates cell;
    cell.x = (home.x << merging.x) + (k & merging.x);
    k >>= merging.x;
    cell.y = (home.y << merging.y) + (k & merging.y);
    k >>= merging.y;
    cell.z = (home.z << merging.z) + (k & merging.z);
    return cell;
}

// Where a neighbour of a child is in the parents' stencil along one axis (0 to 2): `side` 0 to 2 of the child's.
FN uint parent_side(uint child, uint merged, uint side) { return merged ? ((child & 1u) + side + 1u) >> 1u : side; }

// The same for the next level, from the one below.
KERNEL void coarser_matrix(THREAD_ARG const CoarseLevel child, const CoarseLevel level,
                           GLOBAL const float* RESTRICT child_matrix, GLOBAL float* RESTRICT matrix) {
    const uint index = THREAD_INDEX;
    if (index >= coarse_count(level)) return;
    GLOBAL float* RESTRICT row = matrix + index * COARSE_ROW;
    for (uint k = 0u; k < COARSE_ROW; ++k) row[k] = 0.0f;
    const CellCoordinates home = coarse_cell(level, index);
    const Merging merging = merging_of(child, level);
    for (uint k = 0u; k < child_count(merging); ++k) {
        const CellCoordinates cell = child_cell(merging, home, k);
        const uint from = coarse_index(child, cell.x, cell.y, cell.z);
        if (coarse_diagonal(child_matrix, from) == 0.0f) continue;
        for (uint slot = 0u; slot < COARSE_STENCIL; ++slot) {
            const uint to = parent_side(cell.x, merging.x, slot % 3u) +
                            3u * parent_side(cell.y, merging.y, slot / 3u % 3u) +
                            9u * parent_side(cell.z, merging.z, slot / 9u);
            add_coarse_entry(row, to, coarse_entry(child, child_matrix, cell, from, slot));
        }
    }
}

// Whether a particle takes part in this iteration. One that the matrix does not know must not: it would be corrected
// beyond measure.
FN bool is_pressed(float weight, float residual, float u) { return weight > 0.0f && (residual > 0.0f || u > 0.0f); }

// b, and the smoother's first step from zero, z = omega b / D.
FN void store_right_side(uint index, float sum, GLOBAL const float* RESTRICT matrix, GLOBAL float* RESTRICT b,
                         GLOBAL float* RESTRICT guess) {
    const float diagonal = coarse_diagonal(matrix, index);
    b[index] = sum;
    guess[index] = diagonal > 0.0f ? COARSE_SMOOTHING * sum / diagonal : 0.0f;
}

// b = P^T r. One thread a coarse cell.
KERNEL void coarse_restrict(THREAD_ARG const StepConstants c, const CoarseLevel level,
                            GLOBAL const uint* RESTRICT cell_start, GLOBAL const float* RESTRICT weight,
                            GLOBAL const float* RESTRICT residual, GLOBAL const float* RESTRICT u,
                            GLOBAL const float* RESTRICT matrix, GLOBAL float* RESTRICT b,
                            GLOBAL float* RESTRICT guess) {
    const uint index = THREAD_INDEX;
    if (index >= coarse_count(level)) return;
    const CellCoordinates home = coarse_cell(level, index);
    float sum = 0.0f;
    for (int k = 0; k < 8; ++k) {
        const uint key = coarse_grid_key(c, home, k & 1, k >> 1 & 1, k >> 2);
        const uint begin = cell_start[key], end = cell_start[key + 1u];
        if (end - begin < COARSE_LEAST) continue;
        for (uint i = begin; i < end; ++i)
            if (is_pressed(weight[i], residual[i], u[i])) sum += residual[i];
    }
    store_right_side(index, sum, matrix, b, guess);
}

// The matrix times v, at one cell.
FN float coarse_row_product(const CoarseLevel level, GLOBAL const float* RESTRICT matrix, CellCoordinates cell,
                            uint index, GLOBAL const float* v) {
    float sum = matrix[index * COARSE_ROW] * v[index];
    for (uint k = 1u; k < COARSE_ROW; ++k) {
        const uint ahead = coarse_neighbor(level, cell, COARSE_CENTRE + k),
                   behind = coarse_neighbor(level, cell, COARSE_CENTRE - k);
        sum += matrix[index * COARSE_ROW + k] * v[ahead] + matrix[behind * COARSE_ROW + k] * v[behind];
    }
    return sum;
}

// Down: what is left of b after the first step, summed into the next level's. One thread a cell of the next level.
KERNEL void coarse_down(THREAD_ARG const CoarseLevel child, const CoarseLevel level,
                        GLOBAL const float* RESTRICT child_matrix, GLOBAL const float* RESTRICT child_b,
                        GLOBAL const float* RESTRICT child_guess, GLOBAL const float* RESTRICT matrix,
                        GLOBAL float* RESTRICT b, GLOBAL float* RESTRICT guess) {
    const uint index = THREAD_INDEX;
    if (index >= coarse_count(level)) return;
    const CellCoordinates home = coarse_cell(level, index);
    const Merging merging = merging_of(child, level);
    float sum = 0.0f;
    for (uint k = 0u; k < child_count(merging); ++k) {
        const CellCoordinates cell = child_cell(merging, home, k);
        const uint from = coarse_index(child, cell.x, cell.y, cell.z);
        if (coarse_diagonal(child_matrix, from) == 0.0f) continue;
        sum += child_b[from];
        sum -= coarse_row_product(child, child_matrix, cell, from, child_guess);
    }
    store_right_side(index, sum, matrix, b, guess);
}

// The coarsest level, 2 x 2 x 2 unknowns: Gauss-Seidel, forwards and backwards. One thread.
KERNEL void coarse_bottom(THREAD_ARG const CoarseLevel level, GLOBAL const float* RESTRICT matrix,
                          GLOBAL const float* RESTRICT b, GLOBAL float* RESTRICT z) {
    if (THREAD_INDEX != 0u) return;
    const uint count = coarse_count(level);
    for (uint k = 0u; k < count; ++k) z[k] = 0.0f;
    for (uint sweep = 0u; sweep < 2u * COARSE_BOTTOM_SWEEPS; ++sweep)
        for (uint k = 0u; k < count; ++k) {
            const uint index = sweep % 2u == 0u ? k : count - 1u - k;
            const CellCoordinates cell = coarse_cell(level, index);
            const float diagonal = coarse_diagonal(matrix, index);
            const float left = b[index] - coarse_row_product(level, matrix, cell, index, z) + diagonal * z[index];
            z[index] = diagonal > 0.0f ? left / diagonal : 0.0f;
        }
}

// The first step and the next level's correction, at one cell.
FN float coarse_value(const CoarseLevel level, const CoarseLevel parent, GLOBAL const float* RESTRICT guess,
                      GLOBAL const float* RESTRICT parent_z, uint index) {
    const CellCoordinates cell = coarse_cell(level, index);
    const Merging merging = merging_of(level, parent);
    const uint above = coarse_index(parent, cell.x >> merging.x, cell.y >> merging.y, cell.z >> merging.z);
    return guess[index] + COARSE_STRETCH * parent_z[above];
}

// Up: that, smoothed once more.
KERNEL void coarse_up(THREAD_ARG const CoarseLevel level, const CoarseLevel parent, GLOBAL const float* RESTRICT matrix,
                      GLOBAL const float* RESTRICT b, GLOBAL const float* RESTRICT guess,
                      GLOBAL const float* RESTRICT parent_z, GLOBAL float* RESTRICT z) {
    const uint index = THREAD_INDEX;
    if (index >= coarse_count(level)) return;
    const float diagonal = coarse_diagonal(matrix, index);
    z[index] = 0.0f;
    if (diagonal <= 0.0f) return;
    const CellCoordinates cell = coarse_cell(level, index);
    const float own = coarse_value(level, parent, guess, parent_z, index);
    float left = b[index] - diagonal * own;
    for (uint k = 1u; k < COARSE_ROW; ++k) {
        const uint ahead = coarse_neighbor(level, cell, COARSE_CENTRE + k),
                   behind = coarse_neighbor(level, cell, COARSE_CENTRE - k);
        left -= matrix[index * COARSE_ROW + k] * coarse_value(level, parent, guess, parent_z, ahead) +
                matrix[behind * COARSE_ROW + k] * coarse_value(level, parent, guess, parent_z, behind);
    }
    z[index] = own + COARSE_SMOOTHING * left / diagonal;
}

// The correction of a particle.
FN float coarse_correction(const StepConstants c, const CoarseLevel level, float4 position,
                           GLOBAL const uint* RESTRICT cell_start, GLOBAL const float* RESTRICT z) {
    const CellCoordinates cell = cell_of(c, position);
    const uint key = cell_key(c, cell);
    if (cell_start[key + 1u] - cell_start[key] < COARSE_LEAST) return 0.0f;
    return z[coarse_index(level, cell.x >> 1u, cell.y >> 1u, cell.z >> 1u)];
}

#endif
