// Saving and continuing a simulation, bit for bit.
#include <cstring>

#include "io/checkpoint.h"
#include "simulation.h"
#include "util/error.h"

namespace fontana {
namespace {

template <typename T>
std::vector<T> load_array(const Checkpoint& checkpoint, const std::string& name, std::size_t count) {
    std::vector<T> values(count);
    checkpoint.copy_section(name, values.data(), count * sizeof(T));
    return values;
}

// A checkpoint is only as good as its numbers: ids must be a permutation, or reading by id would leave the arrays.
void check_ids(const std::vector<std::uint32_t>& ids) {
    std::vector<bool> seen(ids.size(), false);
    for (const std::uint32_t id : ids) {
        if (id >= ids.size() || seen[id])
            fail(FONTANA_BAD_INPUT,
                 "the checkpoint's particle ids are not 0 to " + std::to_string(ids.size()) + ", each once");
        seen[id] = true;
    }
}

}  // namespace

template <typename Use>
void Simulation::with_sections(CheckpointWriter& writer, const Use& use) {
    const ParticleState state = solver().particles().download();
    RunState run = run_;
    run.grid = solver().neighborhood().shape();
    const std::uint64_t particle_count = state.position.size();
    writer.section("run", &run, sizeof run);
    writer.section("particle_count", &particle_count, sizeof particle_count);
    writer.section("emitted_batches", emitted_batches_);
    writer.section("position", state.position);
    writer.section("velocity", state.velocity);
    writer.section("id", state.id);
    writer.section("density", state.density);
    writer.section("pressure", state.pressure);
    writer.section("acceleration", state.acceleration);
    writer.section("force", state.force_by_id);
    use();
}

void Simulation::save_checkpoint(const std::string& path, const std::string& tag) {
    CheckpointWriter writer(path, tag);
    with_sections(writer, [&] { writer.publish(); });
}

void Simulation::save_state(std::vector<std::byte>& out) {
    CheckpointWriter writer("in memory");
    with_sections(writer, [&] { writer.append_to(out); });
}

void Simulation::load_checkpoint(const std::string& path) {
    require_no_progress();
    restore(Checkpoint::load(path));
}

void Simulation::load_state(const void* data, std::size_t bytes) {
    require_no_progress();
    restore(Checkpoint::parse(data, bytes, "the state in memory"));
}

void Simulation::restore(const Checkpoint& checkpoint) {
    const std::string& path = checkpoint.path();
    RunState run;
    std::uint64_t n = 0;
    checkpoint.copy_section("run", &run, sizeof run);
    checkpoint.copy_section("particle_count", &n, sizeof n);
    if (n != checkpoint.section("id").size() / sizeof(std::uint32_t))
        fail(FONTANA_BAD_INPUT, "the checkpoint " + path + " contradicts itself about its number of particles");
    if (checkpoint.section("emitted_batches").size() != emitters_.size() * sizeof(std::uint64_t))
        fail(FONTANA_BAD_INPUT, "the checkpoint " + path + " is of a scene with another number of emitters than " +
                                    std::to_string(emitters_.size()));
    // The grid of a frame under way was fitted when it began, perhaps to fewer particles, never to more.
    if (!run.grid.is_possible(n)) fail(FONTANA_BAD_INPUT, "the checkpoint " + path + " has an impossible grid");
    if (run.frames_done < 0 || !(run.frame_time >= 0.0 && run.frame_time < 1e9))
        fail(FONTANA_BAD_INPUT, "the checkpoint " + path + " has an impossible time");
    auto batches = load_array<std::uint64_t>(checkpoint, "emitted_batches", emitters_.size());
    const bool has_force = !checkpoint.section("force").empty();
    ParticleState state;
    state.position = load_array<float4>(checkpoint, "position", n);
    state.velocity = load_array<float4>(checkpoint, "velocity", n);
    state.id = load_array<std::uint32_t>(checkpoint, "id", n);
    state.density = load_array<float>(checkpoint, "density", n);
    state.pressure = load_array<float>(checkpoint, "pressure", n);
    state.acceleration = load_array<float4>(checkpoint, "acceleration", n);
    state.force_by_id = load_array<float4>(checkpoint, "force", has_force ? n : 0);
    check_ids(state.id);

    run.dt_limit[sizeof run.dt_limit - 1] = '\0';
    Solver& s = solver();  // asks for memory, as the upload does at first; after that nothing may fail
    s.particles().upload(state);
    s.neighborhood().set_shape(run.grid);
    emitted_batches_ = std::move(batches);
    run_ = run;
}

}  // namespace fontana
