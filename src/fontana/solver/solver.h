// One substep of the fluid on a device. The loop of the thesis's Figs. 3, 7, 8 and 9 is Solver::substep.
#pragma once

#include <memory>
#include <vector>

#include "backends/backend.h"
#include "scene/collider.h"
#include "scene/parameters.h"
#include "solver/neighborhood.h"
#include "solver/particles.h"
#include "solver/time_step.h"

namespace fontana {

class Solver {
 public:
    explicit Solver(std::unique_ptr<Backend> backend);

    Backend& backend() { return *backend_; }
    Particles& particles() { return particles_; }
    Neighborhood& neighborhood() { return neighborhood_; }

    // Once a frame: fits the grid to the particles.
    void begin_frame(const Parameters& parameters);
    // Advances all particles from `time` by at most `remaining` seconds.
    TimeStep substep(const Parameters& parameters, const std::vector<Collider>& colliders, double time,
                     double remaining);
    // Others within the support radius, in order of id.
    void count_neighbors(const Parameters& parameters, std::uint32_t* out);

 private:
    void compute_density(const StepConstants& constants);
    void compute_forces(const StepConstants& constants);
    TimeStep choose_time_step(const Parameters& parameters, const StepConstants& constants, double collider_speed,
                              double remaining);
    void place_colliders(const std::vector<Collider>& colliders, double time, double dt, double scale,
                         StepConstants& constants);
    void integrate(const StepConstants& constants);

    std::unique_ptr<Backend> backend_;
    Particles particles_;
    Neighborhood neighborhood_;
    std::unique_ptr<Buffer> colliders_;
};

}  // namespace fontana
