// What one neighbour adds to the columns of G P (coarse.h), in terms of REAL.
#ifndef FONTANA_COARSE_PAIR_H
#define FONTANA_COARSE_PAIR_H

#include "pair.h"

// What G makes, without c.gradient_scale, at one particle, of a unit of pressure in each of the 8 coarse cells around
// it. Its own coarse cell comes first; bit 0 stands for the next one along x, on the side where the particle's cell is,
// bits 1 and 2 for y, z.
typedef struct CoarseGradient {
    REAL x[8], y[8], z[8];
} CoarseGradient;

FN CoarseGradient no_coarse_gradient(void) {
    CoarseGradient none;
    for (uint k = 0u; k < 8u; ++k) none.x[k] = none.y[k] = none.z[k] = REAL_ZERO;
    return none;
}

// Which coarse cell a position is in, as whole numbers.
FN float4 coarse_home(const StepConstants c, float4 x) {
    const float per_metre = 0.5f * c.inverse_cell_size;
    return MAKE_FLOAT4(FLOOR(x.x * per_metre), FLOOR(x.y * per_metre), FLOOR(x.z * per_metre), 0.0f);
}

FN Real3 coarse_place(const StepConstants c, REAL4 x) {
    const float per_metre = 0.5f * c.inverse_cell_size;
    Real3 place;
    place.x = REAL_FLOOR(x.x * per_metre);
    place.y = REAL_FLOOR(x.y * per_metre);
    place.z = REAL_FLOOR(x.z * per_metre);
    return place;
}

// weight: m_j where the neighbour takes part, else 0; home: of the particle, place: of the neighbour.
FN CoarseGradient add_coarse_gradient(CoarseGradient a, const StepConstants c, REAL weight, Pair pair, float4 home,
                                      Real3 place) {
    const REAL g = weight * kernel_gradient(c, pair.r, pair.inverse_r), one = REAL_ZERO + 1.0f;
    const REAL gx = g * pair.dx, gy = g * pair.dy, gz = g * pair.dz;
    const REAL octant = (place.x != home.x ? one : REAL_ZERO) + (place.y != home.y ? 2.0f * one : REAL_ZERO) +
                        (place.z != home.z ? 4.0f * one : REAL_ZERO);
    for (uint k = 0u; k < 8u; ++k) {  // all eight: a GPU keeps an array in registers if its indices are known
        const REAL number = REAL_ZERO + (float)k;
        a.x[k] += octant == number ? gx : REAL_ZERO;
        a.y[k] += octant == number ? gy : REAL_ZERO;
        a.z[k] += octant == number ? gz : REAL_ZERO;
    }
    return a;
}

#endif
