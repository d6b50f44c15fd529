#include "solver/method.h"

#include <algorithm>
#include <cmath>

#include "solver/coarse_correction.h"
#include "solver/diagnostics.h"
#include "solver/methods.h"
#include "solver/neighbor_list.h"
#include "util/error.h"

namespace fontana {
namespace {

// Units of the scene a second.
double fastest(const std::vector<Collider>& colliders, double time) {
    double speed = 0.0;
    for (const Collider& collider : colliders)
        if (collider.enabled()) speed = std::max(speed, collider.speed_at(time));
    return speed;
}

}  // namespace

std::uint32_t ColliderBuffer::place(const std::vector<Collider>& colliders, double time, double dt, double scale) {
    std::vector<ColliderConstants> surfaces;
    for (const Collider& collider : colliders)
        if (collider.enabled()) surfaces.push_back(collider.constants_at(time, dt, scale));
    const std::size_t bytes = surfaces.size() * sizeof(ColliderConstants);
    if (!buffer_ || buffer_->bytes() < bytes) buffer_ = backend_.allocate("colliders", bytes);
    if (bytes) backend_.write(*buffer_, surfaces.data(), bytes);
    return static_cast<std::uint32_t>(surfaces.size());
}

void Substep::place_walls() {
    // A difference over a hundredth of a millisecond: short against any step, long against the rounding of a position.
    constexpr double k_instant = 1e-5;
    constants.collider_count = colliders.place(scene_colliders, time, k_instant, parameters.time_simulation_scale);
}

void Substep::place_colliders() {
    constants.collider_count =
        colliders.place(scene_colliders, time + report.step.dt, report.step.dt, parameters.time_simulation_scale);
}

void Substep::choose_time_step() {
    const StepExtremes now = measure_step(backend, particles, constants, extremes);
    report.density_error_mean = now.density_error_mean;
    report.density_error_max = now.density_error_max;
    if (!(now.speed < 1e12) || !(now.acceleration < 1e18))
        fail(FONTANA_UNSTABLE, "the fluid has blown up: a particle's speed or acceleration is no longer a number");
    const double speed = std::max(now.speed, parameters.time_simulation_scale * fastest(scene_colliders, time));
    report.speed = speed;
    report.step = fontana::choose_time_step(parameters, {speed, now.acceleration, now.density_error_max}, remaining);
    constants.dt = static_cast<float>(report.step.dt);
    constants.inverse_dt = 1.0f / constants.dt;
}

void Substep::add_surface_tension(Buffer& packed_position, float volume_scale) {
    if (constants.surface_tension > 0.0f)
        backend.launch(Kernel::surface_tension, particles.count(),
                       {constants, volume_scale, packed_position, particles.density(), neighborhood.cell_start(),
                        particles.acceleration()});
}

void Substep::add_external_force() {
    backend.launch(Kernel::external_force, particles.count(),
                   {constants, particles.position(), particles.velocity(), particles.id(), particles.force_by_id(),
                    particles.acceleration()});
}

std::unique_ptr<Method> make_method(const std::string& name, Backend& backend) {
    if (name == "mueller") return make_mueller(backend);
    if (name == "wcsph") return make_wcsph(backend);
    if (name == "pcisph") return make_pcisph(backend);
    if (name == "dfsph") return make_dfsph(backend);
    fail(FONTANA_BAD_INPUT, "no method '" + name + "'");
}

std::uint64_t method_bytes(const std::string& name, std::uint64_t particle_count, const DeviceInfo& device) {
    if (name == "mueller") return 0;
    const std::uint64_t lists = NeighborList::bytes(particle_count, device), u = 4 * particle_count;
    if (name == "wcsph") return lists + u;
    if (name == "pcisph") return lists + u + 16 * particle_count;
    return lists + u + CoarseCorrection::product_bytes(particle_count) + CoarseCorrection::bytes(particle_count);
}

}  // namespace fontana
