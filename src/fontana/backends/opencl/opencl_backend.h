// The kernels through OpenCL 1.2, on any vendor's device. The loader is opened at run time: nothing is linked.
#pragma once

#include <memory>
#include <vector>

#include "backends/backend.h"

namespace fontana {

std::vector<DeviceInfo> list_opencl_devices();
std::unique_ptr<Backend> make_opencl_backend(const BackendOptions& options);

}  // namespace fontana
