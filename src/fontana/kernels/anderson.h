// What one particle adds to the sums of an Anderson step (Walker and Ni 2011, depth 2): f the Jacobi step of this
// iteration, f_1 and f_2 of the one and two before; inner products are weighted by the diagonal D. In terms of REAL, so
// that a backend can take several lanes at once.
#ifndef FONTANA_ANDERSON_H
#define FONTANA_ANDERSON_H

#include "dialect.h"

#define SOLVE_SUMS 6u

// residual, and with d0 = f_1 - f_2 and d1 = f - f_1: <d0, d0>, <d0, d1>, <d1, d1>, <d0, f>, <d1, f>
typedef struct SolveSums {
    REAL residual, m00, m01, m11, y0, y1;
} SolveSums;

FN SolveSums zero_sums(void) {
    SolveSums zero;
    zero.residual = zero.m00 = zero.m01 = zero.m11 = zero.y0 = zero.y1 = REAL_ZERO;
    return zero;
}

// f = max(0, u + omega (r / D + z)) - u, with z the coarse correction (coarse.h) or nothing.
FN REAL relaxed_step(float relaxation, REAL inverse_diagonal, REAL r, REAL z, REAL u) {
    const REAL next = u + relaxation * (inverse_diagonal * r + z);
    return inverse_diagonal > REAL_ZERO ? (next < REAL_ZERO ? REAL_ZERO : next) - u : -u;
}

// What of r is a fault: too little pressure, or too much where there is some.
FN REAL two_sided(REAL residual, REAL u) {
    return residual > REAL_ZERO ? residual : u > REAL_ZERO ? -residual : REAL_ZERO;
}

// Where 1 / D is 0 no pressure acts and the steps are 0: the floor only keeps the weight finite.
FN SolveSums add_to_sums(SolveSums s, REAL inverse_diagonal, REAL residual, REAL u, REAL f, REAL f_1, REAL f_2) {
    const REAL weight = 1.0f / max_f(inverse_diagonal, 1.0e-30f), d0 = f_1 - f_2, d1 = f - f_1;
    s.residual += two_sided(residual, u);
    s.m00 += weight * d0 * d0;
    s.m01 += weight * d0 * d1;
    s.m11 += weight * d1 * d1;
    s.y0 += weight * d0 * f;
    s.y1 += weight * d1 * f;
    return s;
}

#endif
