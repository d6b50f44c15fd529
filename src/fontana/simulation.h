// A simulation: settings, what emits and what collides, and the particles on whichever device they are at present.
// Fig. 2 of the thesis: add particles, step a frame, read positions, with the backend behind one interface.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "backends/backend.h"
#include "backends/copy_bandwidth.h"
#include "fontana.h"
#include "io/checkpoint.h"
#include "scene/collider.h"
#include "scene/emitter.h"
#include "scene/parameters.h"
#include "solver/solver.h"

namespace fontana {

// Where a run stands, to the substep. Plain data: a section of the checkpoint.
struct RunState {
    std::int64_t frames_done = 0;
    double frame_time = 0.0;     // s into the frame under way
    std::uint32_t substeps = 0;  // of it so far
    std::uint32_t frame_begun = 0;
    std::uint32_t iterations = 0, unconverged = 0;
    double dt_min = 0.0, dt_max = 0.0;
    double density_error_sum = 0.0, density_error_max = 0.0;
    char dt_limit[24] = {};
    GridShape grid;
    std::uint32_t unused = 0;
};

class Simulation {
 public:
    Parameters parameters;  // may be changed between frames

    std::size_t add_collider(const fontana_collider& surface);
    Collider& collider(std::size_t index);
    std::size_t collider_count() const { return colliders_.size(); }

    std::size_t add_emitter(const fontana_emitter& settings);
    std::uint64_t emitted_by(std::int64_t frame) const;

    // Metres and metres a second of the scene. velocity and mass may be null.
    void add_particles(std::size_t count, const float* position, const float* velocity, const float* mass);
    void set_force(std::size_t count, const float* force);
    std::size_t particle_count() const;

    // Returns true to stop after the substep.
    using Progress = std::function<bool(double frame_fraction)>;
    void set_progress(Progress progress) { progress_ = std::move(progress); }
    // Throws INTERRUPTED where progress asked for it (the frame goes on with the next call), UNSTABLE, device errors.
    fontana_frame_report step_frame();
    std::int64_t frame() const { return run_.frames_done; }

    // 4-byte values in order of id; `bytes` must be just what the attribute takes.
    void read_attribute(const std::string& name, void* out, std::size_t bytes);
    void count_neighbors(std::uint32_t* out) { solver().count_neighbors(parameters, out); }
    void write_bgeo(const std::string& path);

    void save_checkpoint(const std::string& path, const std::string& tag);
    void load_checkpoint(const std::string& path);
    // The same in memory; appends to `out`.
    void save_state(std::vector<std::byte>& out);
    void load_state(const void* data, std::size_t bytes);

    void check() const;
    const DeviceInfo& device() { return solver().backend().device(); }
    std::vector<ProfileRow> profile() { return solver().backend().profile(); }
    double copy_bandwidth(std::size_t bytes) { return measure_copy_bandwidth(solver().backend(), bytes); }
    std::uint64_t memory_for(std::uint64_t particle_count);

 private:
    // The solver on the backend the parameters ask for; moves the particles there if they are elsewhere.
    Solver& solver();
    void begin_frame();
    void emit_due(double time, bool inclusive);
    // Throws unless ids, indices and the device's memory suffice for so many more particles.
    void require_room(double more);
    bool is_stop_asked(double frame_fraction);
    void require_no_progress() const;
    void take_substep();
    void account_for(const SubstepReport& report);
    fontana_frame_report finish_frame(double seconds);
    double scene_spacing() const;  // in units of the scene
    template <typename Use>
    void with_sections(CheckpointWriter& writer, const Use& use);
    void restore(const Checkpoint& checkpoint);

    std::vector<Collider> colliders_;
    std::vector<Emitter> emitters_;
    std::vector<std::uint64_t> emitted_batches_;  // by emitter
    RunState run_;
    Progress progress_;
    bool is_in_progress_ = false;
    std::unique_ptr<Solver> solver_;
    std::string solver_key_;  // what solver_ was made for
};

// Names, component counts and types of what read_attribute knows.
struct AttributeFacts {
    const char* name;
    fontana_type type;
    int components;
};
const std::vector<AttributeFacts>& attribute_table();

}  // namespace fontana
