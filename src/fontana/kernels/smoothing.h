// Smoothing kernels of Mueller et al. 2003, eqs. 2.14 to 2.16 of the thesis, with H the support radius. The constant
// factor of each (step_constants.h) is left to the caller, who takes it out of the sum over neighbours.
// Arguments never exceed H: the neighbour loop has tested it.
#ifndef FONTANA_SMOOTHING_H
#define FONTANA_SMOOTHING_H

#include "dialect.h"

// W_poly6 = 315 / (64 pi H^9) (H^2 - r^2)^3
FN REAL poly6(REAL r_squared, float support_squared) {
    const REAL t = support_squared - r_squared;
    return t * t * t;
}

// grad W_poly6 = -945 / (32 pi H^9) (H^2 - r^2)^2 x_ij: the factor on x_ij
FN REAL poly6_gradient(REAL r_squared, float support_squared) {
    const REAL t = support_squared - r_squared;
    return t * t;
}

// lap W_poly6 = -945 / (32 pi H^9) (H^2 - r^2) (3 H^2 - 7 r^2)
FN REAL poly6_laplacian(REAL r_squared, float support_squared) {
    return (support_squared - r_squared) * (3.0f * support_squared - 7.0f * r_squared);
}

// W_spiky = 15 / (pi H^6) (H - r)^3
FN REAL spiky(REAL r, float support) {
    const REAL t = support - r;
    return t * t * t;
}

// grad W_spiky = -45 / (pi H^6) (H - r)^2 x_ij / r: the factor on x_ij / r
FN REAL spiky_gradient(REAL r, float support) {
    const REAL t = support - r;
    return t * t;
}

// W_viscosity = 15 / (2 pi H^3) (-r^3 / 2H^3 + r^2 / H^2 + H / 2r - 1), for r > 0
FN REAL viscosity_kernel(REAL r, float support) {
    const REAL q = r / support;
    return -0.5f * q * q * q + q * q + 0.5f / q - 1.0f;
}

// lap W_viscosity = 45 / (pi H^6) (H - r)
FN REAL viscosity_laplacian(REAL r, float support) { return support - r; }

#endif
