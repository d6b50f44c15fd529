#include "solver/solver.h"

#include "solver/constants.h"
#include "solver/diagnostics.h"

namespace fontana {

Solver::Solver(std::unique_ptr<Backend> backend)
    : backend_(std::move(backend)), particles_(*backend_), neighborhood_(*backend_), colliders_(*backend_) {}

void Solver::begin_frame(const Parameters& parameters) { neighborhood_.fit(particles_, make_constants(parameters)); }

Substep Solver::begin_substep(const Parameters& parameters, const std::vector<Collider>& colliders, double time,
                              double remaining) {
    StepConstants constants = make_constants(parameters);
    constants.has_force = particles_.has_force() ? 1u : 0u;
    neighborhood_.update(particles_, constants);  // III.4, III.6
    if (!extremes_) extremes_ = backend_->allocate("extremes", k_most_lanes * 16);
    return {parameters,    colliders,  time,       remaining, *backend_, particles_,
            neighborhood_, colliders_, *extremes_, constants, {}};
}

SubstepReport Solver::substep(const Parameters& parameters, const std::vector<Collider>& colliders, double time,
                              double remaining) {
    Substep substep = begin_substep(parameters, colliders, time, remaining);
    method(parameters.fluid_method).advance(substep);
    return substep.report;
}

void Solver::end_frame(const Parameters& parameters, const std::vector<Collider>& colliders, double time) {
    Method& used = method(parameters.fluid_method);
    if (particles_.count() == 0 || largest_density_error(parameters) == 0.0 || !used.may_be_crowded()) return;
    Substep substep = begin_substep(parameters, colliders, time, 0.0);
    used.end_frame(substep);
}

Method& Solver::method(const std::string& name) {
    if (!method_ || method_name_ != name) {
        method_.reset();  // its arrays first, so that the two never stand side by side
        method_ = make_method(name, *backend_);
        method_name_ = name;
    }
    return *method_;
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
