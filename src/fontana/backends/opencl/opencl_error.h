// OpenCL's error codes in words.
#pragma once

#include <string>

#include "backends/opencl/opencl_api.h"

namespace fontana {

// "CL_OUT_OF_RESOURCES (-5)"; "OpenCL error -9999" for one outside the standard.
std::string opencl_error_name(cl_int code);

// Whether the device or its driver ran out of memory, so that a smaller problem may work.
bool is_out_of_memory(cl_int code);

// The status of a call that failed before the device was in use.
[[noreturn]] void fail_to_start(cl_int code, const std::string& device, const std::string& call);

}  // namespace fontana
