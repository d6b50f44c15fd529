// How long a substep may be, and which limit says so.
#pragma once

#include "fontana.h"
#include "scene/parameters.h"

namespace fontana {

struct TimeStep {
    double dt;          // s
    const char* limit;  // "fixed", "frame" (nothing else held it), "advection", "acceleration", ...
};

// Largest stable steps in seconds, cfl_factor included, for a fluid whose fastest particle has `speed` (m/s) and whose
// most accelerated one `acceleration` (m/s^2). INFINITY where a limit does not apply.
//   advection        0.4 d / speed; d / speed for particles that are alone, whose speed comes here as 0.4 of it
//   acceleration     0.25 sqrt(H / acceleration)                     (Monaghan 1992)
//   acoustic         0.4 d / c, c^2 the pressure constant
//   viscosity        0.1 d^2 density / viscosity
//   convergence      0.15 s/m d for dfsph, 0.1 without its coarse levels, 0.05 for pcisph: longer steps change the
//                    neighbourhood more than the solve can follow
//   surface_tension  0.4 sqrt(density d^3 / (2 pi sigma))
// with H the support radius and d = H / 2.
fontana_time_step_limits time_step_limits(const Parameters& parameters, double speed, double acceleration);

// What the next substep depends on: of the fastest, the most accelerated and the densest particle.
struct StepState {
    double speed;          // m/s
    double acceleration;   // m/s^2
    double density_error;  // density / rest density - 1
};

// The next substep when `remaining` seconds of the frame are left: the smallest limit, shortened so that the rest of
// the frame divides evenly. Where particles crowd, `convergence` of dfsph with coarse levels falls to 0.1 s/m d.
TimeStep choose_time_step(const Parameters& parameters, const StepState& state, double remaining);

// Throws BAD_INPUT with the limit and a remedy where a fixed step, or the most substeps allowed, cannot integrate the
// fluid stably.
void check_time_step(const Parameters& parameters);

}  // namespace fontana
