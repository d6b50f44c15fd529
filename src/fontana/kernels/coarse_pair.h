// What one neighbour adds to the columns of G P (coarse.h), in terms of REAL.
#ifndef FONTANA_COARSE_PAIR_H
#define FONTANA_COARSE_PAIR_H

#include "pair.h"

// One number for each of the 8 coarse cells around a particle. Its own comes first; bit 0 stands for the next one along
// x, on the side where the particle's cell is, bits 1 and 2 for y, z.
typedef struct CoarseSums {
    REAL of[8];
} CoarseSums;

// What G makes at one particle of a unit of pressure in each of them.
typedef struct CoarseGradient {
    CoarseSums x, y, z;
} CoarseGradient;

FN CoarseGradient no_coarse_gradient(void) {
    CoarseGradient none;
    for (uint k = 0u; k < 8u; ++k) none.x.of[k] = none.y.of[k] = none.z.of[k] = REAL_ZERO;
    return none;
}

// Which coarse cell a position is in, in whole numbers: a particle's own, and that of a neighbour.
FN float4 home_place(const StepConstants c, float4 x) {
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

// 1 where a neighbour in the coarse cell `place` is in another one than `home` along all the axes of bits k, else 0.
typedef struct CoarseSides {
    REAL is_beyond[8];
} CoarseSides;

FN CoarseSides coarse_sides(float4 home, Real3 place) {
    const REAL one = REAL_ZERO + 1.0f;
    CoarseSides sides;
    sides.is_beyond[0] = one;
    sides.is_beyond[1] = place.x != home.x ? one : REAL_ZERO;
    sides.is_beyond[2] = place.y != home.y ? one : REAL_ZERO;
    sides.is_beyond[3] = sides.is_beyond[1] * sides.is_beyond[2];
    sides.is_beyond[4] = place.z != home.z ? one : REAL_ZERO;
    for (uint k = 5u; k < 8u; ++k) sides.is_beyond[k] = sides.is_beyond[4] * sides.is_beyond[k - 4u];
    return sides;
}

// What a neighbour adds to G of a constant; weight: m_j times c.gradient_scale where it takes part, else 0.
FN Real3 coarse_pull(const StepConstants c, REAL weight, Pair pair) {
    return add_gradient(zero_vector(), c, weight, pair);
}

// Sums, for now, over all neighbours that are beyond along the axes of bits k, whether or not along others.
FN CoarseSums add_beyond(CoarseSums sums, REAL pull, CoarseSides sides) {
    sums.of[0] += pull;
    for (uint k = 1u; k < 8u; ++k) sums.of[k] += sides.is_beyond[k] * pull;
    return sums;
}

FN CoarseGradient add_coarse_gradient(CoarseGradient sums, Real3 pull, CoarseSides sides) {
    sums.x = add_beyond(sums.x, pull.x, sides);
    sums.y = add_beyond(sums.y, pull.y, sides);
    sums.z = add_beyond(sums.z, pull.z, sides);
    return sums;
}

// From those sums to the coarse cells.
FN CoarseSums apart(CoarseSums sums) {
    for (uint bit = 1u; bit < 8u; bit *= 2u)
        for (uint k = 0u; k < 8u; ++k)
            if ((k & bit) == 0u) sums.of[k] -= sums.of[k + bit];
    return sums;
}

FN CoarseGradient coarse_cells_of(CoarseGradient sums) {
    sums.x = apart(sums.x);
    sums.y = apart(sums.y);
    sums.z = apart(sums.z);
    return sums;
}

#endif
