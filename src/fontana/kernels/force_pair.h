// The two forces between particles of eq. 2.6, pressure and viscosity, for one pair; in terms of REAL (dialect.h).
// Action equals reaction in each: with V = m/density the force on i from j is V_i V_j (...), which changes sign with i
// and j.
#ifndef FONTANA_FORCE_PAIR_H
#define FONTANA_FORCE_PAIR_H

#include "smoothing.h"

typedef struct ForceSum {
    REAL pressure_x, pressure_y, pressure_z;
    REAL viscous_x, viscous_y, viscous_z;
} ForceSum;

FN ForceSum zero_force(void) {
    ForceSum zero;
    zero.pressure_x = zero.pressure_y = zero.pressure_z = REAL_ZERO;
    zero.viscous_x = zero.viscous_y = zero.viscous_z = REAL_ZERO;
    return zero;
}

// The summands of eqs. 2.10 and 2.13 without their constants; x: position and V, v: velocity and pressure.
FN ForceSum add_force(ForceSum sum, const StepConstants c, float4 x_i, float4 v_i, REAL4 x_j, REAL4 v_j) {
    const REAL dx = x_i.x - x_j.x, dy = x_i.y - x_j.y, dz = x_i.z - x_j.z;
    // The floor makes x_ij / r zero, not NaN, for the particle itself and for coincident ones.
    const REAL r_squared = max_f(dx * dx + dy * dy + dz * dz, 1.0e-24f);
    const REAL inverse_r = INVERSE_SQRT(r_squared), r = r_squared * inverse_r;
    const REAL p = x_j.w * (v_i.w + v_j.w) * spiky_gradient(r, c.support_radius) * inverse_r;
    sum.pressure_x += p * dx;
    sum.pressure_y += p * dy;
    sum.pressure_z += p * dz;
    const REAL m = x_j.w * viscosity_laplacian(r, c.support_radius);
    sum.viscous_x += m * (v_j.x - v_i.x);
    sum.viscous_y += m * (v_j.y - v_i.y);
    sum.viscous_z += m * (v_j.z - v_i.z);
    return sum;
}

#endif
