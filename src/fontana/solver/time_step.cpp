#include "solver/time_step.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include "solver/constants.h"
#include "util/error.h"

namespace fontana {
namespace {

constexpr double k_pi = 3.14159265358979323846;
constexpr double k_infinity = std::numeric_limits<double>::infinity();

double quotient(double numerator, double denominator) {
    return denominator > 0.0 ? numerator / denominator : k_infinity;
}

// s/m: the longest step for a metre of spacing at which the pressure solve still converges in few iterations, and the
// first contact with a floor does not crush anyone.
double convergence_rate(const Parameters& p) {
    if (p.fluid_method == "pcisph") return 0.05;
    return p.solver_pressure_solver == "multilevel" ? 0.15 : 0.1;
}

// s. Where particles crowd, as in a tall tank that settles, the coarse levels do not make up for a step half as long
// again as Anderson alone bears.
double convergence_limit(const Parameters& p, double longest, double density_error) {
    if (p.fluid_method != "dfsph" || p.solver_pressure_solver != "multilevel") return longest;
    return longest * std::clamp(std::sqrt(quotient(0.01, density_error)), 2.0 / 3.0, 1.0);
}

std::string text_of(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", value);
    return text;
}

}  // namespace

fontana_time_step_limits time_step_limits(const Parameters& p, double speed, double acceleration) {
    const double d = sampling_distance(p), density = p.fluid_rest_density, factor = p.time_cfl_factor;
    fontana_time_step_limits limits{};
    limits.advection = factor * quotient(0.4 * d, speed);
    limits.acceleration = factor * 0.25 * std::sqrt(quotient(2.0 * d, acceleration));
    limits.acoustic = is_stiff(p) ? factor * quotient(0.4 * d, std::sqrt(p.fluid_pressure_constant)) : k_infinity;
    limits.convergence = is_stiff(p) ? k_infinity : factor * convergence_rate(p) * d;
    limits.viscosity = factor * quotient(0.1 * d * d * density, p.fluid_viscosity);
    limits.surface_tension =
        factor * 0.4 * std::sqrt(quotient(density * d * d * d, 2.0 * k_pi * p.fluid_surface_tension));
    return limits;
}

TimeStep choose_time_step(const Parameters& p, const StepState& state, double remaining) {
    if (p.time_substeps > 0) return {frame_duration(p) / p.time_substeps, "fixed"};
    const fontana_time_step_limits limits = time_step_limits(p, state.speed, state.acceleration);
    const std::pair<double, const char*> candidates[] = {
        {remaining, "frame"},
        {limits.advection, "advection"},
        {limits.acceleration, "acceleration"},
        {limits.acoustic, "acoustic"},
        {limits.viscosity, "viscosity"},
        {limits.surface_tension, "surface_tension"},
        {convergence_limit(p, limits.convergence, state.density_error), "convergence"},
    };
    const auto& smallest = *std::min_element(std::begin(candidates), std::end(candidates));
    // A step that would leave a sliver takes its share of the rest instead.
    const double steps = std::ceil(remaining / smallest.first * (1.0 - 1e-9));
    return {remaining / std::max(1.0, steps), smallest.second};
}

void check_time_step(const Parameters& p) {
    // Below this H^9 leaves the range of float.
    if (support_radius(p) < 2e-4)
        fail(FONTANA_BAD_INPUT, "a support radius of " + text_of(support_radius(p)) +
                                    " m is too small; expected at least 0.0002 m (a tenth of a millimetre of spacing)");
    const fontana_time_step_limits limits = time_step_limits(p, 0.0, 0.0);
    const double frame = frame_duration(p);
    if (p.time_substeps == 0) {
        const double smallest =
            std::min({limits.acoustic, limits.viscosity, limits.surface_tension, limits.convergence});
        const double needed = std::ceil(frame / smallest);
        if (needed <= p.time_max_substeps) return;
        if (smallest == limits.convergence)
            fail(FONTANA_BAD_INPUT, p.fluid_method + " needs " + text_of(needed) +
                                        " substeps a frame at this particle spacing, and time.max_substeps allows " +
                                        std::to_string(p.time_max_substeps) + ": use a larger fluid.particle_spacing");
        const char* why = smallest == limits.viscosity         ? "viscosity"
                          : smallest == limits.surface_tension ? "surface tension"
                                                               : "pressure constant";
        fail(FONTANA_BAD_INPUT, std::string("this ") + why + " needs " + text_of(needed) +
                                    " substeps a frame at this particle spacing, and time.max_substeps allows " +
                                    std::to_string(p.time_max_substeps) + ": lower the " + why +
                                    " or use a larger fluid.particle_spacing");
    }
    // The bounds of stability themselves; the automatic limits above keep a margin of 2 to 3 from them. Viscosity: the
    // Laplacian of eq. 2.16 sums to 15 / H^2 (its integral), so an explicit step beyond H^2 density / (15 mu)
    // overshoots.
    const double dt = frame / p.time_substeps, support = support_radius(p);
    const double viscous_bound = quotient(support * support * p.fluid_rest_density, 15.0 * p.fluid_viscosity);
    if (dt > viscous_bound)
        fail(FONTANA_BAD_INPUT, "a viscosity of " + text_of(p.fluid_viscosity) + " Pa*s is unstable at a step of " +
                                    text_of(dt) + " s: use time.substeps " + text_of(std::ceil(frame / viscous_bound)) +
                                    " or more, or 0 for automatic");
    if (limits.acoustic == k_infinity) return;
    const double acoustic_bound = quotient(support, std::sqrt(p.fluid_pressure_constant));
    if (dt > acoustic_bound)
        fail(FONTANA_BAD_INPUT, "a pressure constant of " + text_of(p.fluid_pressure_constant) +
                                    " m^2/s^2 is unstable at a step of " + text_of(dt) + " s: use time.substeps " +
                                    text_of(std::ceil(frame / acoustic_bound)) + " or more, or 0 for automatic");
}

}  // namespace fontana
