#include "solver/operators.h"

namespace fontana {

void Operators::reserve(std::size_t particle_count) {
    if (u_ && reserved_ >= particle_count) return;
    const std::size_t roomy = particle_count + particle_count / 4;
    factor_ = backend_.allocate("factor", roomy * 16);
    wall_rate_ = backend_.allocate("wall rate", roomy * 4);
    rate_ = backend_.allocate("rate", roomy * 4);
    gradient_ = backend_.allocate("pressure gradient", roomy * 16);
    u_ = backend_.allocate("pressure", roomy * 4);
    reserved_ = roomy;  // only now: memory may run out halfway
}

std::uint64_t Operators::bytes(std::uint64_t particle_count, std::uint32_t list_group) {
    return (particle_count + particle_count / 4) * (2 * 16 + 3 * 4) + NeighborList::bytes(particle_count, list_group);
}

void Operators::begin(Substep& s) {
    const std::size_t count = s.particles.count();
    reserve(count);
    list_.build(s.particles, s.neighborhood, s.constants);
    s.place_walls();
    backend_.launch(Kernel::sum_neighborhood, count,
                    {s.constants, s.particles.position(), s.particles.velocity(), list_.count(), list_.list(),
                     s.colliders.buffer(), s.particles.density(), *factor_, *wall_rate_, *rate_, *gradient_});
}

void Operators::compute_rate(Substep& s) {
    backend_.launch(Kernel::density_rate, s.particles.count(),
                    {s.constants, s.particles.velocity(), list_.count(), list_.list(), s.particles.position(), *factor_,
                     *wall_rate_, *rate_});
}

void Operators::compute_gradient(Substep& s, Buffer& u) {
    backend_.launch(Kernel::pressure_gradient, s.particles.count(),
                    {s.constants, u, list_.count(), list_.list(), s.particles.position(), *factor_, *gradient_});
}

void Operators::clear_u(Substep& s) {
    backend_.launch(Kernel::clear_words, s.particles.count(), {static_cast<std::uint32_t>(s.particles.count()), *u_});
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

void Operators::finish(Substep& s, Buffer& u) {
    backend_.launch(Kernel::store_pressure, s.particles.count(),
                    {s.constants, u, s.particles.density(), s.particles.velocity(), s.particles.packed_velocity()});
    s.place_colliders();
    backend_.launch(Kernel::advect, s.particles.count(),
                    {s.constants, s.colliders.buffer(), s.particles.position(), s.particles.velocity()});
}

}  // namespace fontana
