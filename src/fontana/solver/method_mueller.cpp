// The thesis's method: Mueller, Charypar and Gross 2003. Every particle visits its candidates anew in each pass, as in
// Figs. 3, 7, 8 and 9.
#include "solver/methods.h"

namespace fontana {
namespace {

class Mueller : public Method {
 public:
    void advance(Substep& s) override {
        compute_density(s);  // eqs. 2.8, 2.11
        compute_forces(s);   // eqs. 2.10, 2.13
        s.add_surface_tension(packed_position(s), 1.0f);
        s.add_external_force();  // eq. 2.17
        s.choose_time_step();
        s.place_colliders();
        integrate(s);  // eq. 2.7 and III.7
    }

 private:
    // The 32 bytes that a neighbour costs in the force pass.
    static Buffer& packed_position(Substep& s) { return s.particles.spare_vectors(); }
    static Buffer& packed_velocity(Substep& s) { return s.particles.more_spare_vectors(); }

    static void compute_density(Substep& s) {
        Particles& p = s.particles;
        s.backend.launch(Kernel::density, p.count(),
                         {s.constants, p.position(), p.velocity(), s.neighborhood.cell_start(), p.density(),
                          packed_position(s), packed_velocity(s), p.pressure()});
    }

    static void compute_forces(Substep& s) {
        Particles& p = s.particles;
        s.backend.launch(Kernel::fluid_force, p.count(),
                         {s.constants, packed_position(s), packed_velocity(s), p.density(), s.neighborhood.cell_start(),
                          p.acceleration()});
    }

    static void integrate(Substep& s) {
        Particles& p = s.particles;
        s.backend.launch(Kernel::integrate, p.count(),
                         {s.constants, s.colliders.buffer(), p.acceleration(), p.position(), p.velocity()});
    }
};

}  // namespace

std::unique_ptr<Method> make_mueller(Backend&) { return std::make_unique<Mueller>(); }

}  // namespace fontana
