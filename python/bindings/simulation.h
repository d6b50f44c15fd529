// A simulation's handle as a Python object.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "arrays.h"
#include "bindings.h"
#include "devices.h"
#include "reports.h"

namespace fontana_python {

// Called with the finished share of a frame; what it returns stops the frame if it is true.
using ProgressFunction = std::function<nb::object(double)>;

class Simulation {
 public:
    Simulation();
    ~Simulation();
    Simulation(const Simulation&) = delete;
    Simulation& operator=(const Simulation&) = delete;

    // The scene (simulation_scene.cpp).
    void set(const std::string& name, const nb::object& value);
    nb::object get(const std::string& name);
    void apply_preset(const std::string& preset);
    std::size_t add_collider(const std::string& type, const nb::kwargs& fields);
    void set_collider(std::size_t index, const std::string& type, const nb::kwargs& fields);
    void set_collider_keys(std::size_t index, const std::vector<double>& times, const std::vector<Point>& centres);
    Point collider_centre(std::size_t index, double time);
    std::size_t collider_count() const;
    std::size_t add_emitter(const std::string& type, const nb::kwargs& fields);
    std::uint64_t emitted_by(std::int64_t frame);

    // What follows from it before a step (simulation_scene.cpp).
    void check_settings();
    fontana_derived derived();
    fontana_time_step_limits estimate_limits(double speed, double acceleration);
    std::uint64_t estimate_memory(std::uint64_t particle_count);

    // Particles as arrays (simulation_particles.cpp).
    void add_particles(const FloatArray& position, const std::optional<FloatArray>& velocity,
                       const std::optional<FloatArray>& mass);
    void set_force(const std::optional<FloatArray>& force);
    std::size_t particle_count() const;
    nb::list attributes() const;
    nb::object read(const std::string& name);
    NumpyArray<std::uint32_t> count_neighbors();

    // The run (simulation_run.cpp).
    FrameReport step_frame(std::optional<ProgressFunction> progress);
    std::int64_t frame() const;
    Device device();
    std::vector<KernelProfile> profile();
    double measure_copy(std::size_t bytes);
    void write_bgeo(const FilePath& path);
    void save_checkpoint(const FilePath& path, const std::string& tag);
    void load_checkpoint(const FilePath& path);

 private:
    template <typename T>
    nb::object filled(NumpyArray<T> array, const std::string& name);

    fontana_simulation* handle_ = nullptr;
};

}  // namespace fontana_python
