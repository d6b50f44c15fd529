// The kernels on NVIDIA's GPUs: compiled by NVRTC at run time, launched through the driver interface. Both libraries
// are opened at run time: nothing is linked, and no toolkit is needed to build.
#pragma once

#include <memory>
#include <vector>

#include "backends/backend.h"

namespace fontana {

std::vector<DeviceInfo> list_cuda_devices();
std::unique_ptr<Backend> make_cuda_backend(const BackendOptions& options);

}  // namespace fontana
