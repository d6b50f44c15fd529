#include "solver/solver.h"

#include <algorithm>

#include "solver/constants.h"
#include "solver/diagnostics.h"
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

Solver::Solver(std::unique_ptr<Backend> backend)
    : backend_(std::move(backend)), particles_(*backend_), neighborhood_(*backend_) {}

void Solver::begin_frame(const Parameters& parameters) { neighborhood_.fit(particles_, make_constants(parameters)); }

TimeStep Solver::substep(const Parameters& parameters, const std::vector<Collider>& colliders, double time,
                         double remaining) {
    StepConstants constants = make_constants(parameters);
    constants.has_force = particles_.has_force() ? 1u : 0u;

    neighborhood_.update(particles_, constants);  // III.4, III.6
    compute_density(constants);                   // eqs. 2.8, 2.11
    compute_forces(constants);                    // eqs. 2.10, 2.13, 2.17, to the acceleration of 2.7

    const TimeStep step = choose_time_step(parameters, constants, fastest(colliders, time), remaining);
    constants.dt = static_cast<float>(step.dt);
    place_colliders(colliders, time + step.dt, step.dt, parameters.time_simulation_scale, constants);
    integrate(constants);  // and III.7
    return step;
}

void Solver::compute_density(const StepConstants& constants) {
    backend_->launch(Kernel::density, particles_.count(),
                     {constants, particles_.position(), particles_.velocity(), neighborhood_.cell_start(),
                      particles_.density(), particles_.packed_position(), particles_.packed_velocity()});
}

void Solver::compute_forces(const StepConstants& constants) {
    backend_->launch(Kernel::fluid_force, particles_.count(),
                     {constants, particles_.packed_position(), particles_.packed_velocity(), particles_.density(),
                      neighborhood_.cell_start(), particles_.acceleration()});
    if (constants.surface_tension > 0.0f)
        backend_->launch(Kernel::surface_tension, particles_.count(),
                         {constants, particles_.packed_position(), particles_.density(), neighborhood_.cell_start(),
                          particles_.acceleration()});
    backend_->launch(Kernel::external_force, particles_.count(),
                     {constants, particles_.position(), particles_.velocity(), particles_.id(),
                      particles_.force_by_id(), particles_.acceleration()});
}

TimeStep Solver::choose_time_step(const Parameters& parameters, const StepConstants& constants, double collider_speed,
                                  double remaining) {
    if (parameters.time_substeps > 0) return fontana::choose_time_step(parameters, 0.0, 0.0, remaining);
    const MotionExtremes motion = measure_motion(*backend_, particles_, constants);
    if (!(motion.speed < 1e12) || !(motion.acceleration < 1e18))
        fail(FONTANA_UNSTABLE, "the fluid has blown up: a particle's speed or acceleration is no longer a number");
    const double speed = std::max(motion.speed, parameters.time_simulation_scale * collider_speed);
    return fontana::choose_time_step(parameters, speed, motion.acceleration, remaining);
}

void Solver::place_colliders(const std::vector<Collider>& colliders, double time, double dt, double scale,
                             StepConstants& constants) {
    std::vector<ColliderConstants> surfaces;
    for (const Collider& collider : colliders)
        if (collider.enabled()) surfaces.push_back(collider.constants_at(time, dt, scale));
    const std::size_t bytes = surfaces.size() * sizeof(ColliderConstants);
    if (!colliders_ || colliders_->bytes() < bytes) colliders_ = backend_->allocate("colliders", bytes);
    if (bytes) backend_->write(*colliders_, surfaces.data(), bytes);
    constants.collider_count = static_cast<std::uint32_t>(surfaces.size());
}

void Solver::integrate(const StepConstants& constants) {
    backend_->launch(Kernel::integrate, particles_.count(),
                     {constants, *colliders_, particles_.acceleration(), particles_.position(), particles_.velocity()});
}

void Solver::count_neighbors(const Parameters& parameters, std::uint32_t* out) {
    const std::size_t count = particles_.count();
    if (count == 0) return;
    // On copies, because the search sorts: what was computed in the present order, and the grid of a frame under way,
    // stay as they are.
    Particles copy(*backend_);
    copy.upload(particles_.download());
    Neighborhood search(*backend_);
    StepConstants constants = make_constants(parameters);
    search.fit(copy, constants);
    search.update(copy, constants);
    const auto found = backend_->allocate("neighbour count", count * 4);
    const auto by_id = backend_->allocate("neighbour count by id", count * 4);
    backend_->launch(Kernel::count_neighbors, count, {constants, copy.position(), search.cell_start(), *found});
    backend_->launch(Kernel::words_by_id, count, {static_cast<std::uint32_t>(count), copy.id(), *found, *by_id});
    backend_->read(*by_id, out, count * 4);
}

}  // namespace fontana
