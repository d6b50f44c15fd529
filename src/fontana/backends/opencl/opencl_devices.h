// The OpenCL devices of this machine.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "backends/backend.h"
#include "backends/opencl/opencl_api.h"

namespace fontana {

struct OpenClDevice {
    DeviceInfo info;  // for a platform without devices, or no platform at all: the reason, and no id
    cl_device_id id = nullptr;
    std::string platform_version;
    std::size_t largest_allocation = 0;  // bytes
    std::size_t group_size = 0;          // work-items in a group: what kernels are launched with
    bool rounds_divisions_correctly = false;
};

// In the order of preference: usable GPUs, other usable devices, then what cannot be used and why. The order is the
// meaning of BackendOptions::device.
std::vector<OpenClDevice> find_opencl_devices();

}  // namespace fontana
