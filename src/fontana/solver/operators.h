// What the production methods share: density, the operators G and G^T over the neighbour lists, viscosity, prediction
// and advection (kernels/incompressible.h), with the arrays they work on.
#pragma once

#include <memory>

#include "backends/backend.h"
#include "solver/method.h"
#include "solver/neighbor_list.h"

namespace fontana {

// What move_apart works in: a word a particle each, and one for all.
struct CrowdingWorkspace {
    Buffer &lambda, &moved, &changed, &found;
};

class Operators {
 public:
    explicit Operators(Backend& backend) : backend_(backend), list_(backend) {}

    // Lists, densities, S and D, with the walls where they are at the start of the substep; the rate() of the density
    // under the velocities as they are, and viscosity.
    void begin(Substep& substep);
    // Moves particles apart until none is denser than solver.density_error_max, as far as they can be
    // (kernels/crowding.h), and brings up to date what begin() has computed; right after it.
    void move_apart(Substep& substep, const CrowdingWorkspace& workspace);
    // The acceleration by viscosity, surface tension and external forces; after choose_time_step, which looks at the
    // last one, and before gradient() is used, where viscosity waits.
    void add_forces(Substep& substep);
    // What hosts read at the end of a frame, after begin() and move_apart(): acceleration, and pressure from the u
    // that finish() left. `u` is written to.
    void refresh(Substep& substep, Buffer& u);
    // G u into gradient(); m/s^2.
    void compute_gradient(Substep& substep, Buffer& u);
    // v / dt - G u into gradient(); m/s^2.
    void compute_pressed_velocity(Substep& substep, Buffer& u);
    // v -= dt G u.
    void push(Substep& substep);
    // v += dt a.
    void predict(Substep& substep);
    // Into u what finish() left with every particle, or 0 where it feels no pressure now.
    void load_warm_start(Substep& substep, Buffer& u);
    // x += dt v and collisions; the pressure goes to where hosts read it, u to where the next substep finds it.
    void finish(Substep& substep, Buffer& u);

    NeighborList& list() { return list_; }
    Buffer& factor() { return *factor_; }
    Buffer& rate() { return *rate_; }
    Buffer& wall_rate() { return *wall_rate_; }
    Buffer& gradient() { return *gradient_; }

 private:
    // Nothing here outlives the substep, so it lives in what the next sort will overwrite.
    void borrow(Substep& substep);
    void store_pressure(Substep& substep, Buffer& u);
    std::uint32_t find_crowded(Substep& substep, float bound, const CrowdingWorkspace& workspace);

    Backend& backend_;
    NeighborList list_;
    Buffer *factor_ = nullptr, *wall_rate_ = nullptr, *rate_ = nullptr, *gradient_ = nullptr;
};

}  // namespace fontana
