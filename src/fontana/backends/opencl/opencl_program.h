// The device program: all kernels, compiled for one device.
#pragma once

#include "backends/opencl/opencl_api.h"
#include "backends/opencl/opencl_devices.h"

namespace fontana {

// From the kernel cache, or compiled and then kept there. Throws DEVICE_UNAVAILABLE with the compiler's first lines and
// where its whole log is.
OpenClProgram build_opencl_program(cl_context context, const OpenClDevice& device, bool strict);

}  // namespace fontana
