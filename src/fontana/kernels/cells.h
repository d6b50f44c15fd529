// The grid, without bounds: cell coordinates wrap around a box of cells whose size follows the particle count. Where
// the fluid is wider than the box, distant cells share a key; their particles fail the distance test, so the answer is
// exact and a stray particle a kilometre away costs no memory. Keys have x in the low bits (eq. 3.1 with powers of
// two), so neighbouring cells of a row are one range of sorted particles.
#ifndef FONTANA_CELLS_H
#define FONTANA_CELLS_H

#include "step_constants.h"

typedef struct CellCoordinates {
    uint x, y, z;
} CellCoordinates;

typedef struct Range {
    uint begin, end;
} Range;

// The clamp keeps the conversion to int defined for any float, NaN too; cells beyond it share the last one.
FN uint cell_coordinate(float position, float inverse_cell_size, uint mask) {
    const float cell = FLOOR(position * inverse_cell_size);
    return (uint)(int)max_f(min_f(cell, 1.0e9f), -1.0e9f) & mask;
}

FN CellCoordinates cell_of(const StepConstants c, float4 position) {
    CellCoordinates cell;
    cell.x = cell_coordinate(position.x, c.inverse_cell_size, c.grid_mask_x);
    cell.y = cell_coordinate(position.y, c.inverse_cell_size, c.grid_mask_y);
    cell.z = cell_coordinate(position.z, c.inverse_cell_size, c.grid_mask_z);
    return cell;
}

FN uint cell_key(const StepConstants c, CellCoordinates cell) {
    return cell.x | (cell.y << c.grid_shift_y) | (cell.z << c.grid_shift_z);
}

// The candidates for neighbours of a particle in `cell` come as ranges of sorted particles: one per row of three cells,
// nine rows; a row that wraps around the end of the box takes a second one. With all pairs there is one range: all.
FN uint candidate_range_count(const StepConstants c, CellCoordinates cell) {
    if (!c.use_grid) return 1u;
    return cell.x == 0u || cell.x == c.grid_mask_x ? 18u : 9u;
}

FN Range candidate_range(const StepConstants c, CellCoordinates cell, uint index,
                         GLOBAL const uint* RESTRICT cell_start) {
    Range range;
    if (!c.use_grid) {
        range.begin = 0u;
        range.end = c.particle_count;
        return range;
    }
    const uint row_index = index % 9u;
    const uint y = (cell.y + row_index % 3u + c.grid_mask_y) & c.grid_mask_y;
    const uint z = (cell.z + row_index / 3u + c.grid_mask_z) & c.grid_mask_z;
    const uint row = (y << c.grid_shift_y) | (z << c.grid_shift_z);
    uint first = cell.x == 0u ? 0u : cell.x - 1u;
    uint last = cell.x == c.grid_mask_x ? cell.x : cell.x + 1u;
    if (index >= 9u) first = last = (cell.x == 0u ? c.grid_mask_x : 0u);
    range.begin = cell_start[row + first];
    range.end = cell_start[row + last + 1u];
    return range;
}

KERNEL void assign_cells(THREAD_ARG const StepConstants c, GLOBAL const float4* RESTRICT position,
                         GLOBAL uint* RESTRICT key) {
    const uint i = THREAD_INDEX;
    if (i >= c.particle_count) return;
    key[i] = cell_key(c, cell_of(c, position[i]));
}

#endif
