// A pressure method: what happens in a substep once the particles are sorted. One file a method; method.cpp lists them.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "backends/backend.h"
#include "scene/collider.h"
#include "scene/parameters.h"
#include "solver/neighborhood.h"
#include "solver/particles.h"
#include "solver/time_step.h"

namespace fontana {

// What a substep did.
struct SubstepReport {
    TimeStep step{0.0, "frame"};
    double speed = 0.0;                                        // m/s: of the fastest particle or surface
    double density_error_mean = 0.0, density_error_max = 0.0;  // of max(0, density / rest - 1) as the substep found it
    std::uint32_t iterations = 0;                              // of the pressure solve
    bool converged = true;
};

// The scene's surfaces on the device.
class ColliderBuffer {
 public:
    explicit ColliderBuffer(Backend& backend) : backend_(backend) {}
    // As they are at `time`, with the velocities of the `dt` before it. Returns how many are enabled.
    std::uint32_t place(const std::vector<Collider>& colliders, double time, double dt, double scale);
    Buffer& buffer() { return *buffer_; }

 private:
    Backend& backend_;
    std::unique_ptr<Buffer> buffer_;
};

// All a method works with, and the phases that every method has.
struct Substep {
    const Parameters& parameters;
    const std::vector<Collider>& scene_colliders;
    double time, remaining;  // s: of the simulation, and of the frame
    Backend& backend;
    Particles& particles;
    Neighborhood& neighborhood;
    ColliderBuffer& colliders;
    Buffer& extremes;  // what choose_time_step works in
    StepConstants constants;
    SubstepReport report;

    // Surfaces at the start of the substep, as walls; and at its end, to collide with.
    void place_walls();
    void place_colliders();
    // From what the particles do now (and did last, for the acceleration); sets constants.dt and the report.
    void choose_time_step();
    // Each adds to the acceleration. packed_position: x, y, z and the volume over `volume_scale`.
    void add_surface_tension(Buffer& packed_position, float volume_scale);
    void add_external_force();
};

class Method {
 public:
    virtual ~Method() = default;
    // The particles are sorted and the grid is in the constants; afterwards they are where they are after dt.
    virtual void advance(Substep& substep) = 0;
    // Whether the last substep may have crowded particles. Then they are sorted again before their frame is done, and
    // moved apart; and all that hosts read is computed anew. Once: a frame that then lacks memory is tried again.
    virtual bool may_be_crowded() const { return false; }
    virtual void end_frame(Substep&) {}
};

// name: a choice of fluid.method.
std::unique_ptr<Method> make_method(const std::string& name, Backend& backend);
// Bytes on a device beside what every method needs.
std::uint64_t method_bytes(const std::string& name, std::uint64_t particle_count, const DeviceInfo& device);

}  // namespace fontana
