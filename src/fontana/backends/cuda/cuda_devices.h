// The CUDA devices of this machine.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "backends/backend.h"
#include "backends/cuda/cuda_types.h"

namespace fontana {

struct CudaDevice {
    DeviceInfo info;  // for a machine without a driver or a GPU: the reason
    CUdevice id = -1;
    int capability = 0;          // compute capability, ten times major and minor: 75 is 7.5
    std::string driver_version;  // of CUDA, the latest that the driver knows: "12.4"
    // What NVRTC compiles for: "sm_75" for the device itself, "compute_75" for an older one where NVRTC is older than
    // the device, whose driver then translates.
    std::string architecture;
    std::size_t group_size = 0;  // threads in a block: what kernels are launched with
};

// In the order of preference: usable devices as the driver has them, then what cannot be used and why. The order is the
// meaning of BackendOptions::device.
std::vector<CudaDevice> find_cuda_devices();

}  // namespace fontana
