// The CUDA driver's error codes in words.
#pragma once

#include <string>

#include "backends/cuda/cuda_types.h"

namespace fontana {

// "CUDA_ERROR_ILLEGAL_ADDRESS (700)"; "CUDA error 9999" for one that the driver does not know.
std::string cuda_error_name(CUresult code);

// The status of a call that failed before the device was in use.
[[noreturn]] void fail_to_start_cuda(CUresult code, const std::string& device, const std::string& call);

}  // namespace fontana
