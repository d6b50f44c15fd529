// The C interface over the classes. Every function is a try around one call.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <exception>
#include <new>

#include "backends/backend.h"
#include "fontana.h"
#include "io/atomic_file.h"
#include "io/checkpoint.h"
#include "io/hash64.h"
#include "kernels/smoothing.h"
#include "simulation.h"
#include "solver/constants.h"
#include "util/error.h"
#include "util/sentence.h"

struct fontana_simulation {
    fontana::Simulation simulation;
    std::string text;  // the last string given out
    std::vector<std::byte> state;
    std::vector<fontana::ProfileRow> profile;
    std::vector<fontana_kernel_profile> profile_view;
};

namespace {

thread_local std::string last_error;

fontana_status report(fontana_status status, const char* sentence) noexcept {
    try {
        last_error = fontana::one_line(sentence);
    } catch (...) {
        last_error = "out of memory";  // short enough to need none
    }
    return status;
}

template <typename Work>
fontana_status guarded(const Work& work) noexcept {
    try {
        work();
        return FONTANA_OK;
    } catch (const fontana::Error& error) {
        return report(error.status(), error.what());
    } catch (const std::bad_alloc&) {
        return report(FONTANA_OUT_OF_MEMORY, "out of memory on the host");
    } catch (const std::length_error&) {
        return report(FONTANA_OUT_OF_MEMORY, "out of memory on the host: an array would be too long");
    } catch (const std::exception& error) {
        return report(FONTANA_INTERNAL, error.what());
    } catch (...) {
        return report(FONTANA_INTERNAL, "an error of unknown type");
    }
}

void require(const void* pointer, const char* name) {
    if (!pointer) fontana::fail(FONTANA_BAD_INPUT, std::string(name) + " must not be null");
}

void require_not_negative(double value, const char* name) {
    if (!(value >= 0.0) || !std::isfinite(value))
        fontana::fail(FONTANA_BAD_INPUT, std::string(name) + " must be a finite number, 0 or above");
}

fontana::Simulation& simulation_of(fontana_simulation* handle) {
    require(handle, "the simulation");
    return handle->simulation;
}

// Devices as the interface shows them; the strings stay in `devices`.
fontana_device view_of(const fontana::DeviceInfo& device) {
    return {device.backend.c_str(),   device.name.c_str(),   device.driver.c_str(),
            device.memory_bytes,      device.compute_units,  device.is_gpu ? 1 : 0,
            device.available ? 1 : 0, device.reason.c_str(), device.neighbors.c_str()};
}

fontana_kernel_profile view_of(const fontana::ProfileRow& row) {
    const fontana::KernelFacts* facts = fontana::find_kernel_facts(row.name);
    const auto elements = static_cast<double>(row.elements);
    return {row.name.c_str(),
            row.launches,
            row.seconds,
            row.elements,
            facts ? elements * facts->bytes_per_particle : 0.0,
            facts ? elements * facts->flops_per_particle : 0.0};
}

// A device function times the constant that the solver takes out of the sum.
double smoothing(const std::string& kernel, const std::string& quantity, double r, double h) {
    const float rf = static_cast<float>(r), hf = static_cast<float>(h), r2 = rf * rf, h2 = hf * hf;
    const fontana::SmoothingScales scale = fontana::smoothing_scales(h);
    const struct {
        const char *kernel, *quantity;
        double scale;
        float value;
    } table[] = {
        {"poly6", "value", scale.poly6, poly6(r2, h2)},
        {"poly6", "gradient", -scale.poly6_derivative * r, poly6_gradient(r2, h2)},
        {"poly6", "laplacian", -scale.poly6_derivative, poly6_laplacian(r2, h2)},
        {"spiky", "value", scale.spiky, spiky(rf, hf)},
        {"spiky", "gradient", -scale.spiky_gradient, spiky_gradient(rf, hf)},
        {"viscosity", "value", scale.viscosity, viscosity_kernel(rf, hf)},
        {"viscosity", "laplacian", scale.viscosity_laplacian, viscosity_laplacian(rf, hf)},
    };
    for (const auto& row : table)
        if (kernel == row.kernel && quantity == row.quantity)
            return r < h ? row.scale * static_cast<double>(row.value) : 0.0;
    fontana::fail(FONTANA_BAD_INPUT, "no " + quantity + " of a smoothing kernel '" + kernel +
                                         "': expected poly6 (value, gradient, laplacian), spiky (value, gradient) or "
                                         "viscosity (value, laplacian)");
}

}  // namespace

extern "C" {

const char* fontana_version(void) { return FONTANA_VERSION; }
int fontana_abi_version(void) { return FONTANA_ABI_VERSION; }
const char* fontana_last_error(void) { return last_error.c_str(); }

fontana_status fontana_create(fontana_simulation** out) {
    return guarded([&] {
        require(out, "out");
        *out = new fontana_simulation();
    });
}

void fontana_destroy(fontana_simulation* simulation) { delete simulation; }

size_t fontana_parameter_count(void) { return fontana::parameter_table().size(); }

fontana_status fontana_parameter_info(size_t index, fontana_parameter* out) {
    return guarded([&] {
        require(out, "out");
        if (index >= fontana::parameter_table().size()) fontana::fail(FONTANA_BAD_INPUT, "no parameter of that index");
        *out = fontana::parameter_table()[index];
    });
}

fontana_status fontana_set_number(fontana_simulation* simulation, const char* name, const double* values,
                                  size_t count) {
    return guarded([&] {
        require(name, "name");
        require(values, "values");
        fontana::set_number(simulation_of(simulation).parameters, name, values, count);
    });
}

fontana_status fontana_get_number(fontana_simulation* simulation, const char* name, double* values, size_t count) {
    return guarded([&] {
        require(name, "name");
        require(values, "values");
        fontana::get_number(simulation_of(simulation).parameters, name, values, count);
    });
}

fontana_status fontana_set_text(fontana_simulation* simulation, const char* name, const char* text) {
    return guarded([&] {
        require(name, "name");
        require(text, "text");
        fontana::set_text(simulation_of(simulation).parameters, name, text);
    });
}

fontana_status fontana_get_text(fontana_simulation* simulation, const char* name, const char** text) {
    return guarded([&] {
        require(name, "name");
        require(text, "text");
        simulation_of(simulation);
        simulation->text = fontana::get_text(simulation->simulation.parameters, name);
        *text = simulation->text.c_str();
    });
}

fontana_status fontana_apply_preset(fontana_simulation* simulation, const char* preset) {
    return guarded([&] {
        require(preset, "preset");
        fontana::apply_preset(simulation_of(simulation).parameters, preset);
    });
}

fontana_status fontana_derive(fontana_simulation* simulation, fontana_derived* out) {
    return guarded([&] {
        require(out, "out");
        *out = fontana::derive(simulation_of(simulation).parameters);
    });
}

void fontana_collider_defaults(fontana_collider_type type, fontana_collider* out) {
    if (out) *out = fontana::Collider::defaults(type);
}

fontana_status fontana_add_collider(fontana_simulation* simulation, const fontana_collider* collider, size_t* index) {
    return guarded([&] {
        require(collider, "collider");
        const std::size_t added = simulation_of(simulation).add_collider(*collider);
        if (index) *index = added;
    });
}

fontana_status fontana_set_collider(fontana_simulation* simulation, size_t index, const fontana_collider* collider) {
    return guarded([&] {
        require(collider, "collider");
        simulation_of(simulation).collider(index).set_surface(*collider);
    });
}

fontana_status fontana_set_collider_keys(fontana_simulation* simulation, size_t index, size_t count, const double* time,
                                         const double* centre) {
    return guarded([&] {
        if (count) {
            require(time, "time");
            require(centre, "centre");
        }
        if (count > fontana::Collider::most_keys)
            fontana::fail(FONTANA_BAD_INPUT,
                          "a collider has at most " + std::to_string(fontana::Collider::most_keys) + " keys");
        std::vector<fontana::Vector> centres(count);
        for (size_t k = 0; k < count; ++k) std::copy_n(centre + 3 * k, 3, centres[k].begin());
        simulation_of(simulation).collider(index).set_keys(std::vector<double>(time, time + count), std::move(centres));
    });
}

size_t fontana_collider_count(const fontana_simulation* simulation) {
    return simulation ? simulation->simulation.collider_count() : 0;
}

fontana_status fontana_collider_centre(fontana_simulation* simulation, size_t index, double time, double centre[3]) {
    return guarded([&] {
        require(centre, "centre");
        if (!std::isfinite(time)) fontana::fail(FONTANA_BAD_INPUT, "the time must be a finite number of seconds");
        const fontana::Vector c = simulation_of(simulation).collider(index).centre_at(time);
        std::copy(c.begin(), c.end(), centre);
    });
}

fontana_status fontana_add_particles(fontana_simulation* simulation, size_t count, const float* position,
                                     const float* velocity, const float* mass) {
    return guarded([&] {
        if (count) require(position, "position");
        simulation_of(simulation).add_particles(count, position, velocity, mass);
    });
}

fontana_status fontana_set_force(fontana_simulation* simulation, size_t count, const float* force) {
    return guarded([&] { simulation_of(simulation).set_force(count, force); });
}

size_t fontana_particle_count(const fontana_simulation* simulation) {
    return simulation ? simulation->simulation.particle_count() : 0;
}

void fontana_emitter_defaults(fontana_emitter_type type, fontana_emitter* out) {
    if (out) *out = fontana::Emitter::defaults(type);
}

fontana_status fontana_add_emitter(fontana_simulation* simulation, const fontana_emitter* emitter, size_t* index) {
    return guarded([&] {
        require(emitter, "emitter");
        const std::size_t added = simulation_of(simulation).add_emitter(*emitter);
        if (index) *index = added;
    });
}

fontana_status fontana_emitted_by(fontana_simulation* simulation, int64_t frame, uint64_t* count) {
    return guarded([&] {
        require(count, "count");
        *count = simulation_of(simulation).emitted_by(frame);
    });
}

size_t fontana_attribute_count(void) { return fontana::attribute_table().size(); }

fontana_status fontana_attribute_info(size_t index, const char** name, fontana_type* type, int* components) {
    return guarded([&] {
        const auto& table = fontana::attribute_table();
        if (index >= table.size()) fontana::fail(FONTANA_BAD_INPUT, "no attribute of that index");
        if (name) *name = table[index].name;
        if (type) *type = table[index].type;
        if (components) *components = table[index].components;
    });
}

fontana_status fontana_read_attribute(fontana_simulation* simulation, const char* name, void* out, size_t bytes) {
    return guarded([&] {
        require(name, "name");
        if (bytes) require(out, "out");
        simulation_of(simulation).read_attribute(name, out, bytes);
    });
}

fontana_status fontana_set_progress(fontana_simulation* simulation, fontana_progress callback, void* user) {
    return guarded([&] {
        if (!callback)
            simulation_of(simulation).set_progress(nullptr);
        else
            simulation_of(simulation).set_progress([callback, user](double fraction) {
                return callback(user, fraction) != 0;
            });
    });
}

fontana_status fontana_step_frame(fontana_simulation* simulation, fontana_frame_report* out) {
    return guarded([&] {
        const fontana_frame_report report = simulation_of(simulation).step_frame();
        if (out) *out = report;
    });
}

int64_t fontana_frame(const fontana_simulation* simulation) { return simulation ? simulation->simulation.frame() : 0; }

fontana_status fontana_estimate_limits(fontana_simulation* simulation, double speed, double acceleration,
                                       fontana_time_step_limits* out) {
    return guarded([&] {
        require(out, "out");
        require_not_negative(speed, "speed");
        require_not_negative(acceleration, "acceleration");
        *out = fontana::time_step_limits(simulation_of(simulation).parameters, speed, acceleration);
    });
}

fontana_status fontana_estimate_memory(fontana_simulation* simulation, uint64_t particle_count, uint64_t* bytes) {
    return guarded([&] {
        require(bytes, "bytes");
        *bytes = simulation_of(simulation).memory_for(particle_count);
    });
}

fontana_status fontana_check(fontana_simulation* simulation) {
    return guarded([&] { simulation_of(simulation).check(); });
}

fontana_status fontana_list_devices(const fontana_device** devices, size_t* count) {
    thread_local std::vector<fontana::DeviceInfo> found;
    thread_local std::vector<fontana_device> view;
    return guarded([&] {
        require(devices, "devices");
        require(count, "count");
        found = fontana::list_devices();
        view.clear();
        for (const fontana::DeviceInfo& device : found) view.push_back(view_of(device));
        *devices = view.data();
        *count = view.size();
    });
}

fontana_status fontana_choose_device(const char* backend, fontana_device* out) {
    thread_local fontana::DeviceInfo chosen;
    return guarded([&] {
        require(backend, "backend");
        require(out, "out");
        chosen = fontana::choose_device(backend);
        *out = view_of(chosen);
    });
}

fontana_status fontana_device_in_use(fontana_simulation* simulation, fontana_device* out) {
    return guarded([&] {
        require(out, "out");
        *out = view_of(simulation_of(simulation).device());
    });
}

fontana_status fontana_read_profile(fontana_simulation* simulation, const fontana_kernel_profile** rows,
                                    size_t* count) {
    return guarded([&] {
        require(rows, "rows");
        require(count, "count");
        simulation->profile = simulation_of(simulation).profile();
        std::sort(simulation->profile.begin(), simulation->profile.end(),
                  [](const auto& a, const auto& b) { return a.seconds > b.seconds; });
        simulation->profile_view.clear();
        for (const fontana::ProfileRow& row : simulation->profile) simulation->profile_view.push_back(view_of(row));
        *rows = simulation->profile_view.data();
        *count = simulation->profile_view.size();
    });
}

fontana_status fontana_measure_copy(fontana_simulation* simulation, size_t bytes, double* bytes_per_second) {
    return guarded([&] {
        require(bytes_per_second, "bytes_per_second");
        *bytes_per_second = simulation_of(simulation).copy_bandwidth(bytes);
    });
}

fontana_status fontana_write_bgeo(fontana_simulation* simulation, const char* path) {
    return guarded([&] {
        require(path, "path");
        simulation_of(simulation).write_bgeo(path);
    });
}

fontana_status fontana_save_checkpoint(fontana_simulation* simulation, const char* path, const char* tag) {
    return guarded([&] {
        require(path, "path");
        simulation_of(simulation).save_checkpoint(path, tag ? tag : "");
    });
}

fontana_status fontana_load_checkpoint(fontana_simulation* simulation, const char* path) {
    return guarded([&] {
        require(path, "path");
        simulation_of(simulation).load_checkpoint(path);
    });
}

fontana_status fontana_save_state(fontana_simulation* simulation, const void** data, size_t* bytes) {
    return guarded([&] {
        require(data, "data");
        require(bytes, "bytes");
        fontana::Simulation& s = simulation_of(simulation);
        simulation->state.clear();
        s.save_state(simulation->state);
        *data = simulation->state.data();
        *bytes = simulation->state.size();
    });
}

fontana_status fontana_load_state(fontana_simulation* simulation, const void* data, size_t bytes) {
    return guarded([&] {
        if (bytes) require(data, "data");
        simulation_of(simulation).load_state(data, bytes);
    });
}

fontana_status fontana_checkpoint_info(const char* path, int64_t* frame, uint64_t* particle_count, char* tag,
                                       size_t tag_room) {
    return guarded([&] {
        require(path, "path");
        const fontana::Checkpoint checkpoint = fontana::Checkpoint::load(path);
        fontana::RunState run;
        checkpoint.copy_section("run", &run, sizeof run);
        if (frame) *frame = run.frames_done;
        if (particle_count) checkpoint.copy_section("particle_count", particle_count, sizeof *particle_count);
        if (!tag) return;
        if (checkpoint.tag().size() + 1 > tag_room)
            fontana::fail(FONTANA_BAD_INPUT,
                          "the checkpoint's tag needs " + std::to_string(checkpoint.tag().size() + 1) + " bytes");
        std::memcpy(tag, checkpoint.tag().c_str(), checkpoint.tag().size() + 1);
    });
}

fontana_status fontana_publish_file(const char* path, const void* data, size_t bytes, uint64_t* hash) {
    return guarded([&] {
        require(path, "path");
        if (bytes) require(data, "data");
        fontana::AtomicFile file(path);
        file.write(data, bytes);
        file.publish();
        if (hash) *hash = file.hash();
    });
}

uint64_t fontana_hash(const void* data, size_t bytes) { return fontana::hash64(data, data ? bytes : 0); }

fontana_status fontana_smoothing_kernel(const char* kernel, const char* quantity, double r, double support_radius,
                                        double* out) {
    return guarded([&] {
        require(kernel, "kernel");
        require(quantity, "quantity");
        require(out, "out");
        require_not_negative(r, "r");
        require_not_negative(support_radius, "the support radius");
        if (support_radius == 0.0) fontana::fail(FONTANA_BAD_INPUT, "the support radius must be above 0");
        *out = smoothing(kernel, quantity, r, support_radius);
    });
}

fontana_status fontana_count_neighbors(fontana_simulation* simulation, uint32_t* out, size_t count) {
    return guarded([&] {
        if (count != simulation_of(simulation).particle_count())
            fontana::fail(FONTANA_BAD_INPUT, "expected room for as many counts as there are particles");
        if (count) require(out, "out");
        simulation_of(simulation).count_neighbors(out);
    });
}

}  // extern "C"
