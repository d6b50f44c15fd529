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

// 1 for the one of the 8 coarse cells around a particle in `home` that a neighbour in `place` is in, 0 for the others.
typedef struct CoarseShares {
    REAL of[8];
} CoarseShares;

FN CoarseShares coarse_shares(float4 home, Real3 place) {
    const REAL one = REAL_ZERO + 1.0f;
    const REAL x = place.x != home.x ? one : REAL_ZERO, y = place.y != home.y ? one : REAL_ZERO,
               z = place.z != home.z ? one : REAL_ZERO;
    CoarseShares shares;
    shares.of[0] = (one - x) * (one - y);
    shares.of[1] = x * (one - y);
    shares.of[2] = (one - x) * y;
    shares.of[3] = x * y;
    for (uint k = 0u; k < 4u; ++k) {
        shares.of[k + 4u] = shares.of[k] * z;
        shares.of[k] = shares.of[k] * (one - z);
    }
    return shares;
}

// What a neighbour adds to G of a constant; weight: m_j times c.gradient_scale where it takes part, else 0.
FN Real3 coarse_pull(const StepConstants c, REAL weight, Pair pair) {
    return add_gradient(zero_vector(), c, weight, pair);
}

// By multiplication, so that a cell with nothing to add gets exactly nothing: its row must be one of zeros.
FN CoarseSums add_shared(CoarseSums sums, REAL pull, CoarseShares shares) {
    for (uint k = 0u; k < 8u; ++k) sums.of[k] += shares.of[k] * pull;
    return sums;
}

FN CoarseGradient add_coarse_gradient(CoarseGradient sums, Real3 pull, CoarseShares shares) {
    sums.x = add_shared(sums.x, pull.x, shares);
    sums.y = add_shared(sums.y, pull.y, shares);
    sums.z = add_shared(sums.z, pull.z, shares);
    return sums;
}

#endif
