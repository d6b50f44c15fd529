// What one neighbour adds to a particle: the formulas inside every loop of the production methods. In terms of REAL, so
// that a backend can take several neighbours at once. Sums of gradients lack c.gradient_scale once for each factor
// grad W; with it and weights in kg they are sums over V_j = m_j / rest density.
#ifndef FONTANA_PAIR_H
#define FONTANA_PAIR_H

#include "spline.h"

typedef struct Pair {
    REAL dx, dy, dz;  // x_ij, m
    REAL r_squared;   // m^2
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

// The last summand makes x_ij / r zero, not NaN, for the particle itself and for coincident ones.
FN Pair difference_of(float4 x_i, REAL4 x_j) {
    Pair pair;
    pair.dx = x_i.x - x_j.x;
    pair.dy = x_i.y - x_j.y;
    pair.dz = x_i.z - x_j.z;
    pair.r_squared = pair.dx * pair.dx + (pair.dy * pair.dy + (pair.dz * pair.dz + 1.0e-24f));
    return pair;
}

FN Pair with_length(Pair pair, REAL inverse_r) {
    pair.inverse_r = inverse_r;
    pair.r = pair.r_squared * inverse_r;
    return pair;
}

FN Pair pair_of(float4 x_i, REAL4 x_j) {
    const Pair pair = difference_of(x_i, x_j);
    return with_length(pair, INVERSE_SQRT(pair.r_squared));
}

// With a length as near as is quick, for G and its transpose: as both take the same, K stays symmetric.
FN Pair quick_pair_of(float4 x_i, REAL4 x_j) {
    const Pair pair = difference_of(x_i, x_j);
    return with_length(pair, QUICK_INVERSE_SQRT(pair.r_squared));
}

FN Real3 add_along(Real3 sum, REAL weight, Pair pair) {
    sum.x += weight * pair.dx;
    sum.y += weight * pair.dy;
    sum.z += weight * pair.dz;
    return sum;
}

// sum + weight grad W_ij
FN Real3 add_gradient(Real3 sum, const StepConstants c, REAL weight, Pair pair) {
    return add_along(sum, weight * kernel_gradient(c, pair.r, pair.inverse_r), pair);
}

// m_j grad W_ij . a_j
FN REAL divergence_term(const StepConstants c, REAL mass, Pair pair, REAL4 a_j) {
    return mass * kernel_gradient(c, pair.r, pair.inverse_r) * (pair.dx * a_j.x + pair.dy * a_j.y + pair.dz * a_j.z);
}

// What one visit to every neighbour adds up.
typedef struct NeighborhoodSums {
    REAL density;    // sum m_j W_ij
    Real3 gradient;  // sum m_j grad W_ij
    REAL squares;    // sum m_j |grad W_ij|^2
    REAL flow;       // sum m_j grad W_ij . v_j
    // sum m_j (v_ij . x_ij) / (r^2 + 0.01 H^2) grad W_ij, of the viscosity of Monaghan (2005)
    Real3 shear;
} NeighborhoodSums;

FN NeighborhoodSums no_neighborhood(void) {
    NeighborhoodSums zero;
    zero.density = zero.squares = zero.flow = REAL_ZERO;
    zero.gradient = zero.shear = zero_vector();
    return zero;
}

FN NeighborhoodSums add_neighbor(NeighborhoodSums sums, const StepConstants c, REAL mass, Pair pair, float4 v_i,
                                 REAL4 v_j) {
    const REAL slope = kernel_gradient(c, pair.r, pair.inverse_r), g = mass * slope;
    const REAL along_j = pair.dx * v_j.x + pair.dy * v_j.y + pair.dz * v_j.z;
    const REAL along_i = pair.dx * v_i.x + pair.dy * v_i.y + pair.dz * v_i.z;
    sums.density += mass * kernel_value(c, pair.r);
    sums.gradient = add_along(sums.gradient, g, pair);
    sums.squares += g * slope * pair.r_squared;
    sums.flow += g * along_j;
    const REAL inverse = INVERSE_SQRT(pair.r_squared + 0.01f * c.support_radius_squared);
    sums.shear = add_along(sums.shear, g * (along_i - along_j) * (inverse * inverse), pair);
    return sums;
}

#endif
