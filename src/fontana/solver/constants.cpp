#include "solver/constants.h"

#include <algorithm>
#include <cmath>

#include "kernels/smoothing.h"
#include "kernels/spline.h"

namespace fontana {
namespace {

constexpr double k_pi = 3.14159265358979323846;

bool uses_spline(const Parameters& p) { return p.fluid_method != "mueller"; }

double spline_scale(const Parameters& p, double support) {
    return (p.fluid_kernel == "wendland" ? 21.0 / 2.0 : 8.0) / (k_pi * support * support * support);
}

// What kernel_gradient of spline.h leaves out.
double spline_gradient_scale(const Parameters& p, double support) {
    const double scale = spline_scale(p, support);
    return p.fluid_kernel == "wendland" ? -20.0 * scale / (support * support) : -6.0 * scale / support;
}

// What the functions of spline.h read.
StepConstants spline_constants(const Parameters& p) {
    const double support = support_radius(p);
    StepConstants c{};
    c.kernel_scale = static_cast<float>(spline_scale(p, support));
    c.gradient_scale = static_cast<float>(spline_gradient_scale(p, support) / p.fluid_rest_density);
    c.use_wendland = p.fluid_kernel == "wendland" ? 1u : 0u;
    c.support_radius = static_cast<float>(support);
    c.inverse_support_radius = 1.0f / c.support_radius;
    return c;
}

// Calls visit(r) for every other point of a cubic lattice within the support, as seen from one of its points.
template <typename Visit>
void for_lattice(double spacing, double support, const Visit& visit) {
    const int reach = static_cast<int>(std::ceil(support / spacing));
    for (int z = -reach; z <= reach; ++z)
        for (int y = -reach; y <= reach; ++y)
            for (int x = -reach; x <= reach; ++x) {
                const double r = spacing * std::sqrt(static_cast<double>(x * x + y * y + z * z));
                if (r < support && (x || y || z)) visit(r);
            }
}

// From this many spacings on a sum over the lattice is the integral, to more digits than a float has.
constexpr double k_most_reach = 32.0;

// sum of W over the lattice, the point itself included: 1 / (volume of a particle).
double lattice_sum(const Parameters& p) {
    const double support = support_radius(p);
    if (support > k_most_reach * p.fluid_particle_spacing) return 1.0 / std::pow(p.fluid_particle_spacing, 3);
    double sum = 0.0;
    if (uses_spline(p)) {
        const StepConstants c = spline_constants(p);
        sum = static_cast<double>(kernel_value(c, 0.0f));
        for_lattice(p.fluid_particle_spacing, support,
                    [&](double r) { sum += static_cast<double>(kernel_value(c, static_cast<float>(r))); });
        return sum;
    }
    const auto support_squared = static_cast<float>(support * support);
    sum = static_cast<double>(poly6(0.0f, support_squared));
    for_lattice(p.fluid_particle_spacing, support,
                [&](double r) { sum += static_cast<double>(poly6(static_cast<float>(r * r), support_squared)); });
    return smoothing_scales(support).poly6 * sum;
}

void set_push(const Parameters& p, StepConstants& c) {
    c.push_x = static_cast<float>(p.forces_push[0]);
    c.push_y = static_cast<float>(p.forces_push[1]);
    c.push_z = static_cast<float>(p.forces_push[2]);
    c.push_centre_x = static_cast<float>(p.forces_push_centre[0]);
    c.push_centre_y = static_cast<float>(p.forces_push_centre[1]);
    c.push_centre_z = static_cast<float>(p.forces_push_centre[2]);
    // Finite, so that a particle at the very centre of the smallest ball is no 0 times infinity.
    const double inverse = 1.0 / (p.forces_push_radius * p.forces_push_radius);
    c.inverse_push_radius_squared = static_cast<float>(std::min(inverse, 1e38));
}

}  // namespace

SmoothingScales smoothing_scales(double support) {
    const double cube = support * support * support, sixth = cube * cube, ninth = sixth * cube;  // powers of H
    return {315.0 / (64.0 * k_pi * ninth), 945.0 / (32.0 * k_pi * ninth), 15.0 / (k_pi * sixth),
            45.0 / (k_pi * sixth),         15.0 / (2.0 * k_pi * cube),    45.0 / (k_pi * sixth)};
}

double support_radius(const Parameters& p) {
    return p.fluid_support_radius > 0.0 ? p.fluid_support_radius : 2.0 * p.fluid_particle_spacing;
}

double sampling_distance(const Parameters& p) { return 0.5 * support_radius(p); }

// W(0) of the kernel that the density is summed with, 1/m^3.
static double own_value(const Parameters& p, double support) {
    return uses_spline(p) ? spline_scale(p, support) : smoothing_scales(support).poly6 * std::pow(support, 6);
}

double particle_mass(const Parameters& p) {
    if (p.fluid_particle_mass > 0.0) return p.fluid_particle_mass;
    return p.fluid_rest_density / lattice_sum(p);
}

double frame_duration(const Parameters& p) { return p.time_timestep > 0.0 ? p.time_timestep : 1.0 / p.time_frame_rate; }

double density_error_tolerance(const Parameters& p) {
    if (p.solver_quality == "draft") return 1e-2;
    if (p.solver_quality == "good") return 1e-3;
    if (p.solver_quality == "final") return 1e-4;
    return 0.01 * p.solver_density_error;
}

double largest_density_error(const Parameters& p) {
    constexpr double k_least = 10.0;  // times the mean: closer to it than that are more than a few
    const double bound = 0.01 * p.solver_density_error_max;
    return bound == 0.0 ? 0.0 : std::max(bound, k_least * density_error_tolerance(p));
}

double pcisph_delta(const Parameters& p) {
    const StepConstants c = spline_constants(p);
    const double support = support_radius(p), spacing = std::max(p.fluid_particle_spacing, support / k_most_reach);
    const double volume = particle_mass(p) / p.fluid_rest_density, scale = spline_gradient_scale(p, support);
    double squares = 0.0;  // on a lattice the gradients themselves add up to nothing
    for_lattice(spacing, support, [&](double r) {
        const double gradient =
            r * scale * static_cast<double>(kernel_gradient(c, static_cast<float>(r), static_cast<float>(1.0 / r)));
        squares += volume * std::pow(spacing, 3) * gradient * gradient;
    });
    return 0.5 / squares;
}

bool is_stiff(const Parameters& p) { return p.fluid_method == "mueller" || p.fluid_method == "wcsph"; }

fontana_derived derive(const Parameters& p) {
    const double support = support_radius(p);
    fontana_derived derived{};
    derived.support_radius = support;
    derived.particle_mass = particle_mass(p);
    derived.kinematic_viscosity = p.fluid_viscosity / p.fluid_rest_density;
    derived.speed_of_sound = is_stiff(p) ? std::sqrt(p.fluid_pressure_constant) : 0.0;
    derived.frame_duration = frame_duration(p);
    derived.self_density = derived.particle_mass * own_value(p, support);
    derived.particle_radius = 0.5 * sampling_distance(p) / p.time_simulation_scale;
    return derived;
}

StepConstants make_constants(const Parameters& p) {
    const double support = support_radius(p);
    StepConstants c = spline_constants(p);
    c.own_value = static_cast<float>(own_value(p, support));
    c.support_radius_squared = c.support_radius * c.support_radius;
    c.rest_density = static_cast<float>(p.fluid_rest_density);
    c.pressure_constant = static_cast<float>(p.fluid_pressure_constant);
    c.minimum_pressure = p.fluid_negative_pressure ? -INFINITY : 0.0f;
    c.viscosity = static_cast<float>(p.fluid_viscosity);
    c.surface_tension = static_cast<float>(p.fluid_surface_tension);
    const SmoothingScales scales = smoothing_scales(support);
    c.poly6_scale = static_cast<float>(scales.poly6);
    c.spiky_gradient_scale = static_cast<float>(scales.spiky_gradient);
    c.viscosity_laplacian_scale = static_cast<float>(scales.viscosity_laplacian);
    c.poly6_gradient_scale = static_cast<float>(scales.poly6_derivative);
    // Mueller et al. leave the threshold open. On a flat surface |n| is about 1.1 / H; well inside, noise of a few
    // hundredths of it.
    c.minimum_normal = static_cast<float>(0.2 / support);
    c.inverse_rest_density = 1.0f / c.rest_density;
    c.gravity_x = static_cast<float>(p.forces_gravity[0]);
    c.gravity_y = static_cast<float>(p.forces_gravity[1]);
    c.gravity_z = static_cast<float>(p.forces_gravity[2]);
    c.wind_x = static_cast<float>(p.forces_wind[0]);
    c.wind_y = static_cast<float>(p.forces_wind[1]);
    c.wind_z = static_cast<float>(p.forces_wind[2]);
    c.wind_coupling = static_cast<float>(p.forces_wind_coupling);
    if (p.forces_push_radius > 0.0) set_push(p, c);
    c.drag = static_cast<float>(p.forces_drag);
    c.inverse_cell_size = 1.0f / c.support_radius;
    c.use_grid = p.solver_neighbors == "all-pairs" ? 0u : 1u;
    return c;
}

}  // namespace fontana
