// From parameters to the numbers the kernels use.
#pragma once

#include "fontana.h"
#include "kernels/step_constants.h"
#include "scene/parameters.h"

namespace fontana {

// What each smoothing kernel of eqs. 2.14 to 2.16 leaves to its caller (kernels/smoothing.h).
struct SmoothingScales {
    double poly6, poly6_derivative;  // 315 / (64 pi H^9) and 945 / (32 pi H^9): of W, and of its gradient and Laplacian
    double spiky, spiky_gradient;    // 15 / (pi H^6) and 45 / (pi H^6)
    double viscosity, viscosity_laplacian;  // 15 / (2 pi H^3) and 45 / (pi H^6)
};
SmoothingScales smoothing_scales(double support_radius);

// m. Given, or twice the particle spacing.
double support_radius(const Parameters& parameters);
// m. Half the support radius: the length every limit of the time step is made of.
double sampling_distance(const Parameters& parameters);
// kg. Given, or such that a lattice at the particle spacing has the rest density in the sum of eq. 2.8.
double particle_mass(const Parameters& parameters);
// s, of simulated time.
double frame_duration(const Parameters& parameters);
// Mean density error at which a pressure solve stops, as a share: solver.quality or solver.density_error.
double density_error_tolerance(const Parameters& parameters);
// Density error of any one particle, as a share, above which it is moved off its neighbours; 0: never.
double largest_density_error(const Parameters& parameters);
// m^2 for a full neighbourhood: 1 / (2 (|sum V grad W|^2 + sum |V grad W|^2)), over a lattice at the spacing (PCISPH).
double pcisph_delta(const Parameters& parameters);
// Whether the pressure follows from the density by an equation of state: such a fluid has a speed of sound.
bool is_stiff(const Parameters& parameters);
fontana_derived derive(const Parameters& parameters);

// Everything but what changes by the substep: counts, dt and the grid.
StepConstants make_constants(const Parameters& parameters);

}  // namespace fontana
