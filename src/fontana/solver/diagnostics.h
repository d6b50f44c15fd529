// Numbers about all particles at once. One definition for the solver, the tests, the command line and the viewer.
#pragma once

#include "backends/backend.h"
#include "kernels/step_constants.h"
#include "solver/particles.h"

namespace fontana {

struct Bounds {
    double low[3], high[3];  // m
};
Bounds measure_bounds(Backend& backend, Particles& particles, StepConstants constants);

// The fastest particle, one that is alone counted for less (kernels/reduce.h), and the most accelerated (m/s, m/s^2);
// and by how much the density is above rest. NaN if any particle has a NaN.
struct StepExtremes {
    double speed, acceleration;
    double density_error_mean, density_error_max;
};
constexpr std::size_t k_most_lanes = 4096;
// `extremes` has room for k_most_lanes vectors and is written to.
StepExtremes measure_step(Backend& backend, Particles& particles, StepConstants constants, Buffer& extremes);

// Of `count` values on the device. `sums` has room for k_most_lanes floats and is written to.
double mean_of(Backend& backend, const Buffer& values, std::size_t count, Buffer& sums);

struct Diagnostics {
    double mass;                // kg
    double centre_of_mass[3];   // m
    double kinetic_energy;      // J
    double density_error_mean;  // of max(0, density / rest - 1)
    double density_error_max;
    double max_speed;  // m/s
    bool is_finite() const;
};
Diagnostics measure(Backend& backend, Particles& particles, StepConstants constants);

}  // namespace fontana
