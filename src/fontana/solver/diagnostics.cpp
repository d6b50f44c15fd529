#include "solver/diagnostics.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace fontana {
namespace {

// Few enough to read back and add up at once, though a large GPU runs more threads. The shape of every sum depends on
// the particle count alone.
std::uint32_t lanes_for(std::size_t particle_count) {
    return static_cast<std::uint32_t>(std::clamp<std::size_t>(particle_count / 4, 1, k_most_lanes));
}

template <typename T>
std::vector<T> lanes(Backend& backend, const Buffer& buffer, std::uint32_t lane_count) {
    std::vector<T> values(lane_count);
    backend.read(buffer, values.data(), lane_count * sizeof(T));
    return values;
}

// As in the kernels (kernels/reduce.h).
double max_or_nan(double a, double b) { return a < b || std::isnan(b) ? b : a; }

}  // namespace

Bounds measure_bounds(Backend& backend, Particles& particles, StepConstants constants) {
    constants.particle_count = static_cast<std::uint32_t>(particles.count());
    const std::uint32_t lane_count = lanes_for(particles.count());
    const auto low = backend.allocate("low", lane_count * 16), high = backend.allocate("high", lane_count * 16);
    backend.launch(Kernel::reduce_bounds, lane_count, {constants, lane_count, particles.position(), *low, *high});
    Bounds bounds{{1e30, 1e30, 1e30}, {-1e30, -1e30, -1e30}};
    for (const float4& a : lanes<float4>(backend, *low, lane_count)) {
        const float lane[3] = {a.x, a.y, a.z};
        for (int k = 0; k < 3; ++k) bounds.low[k] = std::min(bounds.low[k], static_cast<double>(lane[k]));
    }
    for (const float4& b : lanes<float4>(backend, *high, lane_count)) {
        const float lane[3] = {b.x, b.y, b.z};
        for (int k = 0; k < 3; ++k) bounds.high[k] = std::max(bounds.high[k], static_cast<double>(lane[k]));
    }
    return bounds;
}

StepExtremes measure_step(Backend& backend, Particles& particles, StepConstants constants, Buffer& extremes) {
    constants.particle_count = static_cast<std::uint32_t>(particles.count());
    const std::uint32_t lane_count = lanes_for(particles.count());
    backend.launch(Kernel::reduce_step, lane_count,
                   {constants, lane_count, particles.position(), particles.velocity(), particles.acceleration(),
                    particles.density(), extremes});
    StepExtremes step{};
    for (const float4& lane : lanes<float4>(backend, extremes, lane_count)) {
        step.speed = max_or_nan(step.speed, static_cast<double>(lane.x));
        step.acceleration = max_or_nan(step.acceleration, static_cast<double>(lane.y));
        step.density_error_mean += static_cast<double>(lane.z);
        step.density_error_max = max_or_nan(step.density_error_max, static_cast<double>(lane.w));
    }
    step.speed = std::sqrt(step.speed);
    step.acceleration = std::sqrt(step.acceleration);
    step.density_error_mean /= static_cast<double>(particles.count());
    return step;
}

double mean_of(Backend& backend, const Buffer& values, std::size_t count, Buffer& sums) {
    const std::uint32_t lane_count = lanes_for(count);
    backend.launch(Kernel::reduce_sum, lane_count, {static_cast<std::uint32_t>(count), lane_count, values, sums});
    double total = 0.0;
    for (const float sum : lanes<float>(backend, sums, lane_count)) total += static_cast<double>(sum);
    return total / static_cast<double>(count);
}

bool Diagnostics::is_finite() const {
    return std::isfinite(mass) && std::isfinite(centre_of_mass[0]) && std::isfinite(centre_of_mass[1]) &&
           std::isfinite(centre_of_mass[2]) && std::isfinite(kinetic_energy) && std::isfinite(density_error_mean) &&
           std::isfinite(max_speed);
}

Diagnostics measure(Backend& backend, Particles& particles, StepConstants constants) {
    Diagnostics d{};
    if (particles.count() == 0) return d;
    constants.particle_count = static_cast<std::uint32_t>(particles.count());
    const std::uint32_t lane_count = lanes_for(particles.count());
    const auto moment = backend.allocate("moment", lane_count * 16),
               value = backend.allocate("measure", lane_count * 16);
    backend.launch(
        Kernel::reduce_diagnostics, lane_count,
        {constants, lane_count, particles.position(), particles.velocity(), particles.density(), *moment, *value});
    for (const float4& m : lanes<float4>(backend, *moment, lane_count)) {
        d.centre_of_mass[0] += static_cast<double>(m.x);
        d.centre_of_mass[1] += static_cast<double>(m.y);
        d.centre_of_mass[2] += static_cast<double>(m.z);
        d.mass += static_cast<double>(m.w);
    }
    for (double& coordinate : d.centre_of_mass) coordinate /= d.mass;
    for (const float4& lane : lanes<float4>(backend, *value, lane_count)) {
        d.kinetic_energy += static_cast<double>(lane.x);
        d.density_error_mean += static_cast<double>(lane.y);
        d.density_error_max = max_or_nan(d.density_error_max, static_cast<double>(lane.z));
        d.max_speed = max_or_nan(d.max_speed, static_cast<double>(lane.w));
    }
    d.density_error_mean /= static_cast<double>(particles.count());
    d.max_speed = std::sqrt(d.max_speed);
    return d;
}

}  // namespace fontana
