// What to say when a device compiler refuses the kernels.
#pragma once

#include <string>

#include "backends/gpu/kernel_cache.h"

namespace fontana {

// Throws DEVICE_UNAVAILABLE with the log's first lines and where the whole of it is. `device` is as in "the OpenCL
// device 'name' (driver)".
[[noreturn]] void fail_to_build(const std::string& device, const std::string& log, const KernelCache& cache,
                                const std::string& key);

}  // namespace fontana
