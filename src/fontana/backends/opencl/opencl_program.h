// The device program: all kernels, or one of a plugin's own, compiled for one device.
#pragma once

#include "backends/gpu/kernel_text.h"
#include "backends/opencl/opencl_api.h"
#include "backends/opencl/opencl_devices.h"

namespace fontana {

// From the kernel cache, or compiled and then kept there. Throws DEVICE_UNAVAILABLE with the compiler's first lines and
// where its whole log is.
OpenClProgram build_opencl_program(cl_context context, const OpenClDevice& device, GpuText text, bool strict);

}  // namespace fontana
