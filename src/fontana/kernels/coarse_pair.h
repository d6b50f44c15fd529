// What one neighbour adds to the columns of G P (coarse.h), in terms of REAL.
#ifndef FONTANA_COARSE_PAIR_H
#define FONTANA_COARSE_PAIR_H

#include "pair.h"

// What G makes, at one particle, of a unit of pressure in each of the 8 coarse cells around it. Its own coarse cell
// comes first; bit 0 stands for the next one along x, on the side where the particle's cell is, bits 1 and 2 for y, z.
typedef struct CoarseGradient {
    REAL x[8], y[8], z[8];
} CoarseGradient;

FN CoarseGradient no_coarse_gradient(void) {
    CoarseGradient none;
    for (uint k = 0u; k < 8u; ++k) none.x[k] = none.y[k] = none.z[k] = REAL_ZERO;
    return none;
}

// weight: V_j where the neighbour takes part, else 0.
FN CoarseGradient add_coarse_gradient(CoarseGradient a, const StepConstants c, REAL weight, float4 x_i, REAL4 x_j) {
    const Pair pair = pair_of(x_i, x_j);
    const REAL g = weight * kernel_gradient(c, pair.r, pair.inverse_r), one = REAL_ZERO + 1.0f;
    const REAL gx = g * pair.dx, gy = g * pair.dy, gz = g * pair.dz;
    const float per_metre = 0.5f * c.inverse_cell_size;
    const float home_x = FLOOR(x_i.x * per_metre), home_y = FLOOR(x_i.y * per_metre), home_z = FLOOR(x_i.z * per_metre);
    const REAL octant = (REAL_FLOOR(x_j.x * per_metre) != home_x ? one : REAL_ZERO) +
                        (REAL_FLOOR(x_j.y * per_metre) != home_y ? 2.0f * one : REAL_ZERO) +
                        (REAL_FLOOR(x_j.z * per_metre) != home_z ? 4.0f * one : REAL_ZERO);
    for (uint k = 0u; k < 8u; ++k) {  // all eight: a GPU keeps an array in registers if its indices are known
        const REAL number = REAL_ZERO + (float)k;
        a.x[k] += octant == number ? gx : REAL_ZERO;
        a.y[k] += octant == number ? gy : REAL_ZERO;
        a.z[k] += octant == number ? gz : REAL_ZERO;
    }
    return a;
}

#endif
