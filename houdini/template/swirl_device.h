// What the node does, free of Houdini: a device, the kernel compiled for it, and a buffer.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>

#include "backends/backend.h"

struct SwirlSettings {
    float centre_x = 0.0f, centre_z = 0.0f;  // of the axis
    float angle = 1.5708f;                   // radians in all, at the axis
    float radius = 1.0f;                     // where it is half of that
    int step_count = 32;
};

class SwirlDevice {
 public:
    // backend: "auto", "cpu", "opencl" or "cuda". Starting a device and compiling for it takes long: keep it.
    // Throws fontana::Error with DEVICE_UNAVAILABLE and the reason.
    explicit SwirlDevice(const std::string& backend);

    const std::string& backend_name() const { return backend_name_; }  // as asked for
    const fontana::DeviceInfo& info() const { return backend_->device(); }

    // Asked after each step with the finished share; true stops.
    using IsInterrupted = std::function<bool(double)>;

    // Moves points, three floats each. Where it was stopped it returns false and has changed nothing. Throws
    // fontana::Error with OUT_OF_MEMORY or DEVICE_LOST; after the latter this object is of no more use.
    bool move(float* position, std::size_t point_count, const SwirlSettings& settings,
              const IsInterrupted& is_interrupted);

 private:
    fontana::Buffer& buffer_for(std::size_t bytes);

    std::string backend_name_;
    std::unique_ptr<fontana::Backend> backend_;
    std::unique_ptr<fontana::CompiledKernel> swirl_;
    std::unique_ptr<fontana::Buffer> position_;
};
