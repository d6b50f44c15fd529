// The device program: all kernels, or one of a plugin's own, compiled for one device.
#pragma once

#include <cstddef>

#include "backends/opencl/opencl_api.h"
#include "backends/opencl/opencl_devices.h"

namespace fontana {

// Pieces of a program's text, to be taken together in order.
struct OpenClText {
    const char* const* pieces;
    std::size_t piece_count;
};
// All kernels of the core, and the sort.
OpenClText core_text();

// From the kernel cache, or compiled and then kept there. Throws DEVICE_UNAVAILABLE with the compiler's first lines and
// where its whole log is.
OpenClProgram build_opencl_program(cl_context context, const OpenClDevice& device, OpenClText text, bool strict);

}  // namespace fontana
