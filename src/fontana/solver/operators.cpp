#include "solver/operators.h"

#include "solver/constants.h"

namespace fontana {

void Operators::borrow(Substep& s) {
    factor_ = &s.particles.spare_vectors();
    gradient_ = &s.particles.more_spare_vectors();
    rate_ = &s.neighborhood.spare_words();
    wall_rate_ = &s.neighborhood.more_spare_words();
}

void Operators::begin(Substep& s) {
    borrow(s);
    list_.build(s.particles, s.neighborhood, s.constants);
    s.place_walls();
    backend_.launch(Kernel::sum_neighborhood, s.particles.count(),
                    {s.constants, s.particles.position(), s.particles.velocity(), list_.start(), list_.list(),
                     s.colliders.buffer(), s.particles.density(), *factor_, *wall_rate_, *rate_, *gradient_});
}

void Operators::move_apart(Substep& s, const CrowdingWorkspace& workspace) {
    // Where many are crowded it is for pressure to part them, over the steps: when a sixteenth of all has had its turn,
    // or after 16 rounds, the rest waits. A few hundred cost little in any case.
    constexpr std::size_t k_most_rounds = 16, k_part = 16, k_few = 500;
    const std::size_t count = s.particles.count(), most = count / k_part + k_few;
    const double bound = largest_density_error(s.parameters);
    if (bound == 0.0) return;
    std::size_t turns = 0;
    for (std::size_t round = 0; round < k_most_rounds && turns < most; ++round) {
        const std::size_t found = find_crowded(s, static_cast<float>(bound), workspace);
        if (found == 0) return;
        turns += found;
        backend_.launch(Kernel::mark_crowded, count,
                        {s.constants, workspace.lambda, list_.start(), list_.list(), workspace.moved});
        backend_.launch(Kernel::crowding_gradient, count,
                        {s.constants, workspace.moved, workspace.lambda, list_.start(), list_.list(),
                         s.particles.position(), *factor_, *gradient_});
        backend_.launch(Kernel::move_apart, count,
                        {s.constants, workspace.moved, *gradient_, list_.start(), list_.list(), s.particles.position(),
                         workspace.changed});
        backend_.launch(
            Kernel::sum_changed, count,
            {s.constants, workspace.changed, s.particles.position(), s.particles.velocity(), list_.start(),
             list_.list(), s.colliders.buffer(), s.particles.density(), *factor_, *wall_rate_, *rate_, *gradient_});
    }
}

std::uint32_t Operators::find_crowded(Substep& s, float bound, const CrowdingWorkspace& workspace) {
    std::uint32_t found = 0;
    backend_.write(workspace.found, &found, sizeof found);
    backend_.launch(Kernel::find_crowded, s.particles.count(),
                    {s.constants, bound, s.particles.density(), *factor_, workspace.lambda, workspace.moved,
                     workspace.changed, workspace.found});
    backend_.read(workspace.found, &found, sizeof found);
    return found;
}

void Operators::compute_gradient(Substep& s, Buffer& u) {
    backend_.launch(Kernel::pressure_gradient, s.particles.count(),
                    {s.constants, u, list_.start(), list_.list(), s.particles.position(), *factor_, *gradient_});
}

void Operators::compute_pressed_velocity(Substep& s, Buffer& u) {
    backend_.launch(Kernel::pressed_velocity, s.particles.count(),
                    {s.constants, u, list_.start(), list_.list(), s.particles.position(), *factor_,
                     s.particles.velocity(), *gradient_});
}

void Operators::push(Substep& s) {
    backend_.launch(Kernel::push_by_pressure, s.particles.count(), {s.constants, *gradient_, s.particles.velocity()});
}

void Operators::add_forces(Substep& s) {
    backend_.copy(*gradient_, s.particles.acceleration(), s.particles.count() * 16);
    s.add_surface_tension(s.particles.position(), s.constants.inverse_rest_density);
    s.add_external_force();
}

void Operators::predict(Substep& s) {
    backend_.launch(Kernel::predict_velocity, s.particles.count(),
                    {s.constants, s.particles.acceleration(), s.particles.velocity()});
}

void Operators::load_warm_start(Substep& s, Buffer& u) {
    const std::size_t count = s.particles.count();
    backend_.launch(Kernel::load_warm_start, count,
                    {static_cast<std::uint32_t>(count), s.particles.velocity(), *factor_, u});
}

void Operators::store_pressure(Substep& s, Buffer& u) {
    backend_.launch(Kernel::store_pressure, s.particles.count(),
                    {s.constants, u, s.particles.density(), s.particles.velocity(), s.particles.pressure()});
}

void Operators::refresh(Substep& s, Buffer& u) {
    add_forces(s);
    load_warm_start(s, u);
    store_pressure(s, u);
}

void Operators::finish(Substep& s, Buffer& u) {
    store_pressure(s, u);
    s.place_colliders();
    backend_.launch(Kernel::advect, s.particles.count(),
                    {s.constants, s.colliders.buffer(), s.particles.position(), s.particles.velocity()});
}

}  // namespace fontana
