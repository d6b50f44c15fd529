// The kernels as C++ on all cores of the host.
#pragma once

#include <memory>
#include <vector>

#include "backends/backend.h"

namespace fontana {

std::vector<DeviceInfo> list_cpu_devices();
std::unique_ptr<Backend> make_cpu_backend(const BackendOptions& options);

}  // namespace fontana
