// One substep of the fluid on a device. The loop of the thesis's Figs. 3, 7, 8 and 9 is Solver::substep: sort, then
// what the pressure method does (method_mueller.cpp is the thesis's).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "backends/backend.h"
#include "scene/collider.h"
#include "scene/parameters.h"
#include "solver/method.h"
#include "solver/neighborhood.h"
#include "solver/particles.h"

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
    SubstepReport substep(const Parameters& parameters, const std::vector<Collider>& colliders, double time,
                          double remaining);
    // The last of a frame, at its end.
    void end_frame(const Parameters& parameters, const std::vector<Collider>& colliders, double time);
    // Others within the support radius, in order of id.
    void count_neighbors(const Parameters& parameters, std::uint32_t* out);

 private:
    Method& method(const std::string& name);
    // What a method works with, the particles sorted.
    Substep begin_substep(const Parameters& parameters, const std::vector<Collider>& colliders, double time,
                          double remaining);

    std::unique_ptr<Backend> backend_;
    Particles particles_;
    Neighborhood neighborhood_;
    ColliderBuffer colliders_;
    std::unique_ptr<Buffer> extremes_;
    std::unique_ptr<Method> method_;
    std::string method_name_;
};

}  // namespace fontana
