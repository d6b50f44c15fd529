#include "solver/constants.h"

#include <cmath>

#include "kernels/smoothing.h"

namespace fontana {
namespace {

constexpr double k_pi = 3.14159265358979323846;

// sum of W_poly6 over a cubic lattice, one point at the origin: 1 / (volume of a particle).
double lattice_sum(double spacing, double support) {
    // From here on the sum is the integral, 1, to more digits than a float has.
    if (support > 32.0 * spacing) return 1.0 / (spacing * spacing * spacing);
    const int reach = static_cast<int>(std::ceil(support / spacing));
    double sum = 0.0;
    for (int z = -reach; z <= reach; ++z)
        for (int y = -reach; y <= reach; ++y)
            for (int x = -reach; x <= reach; ++x) {
                const double r_squared = spacing * spacing * (x * x + y * y + z * z);
                if (r_squared < support * support) sum += std::pow(support * support - r_squared, 3);
            }
    return 315.0 / (64.0 * k_pi * std::pow(support, 9)) * sum;
}

}  // namespace

double support_radius(const Parameters& p) {
    return p.fluid_support_radius > 0.0 ? p.fluid_support_radius : 2.0 * p.fluid_particle_spacing;
}

double sampling_distance(const Parameters& p) { return 0.5 * support_radius(p); }

double particle_mass(const Parameters& p) {
    if (p.fluid_particle_mass > 0.0) return p.fluid_particle_mass;
    return p.fluid_rest_density / lattice_sum(p.fluid_particle_spacing, support_radius(p));
}

double frame_duration(const Parameters& p) { return p.time_timestep > 0.0 ? p.time_timestep : 1.0 / p.time_frame_rate; }

fontana_derived derive(const Parameters& p) {
    const double support = support_radius(p);
    fontana_derived derived{};
    derived.support_radius = support;
    derived.particle_mass = particle_mass(p);
    derived.kinematic_viscosity = p.fluid_viscosity / p.fluid_rest_density;
    derived.speed_of_sound = std::sqrt(p.fluid_pressure_constant);
    derived.frame_duration = frame_duration(p);
    derived.self_density = derived.particle_mass * 315.0 / (64.0 * k_pi * std::pow(support, 3));
    return derived;
}

StepConstants make_constants(const Parameters& p) {
    const double support = support_radius(p);
    StepConstants c{};
    c.support_radius = static_cast<float>(support);
    c.support_radius_squared = c.support_radius * c.support_radius;
    c.rest_density = static_cast<float>(p.fluid_rest_density);
    c.pressure_constant = static_cast<float>(p.fluid_pressure_constant);
    c.minimum_pressure = p.fluid_negative_pressure ? -INFINITY : 0.0f;
    c.viscosity = static_cast<float>(p.fluid_viscosity);
    c.surface_tension = static_cast<float>(p.fluid_surface_tension);
    c.poly6_scale = static_cast<float>(315.0 / (64.0 * k_pi * std::pow(support, 9)));
    c.spiky_gradient_scale = static_cast<float>(45.0 / (k_pi * std::pow(support, 6)));
    c.viscosity_laplacian_scale = c.spiky_gradient_scale;
    c.poly6_gradient_scale = static_cast<float>(945.0 / (32.0 * k_pi * std::pow(support, 9)));
    // Mueller et al. leave the threshold open. On a flat surface |n| is about 1.1 / H; well inside, noise of a few
    // hundredths of it.
    c.minimum_normal = static_cast<float>(0.2 / support);
    c.gravity_x = static_cast<float>(p.forces_gravity[0]);
    c.gravity_y = static_cast<float>(p.forces_gravity[1]);
    c.gravity_z = static_cast<float>(p.forces_gravity[2]);
    c.wind_x = static_cast<float>(p.forces_wind[0]);
    c.wind_y = static_cast<float>(p.forces_wind[1]);
    c.wind_z = static_cast<float>(p.forces_wind[2]);
    c.wind_coupling = static_cast<float>(p.forces_wind_coupling);
    c.drag = static_cast<float>(p.forces_drag);
    c.inverse_cell_size = 1.0f / c.support_radius;
    c.use_grid = p.solver_neighbors == "grid" ? 1u : 0u;
    return c;
}

}  // namespace fontana
