#include "solver/operators.h"

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

void Operators::compute_rate(Substep& s) {
    backend_.launch(Kernel::density_rate, s.particles.count(),
                    {s.constants, s.particles.velocity(), list_.start(), list_.list(), s.particles.position(), *factor_,
                     *wall_rate_, *rate_});
}

void Operators::compute_gradient(Substep& s, Buffer& u) {
    backend_.launch(Kernel::pressure_gradient, s.particles.count(),
                    {s.constants, u, list_.start(), list_.list(), s.particles.position(), *factor_, *gradient_});
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
                    {s.constants, u, s.particles.density(), s.particles.velocity(), s.particles.pressure()});
    s.place_colliders();
    backend_.launch(Kernel::advect, s.particles.count(),
                    {s.constants, s.colliders.buffer(), s.particles.position(), s.particles.velocity()});
}

}  // namespace fontana
