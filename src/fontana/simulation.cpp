#include "simulation.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "io/bgeo.h"
#include "io/checkpoint.h"
#include "solver/constants.h"
#include "solver/diagnostics.h"
#include "util/error.h"

namespace fontana {
namespace {

float scaled(float value, double scale) { return static_cast<float>(scale * static_cast<double>(value)); }

// Of vectors, once they are scaled.
void require_finite(const float* values, std::size_t count, double scale, const char* what) {
    for (std::size_t k = 0; k < 3 * count; ++k)
        if (!std::isfinite(scaled(values[k], scale)))
            fail(FONTANA_BAD_INPUT,
                 std::string(what) + " of particle " + std::to_string(k / 3) + " is not a finite number");
}

[[noreturn]] void fail_too_many(double count) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", count);
    fail(FONTANA_BAD_INPUT, std::string(text) + " particles are more than the " + std::to_string(Particles::most) +
                                " that ids and indices can count");
}

}  // namespace

const std::vector<AttributeFacts>& attribute_table() {
    static const std::vector<AttributeFacts> table = {
        {"position", FONTANA_FLOAT, 3}, {"velocity", FONTANA_FLOAT, 3}, {"acceleration", FONTANA_FLOAT, 3},
        {"force", FONTANA_FLOAT, 3},    {"density", FONTANA_FLOAT, 1},  {"pressure", FONTANA_FLOAT, 1},
        {"mass", FONTANA_FLOAT, 1},     {"id", FONTANA_INT, 1},
    };
    return table;
}

std::size_t Simulation::add_collider(const fontana_collider& surface) {
    colliders_.emplace_back(surface);
    return colliders_.size() - 1;
}

Collider& Simulation::collider(std::size_t index) {
    if (index >= colliders_.size())
        fail(FONTANA_BAD_INPUT, "no collider " + std::to_string(index) + ": there are " +
                                    std::to_string(colliders_.size()) + ", counted from 0");
    return colliders_[index];
}

std::size_t Simulation::add_emitter(const fontana_emitter& settings) {
    emitted_batches_.reserve(emitters_.size() + 1);  // so that nothing can fail between the next two lines
    emitters_.emplace_back(settings, static_cast<std::uint32_t>(emitters_.size()));
    emitted_batches_.push_back(0);
    return emitters_.size() - 1;
}

double Simulation::scene_spacing() const {
    return parameters.fluid_particle_spacing / parameters.time_simulation_scale;
}

std::uint64_t Simulation::emitted_by(std::int64_t frame) const {
    const double duration = frame_duration(parameters), spacing = scene_spacing();
    std::uint64_t total = 0;
    for (const Emitter& emitter : emitters_) {
        const std::uint64_t due = emitter.due_count(static_cast<double>(frame) * duration, false, spacing, duration);
        if (due > 0) total += due * emitter.particles_per_batch(spacing);
        if (total > Particles::most) fail_too_many(static_cast<double>(total));
    }
    return total;
}

std::size_t Simulation::particle_count() const { return solver_ ? solver_->particles().count() : 0; }

void Simulation::require_room(double more) {
    const double total = static_cast<double>(particle_count()) + more;
    if (total > static_cast<double>(Particles::most)) fail_too_many(total);
    // Asked beforehand, because an operating system may grant memory that it does not have and end the process later.
    const std::uint64_t needed = memory_for(static_cast<std::uint64_t>(total)), present = device().memory_bytes;
    if (present > 0 && needed > present)
        fail(FONTANA_OUT_OF_MEMORY, "out of memory: " + std::to_string(static_cast<std::uint64_t>(total)) +
                                        " particles take " + std::to_string(needed >> 20) + " MiB, and '" +
                                        device().name + "' has " + std::to_string(present >> 20) + " MiB");
}

void Simulation::add_particles(std::size_t count, const float* position, const float* velocity, const float* mass) {
    if (count == 0) return;
    require_room(static_cast<double>(count));
    for (std::size_t k = 0; mass && k < count; ++k)
        if (!(mass[k] > 0.0f && std::isfinite(mass[k])))
            fail(FONTANA_BAD_INPUT, "the mass of particle " + std::to_string(k) + " is " + std::to_string(mass[k]) +
                                        "; expected kilograms above 0");
    const double scale = parameters.time_simulation_scale;
    require_finite(position, count, scale, "the position in metres");
    if (velocity) require_finite(velocity, count, scale, "the velocity in metres a second");
    const float own_mass = static_cast<float>(fontana::particle_mass(parameters));
    const auto vector = [scale](const float* v, float w) {
        return float4{scaled(v[0], scale), scaled(v[1], scale), scaled(v[2], scale), w};
    };
    const auto particle = [&](std::size_t k, float4& x, float4& v) {
        x = vector(position + 3 * k, mass ? mass[k] : own_mass);
        if (velocity) v = vector(velocity + 3 * k, 0.0f);
    };
    solver().particles().append(count, particle, static_cast<float>(parameters.fluid_rest_density));
}

void Simulation::set_force(std::size_t count, const float* force) {
    if (force && count != particle_count())
        fail(FONTANA_BAD_INPUT,
             "forces for " + std::to_string(count) + " particles, but there are " + std::to_string(particle_count()));
    std::vector<float4> by_id(force ? count : 0);
    if (force) require_finite(force, count, 1.0, "the force");
    for (std::size_t k = 0; k < by_id.size(); ++k) by_id[k] = {force[3 * k], force[3 * k + 1], force[3 * k + 2], 0.0f};
    solver().particles().set_force(by_id);
}

Solver& Simulation::solver() {
    const bool tiles = parameters.solver_neighbors == "tiles";
    const std::string key = parameters.solver_backend + " " + parameters.solver_precision + " " +
                            std::to_string(parameters.solver_threads) + " " + std::to_string(parameters.solver_device) +
                            " " + std::to_string(parameters.solver_profile) + " " + std::to_string(tiles);
    if (solver_ && key == solver_key_) return *solver_;
    BackendOptions options;
    options.strict = parameters.solver_precision == "strict";
    options.profile = parameters.solver_profile;
    options.tiles = tiles;
    options.threads = parameters.solver_threads;
    options.device = parameters.solver_device;
    auto moved = std::make_unique<Solver>(make_backend(parameters.solver_backend, options));
    if (solver_) {
        moved->particles().upload(solver_->particles().download());
        moved->neighborhood().set_shape(solver_->neighborhood().shape());
    }
    solver_ = std::move(moved);
    solver_key_ = key;
    return *solver_;
}

void Simulation::check() const {
    check_time_step(parameters);
    if (parameters.solver_neighbors == "tiles" && parameters.fluid_method != "mueller")
        fail(FONTANA_BAD_INPUT, "solver.neighbors=tiles is a choice of fluid.method=mueller, and the method is " +
                                    parameters.fluid_method + ": use solver.neighbors=grid");
    for (const Emitter& emitter : emitters_) emitter.check(scene_spacing());
}

void Simulation::emit_due(double time, bool inclusive) {
    const double duration = frame_duration(parameters), spacing = scene_spacing();
    EmittedParticles fresh;
    std::vector<std::uint64_t> batches = emitted_batches_;
    for (std::size_t k = 0; k < emitters_.size(); ++k) {
        const std::uint64_t due = emitters_[k].due_count(time, inclusive, spacing, duration);
        if (due <= batches[k]) continue;
        require_room(static_cast<double>(fresh.position.size() / 3) +
                     static_cast<double>(due - batches[k]) *
                         static_cast<double>(emitters_[k].particles_per_batch(spacing)));
        for (; batches[k] < due; ++batches[k]) emitters_[k].emit(batches[k], time, spacing, duration, fresh);
    }
    add_particles(fresh.position.size() / 3, fresh.position.data(), fresh.velocity.data(), nullptr);
    emitted_batches_ = std::move(batches);  // only now: a batch that found no memory comes with the next call
}

void Simulation::begin_frame() {
    check();
    RunState fresh;
    fresh.frames_done = run_.frames_done;
    run_ = fresh;
    run_.dt_min = frame_duration(parameters);
    std::strncpy(run_.dt_limit, "frame", sizeof run_.dt_limit - 1);
    emit_due(static_cast<double>(run_.frames_done) * frame_duration(parameters), true);
    solver().begin_frame(parameters);
    run_.frame_begun = 1;
}

void Simulation::take_substep() {
    const double duration = frame_duration(parameters);
    const double frame_start = static_cast<double>(run_.frames_done) * duration;
    if (run_.substeps >= static_cast<std::uint32_t>(parameters.time_max_substeps) && parameters.time_substeps == 0)
        fail(FONTANA_UNSTABLE, "frame " + std::to_string(run_.frames_done + 1) + " needs more than " +
                                   std::to_string(parameters.time_max_substeps) +
                                   " substeps (time.max_substeps): the limit '" + run_.dt_limit + "' asks for " +
                                   std::to_string(run_.dt_min) + " s");
    SubstepReport report;
    report.step.dt = duration - run_.frame_time;
    if (particle_count() > 0)
        report = solver().substep(parameters, colliders_, frame_start + run_.frame_time, duration - run_.frame_time);
    account_for(report);
    emit_due(std::min(frame_start + run_.frame_time, frame_start + duration), false);
}

void Simulation::account_for(const SubstepReport& report) {
    const TimeStep& step = report.step;
    run_.frame_time += step.dt;
    ++run_.substeps;
    run_.iterations += report.iterations;
    run_.unconverged += report.converged ? 0 : 1;
    run_.density_error_sum += report.density_error_mean;
    run_.density_error_max = std::max(run_.density_error_max, report.density_error_max);
    run_.dt_max = std::max(run_.dt_max, step.dt);
    // Equal steps keep the name of the first: the last of a frame always ends with it.
    if (run_.substeps == 1 || step.dt < run_.dt_min * (1.0 - 1e-9)) {
        run_.dt_min = step.dt;
        std::strncpy(run_.dt_limit, step.limit, sizeof run_.dt_limit - 1);
    }
}

bool Simulation::is_stop_asked(double frame_fraction) {
    if (!progress_) return false;
    const Progress progress = progress_;  // which the callback may replace
    is_in_progress_ = true;
    const bool stop = progress(frame_fraction);
    is_in_progress_ = false;
    return stop;
}

void Simulation::require_no_progress() const {
    if (is_in_progress_)
        fail(FONTANA_BAD_INPUT, "the progress callback runs within a frame: step or load after it has returned");
}

fontana_frame_report Simulation::step_frame() {
    const auto begin = std::chrono::steady_clock::now();
    require_no_progress();
    solver();
    const double duration = frame_duration(parameters);
    if (!run_.frame_begun)
        begin_frame();
    else  // an earlier call may have failed between a substep and its emitters
        emit_due(static_cast<double>(run_.frames_done) * duration + run_.frame_time, false);
    const auto is_done = [&] {
        if (parameters.time_substeps > 0) return run_.substeps >= static_cast<std::uint32_t>(parameters.time_substeps);
        return run_.frame_time >= duration * (1.0 - 1e-9);
    };
    while (!is_done()) {
        take_substep();
        if (is_stop_asked(std::min(1.0, run_.frame_time / duration)) && !is_done())
            fail(FONTANA_INTERRUPTED, "interrupted in frame " + std::to_string(run_.frames_done + 1));
    }
    solver().end_frame(parameters, colliders_, static_cast<double>(run_.frames_done + 1) * duration);
    solver().backend().finish();
    return finish_frame(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
}

fontana_frame_report Simulation::finish_frame(double seconds) {
    const double scale = parameters.time_simulation_scale;
    const Diagnostics d = measure(solver().backend(), solver().particles(), make_constants(parameters));
    if (!d.is_finite())
        fail(FONTANA_UNSTABLE, "frame " + std::to_string(run_.frames_done + 1) +
                                   " has particles whose position, velocity or density is no longer a number; use "
                                   "more substeps or a smaller time.cfl_factor");
    ++run_.frames_done;
    run_.frame_begun = 0;
    fontana_frame_report report{};
    report.frame = run_.frames_done;
    report.time = static_cast<double>(run_.frames_done) * frame_duration(parameters);
    report.particle_count = particle_count();
    report.substeps = run_.substeps;
    report.iterations = run_.iterations;
    report.unconverged = run_.unconverged;
    report.dt_min = run_.dt_min;
    report.dt_max = run_.dt_max;
    report.dt_limit = run_.dt_limit;
    report.density_error_mean = run_.density_error_sum / std::max(1u, run_.substeps);
    report.density_error_max = std::max(run_.density_error_max, d.density_error_max);
    report.max_speed = d.max_speed / scale;
    report.kinetic_energy = d.kinetic_energy;
    for (int k = 0; k < 3; ++k) report.centre_of_mass[k] = d.centre_of_mass[k] / scale;
    report.seconds = seconds;
    return report;
}

void Simulation::read_attribute(const std::string& name, void* out, std::size_t bytes) {
    const std::vector<AttributeFacts>& table = attribute_table();
    const auto facts =
        std::find_if(table.begin(), table.end(), [&](const AttributeFacts& row) { return name == row.name; });
    if (facts == table.end()) {
        std::vector<std::string> names;
        for (const AttributeFacts& row : table) names.emplace_back(row.name);
        fail(FONTANA_BAD_INPUT, "no attribute '" + name + "': did you mean '" + nearest_word(name, names) + "'?");
    }
    const std::size_t count = particle_count(), values = count * static_cast<std::size_t>(facts->components);
    if (bytes != values * 4)
        fail(FONTANA_BAD_INPUT,
             "attribute '" + name + "' takes " + std::to_string(values * 4) + " bytes, not " + std::to_string(bytes));
    if (count == 0) return;

    Particles& p = solver().particles();
    Backend& backend = solver().backend();
    const auto sorted = backend.allocate("attribute", values * 4);
    const auto n = static_cast<std::uint32_t>(count);
    if (name == "position") backend.launch(Kernel::vectors_by_id, count, {n, p.id(), p.position(), *sorted});
    if (name == "velocity") backend.launch(Kernel::vectors_by_id, count, {n, p.id(), p.velocity(), *sorted});
    if (name == "acceleration") backend.launch(Kernel::vectors_by_id, count, {n, p.id(), p.acceleration(), *sorted});
    if (name == "density") backend.launch(Kernel::words_by_id, count, {n, p.id(), p.density(), *sorted});
    if (name == "pressure") backend.launch(Kernel::words_by_id, count, {n, p.id(), p.pressure(), *sorted});
    if (name == "mass") backend.launch(Kernel::fourth_by_id, count, {n, p.id(), p.position(), *sorted});
    if (name == "id") backend.launch(Kernel::words_by_id, count, {n, p.id(), p.id(), *sorted});
    if (name == "force") {
        const ParticleState state = p.download();
        float* force = static_cast<float*>(out);
        std::fill_n(force, values, 0.0f);
        for (std::size_t k = 0; k < state.force_by_id.size(); ++k)
            std::memcpy(force + 3 * k, &state.force_by_id[k], 12);
        return;
    }
    backend.read(*sorted, out, values * 4);
    const double scale = parameters.time_simulation_scale;
    if (scale != 1.0 && facts->components == 3) {
        float* vector = static_cast<float*>(out);
        for (std::size_t k = 0; k < values; ++k) vector[k] = static_cast<float>(static_cast<double>(vector[k]) / scale);
    }
}

void Simulation::write_bgeo(const std::string& path) {
    const std::size_t count = particle_count();
    const double radius = derive(parameters).particle_radius;  // pscale is a radius
    std::vector<float> position(3 * count), velocity(3 * count), density(count), pressure(count), mass(count);
    std::vector<float> pscale(count, static_cast<float>(radius));
    std::vector<std::int32_t> id(count);
    read_attribute("position", position.data(), 12 * count);
    read_attribute("velocity", velocity.data(), 12 * count);
    read_attribute("density", density.data(), 4 * count);
    read_attribute("pressure", pressure.data(), 4 * count);
    read_attribute("mass", mass.data(), 4 * count);
    read_attribute("id", id.data(), 4 * count);
    fontana::write_bgeo(path, {count, position.data(), velocity.data(), id.data(), density.data(), pressure.data(),
                               pscale.data(), mass.data()});
}

std::uint64_t Simulation::memory_for(std::uint64_t particle_count) {
    if (particle_count > Particles::most) fail_too_many(static_cast<double>(particle_count));
    return particle_count * Particles::bytes_per_particle() + Neighborhood::bytes(particle_count) +
           method_bytes(parameters.fluid_method, particle_count, device());
}

}  // namespace fontana
