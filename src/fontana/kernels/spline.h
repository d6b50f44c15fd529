// The one smoothing kernel that the production methods use for density and gradient alike: cubic spline or Wendland C2
// (Dehnen and Aly 2012), with q = r / H and H the support radius. What they have in common is that the whole solve
// stays symmetric: the matrix of the pressure is made of the same gradient that the density changes by.
#ifndef FONTANA_SPLINE_H
#define FONTANA_SPLINE_H

#include "step_constants.h"

// W(r). Cubic: 8 / (pi H^3) (2 (1-q)^3 - 8 (1/2-q)^3, each power clamped at 0). Wendland: 21 / (2 pi H^3) (1-q)^4
// (1+4q).
FN REAL kernel_value(const StepConstants c, REAL r) {
    const REAL q = r * c.inverse_support_radius, a = max_f(1.0f - q, 0.0f);
    if (c.use_wendland) return c.kernel_scale * a * a * a * a * (1.0f + 4.0f * q);
    const REAL b = max_f(0.5f - q, 0.0f);
    return c.kernel_scale * (2.0f * a * a * a - 8.0f * b * b * b);
}

// The factor on x_ij of grad W, W'(r) / r, without its constant (c.gradient_scale), which the callers take out of their
// sums. Cubic: -48 / (pi H^4) times ((1-q)^2 - (1-2q)^2) / r, the second power clamped at 0 as the first. Wendland:
// -210 / (pi H^5) times (1-q)^3.
FN REAL kernel_gradient(const StepConstants c, REAL r, REAL inverse_r) {
    const REAL q = r * c.inverse_support_radius, a = max_f(1.0f - q, 0.0f);
    if (c.use_wendland) return a * a * a;
    const REAL b = max_f(1.0f - 2.0f * q, 0.0f);
    return (a * a - b * b) * inverse_r;
}

// W seen from a plane: the integral of W over the plane at distance z H, times H; its derivative by z; and the integral
// of it all beyond z, the share of W behind that plane. For z >= 0. Polynomials, from integrating W over discs.
FN REAL plane_share(const StepConstants c, REAL z) {
    const REAL a = max_f(1.0f - z, 0.0f), a2 = a * a;
    if (c.use_wendland) return a2 * a2 * a * (21.0f - 31.5f * a + 12.0f * a2);
    const REAL b = max_f(0.5f - z, 0.0f), b2 = b * b;
    return a2 * a2 * (8.0f - 6.4f * a) - b2 * b2 * (16.0f - 25.6f * b);
}

FN REAL plane_slope(const StepConstants c, REAL z) {
    const REAL a = max_f(1.0f - z, 0.0f), a2 = a * a;
    if (c.use_wendland) return -a2 * a2 * (105.0f - 189.0f * a + 84.0f * a2);
    const REAL b = max_f(0.5f - z, 0.0f), b2 = b * b;
    return -32.0f * (a2 * a * (1.0f - a) - b2 * b * (2.0f - 4.0f * b));
}

FN REAL half_space_share(const StepConstants c, REAL z) {
    const REAL a = max_f(1.0f - z, 0.0f), a2 = a * a;
    if (c.use_wendland) return a2 * a2 * a2 * (3.5f - 4.5f * a + 1.5f * a2);
    const REAL b = max_f(0.5f - z, 0.0f), b2 = b * b;
    return a2 * a2 * a * (1.6f - (6.4f / 6.0f) * a) - b2 * b2 * b * (3.2f - (25.6f / 6.0f) * b);
}

#endif
