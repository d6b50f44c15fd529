// What a device is, and what its kernels took.
#pragma once

#include <cstdint>

#include "bindings.h"

namespace fontana_python {

struct Device {
    explicit Device(const fontana_device& device);

    std::string backend, name, driver, reason, neighbors;
    std::uint64_t memory_bytes;
    std::uint32_t compute_units;
    bool is_gpu, available;
};

struct KernelProfile {
    KernelProfile(const fontana_kernel_profile& row);

    std::string name;
    std::uint64_t launches, elements;
    double seconds, bytes, flops;
};

}  // namespace fontana_python
