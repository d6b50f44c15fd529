// What one neighbour adds to a particle: the formulas inside every loop of the production methods. In terms of REAL, so
// that a backend can take several neighbours at once.
#ifndef FONTANA_PAIR_H
#define FONTANA_PAIR_H

#include "spline.h"

typedef struct Pair {
    REAL dx, dy, dz;  // x_ij, m
    REAL r;           // m
    REAL inverse_r;   // 1/m
} Pair;

typedef struct Real3 {
    REAL x, y, z;
} Real3;

FN Real3 zero_vector(void) {
    Real3 zero;
    zero.x = zero.y = zero.z = REAL_ZERO;
    return zero;
}

// The floor makes x_ij / r zero, not NaN, for the particle itself and for coincident ones.
FN Pair pair_of(float4 x_i, REAL4 x_j) {
    Pair pair;
    pair.dx = x_i.x - x_j.x;
    pair.dy = x_i.y - x_j.y;
    pair.dz = x_i.z - x_j.z;
    const REAL r_squared = max_f(pair.dx * pair.dx + pair.dy * pair.dy + pair.dz * pair.dz, 1.0e-24f);
    pair.inverse_r = INVERSE_SQRT(r_squared);
    pair.r = r_squared * pair.inverse_r;
    return pair;
}

// sum + weight grad W_ij
FN Real3 add_gradient(Real3 sum, const StepConstants c, REAL weight, Pair pair) {
    const REAL g = weight * kernel_gradient(c, pair.r, pair.inverse_r);
    sum.x += g * pair.dx;
    sum.y += g * pair.dy;
    sum.z += g * pair.dz;
    return sum;
}

// V_j grad W_ij . a_j
FN REAL divergence_term(const StepConstants c, REAL volume, Pair pair, REAL4 a_j) {
    return volume * kernel_gradient(c, pair.r, pair.inverse_r) * (pair.dx * a_j.x + pair.dy * a_j.y + pair.dz * a_j.z);
}

// V_j |grad W_ij|^2
FN REAL gradient_squared_term(const StepConstants c, REAL volume, Pair pair) {
    const REAL g = kernel_gradient(c, pair.r, pair.inverse_r) * pair.r;
    return volume * g * g;
}

// V_j (v_ij . x_ij) / (r^2 + 0.01 H^2): the weight of grad W_ij in the viscosity of Monaghan (2005)
FN REAL viscosity_weight(const StepConstants c, REAL volume, Pair pair, float4 v_i, REAL4 v_j) {
    const REAL approach = (v_i.x - v_j.x) * pair.dx + (v_i.y - v_j.y) * pair.dy + (v_i.z - v_j.z) * pair.dz;
    return volume * approach / (pair.r * pair.r + 0.01f * c.support_radius_squared);
}

#endif
