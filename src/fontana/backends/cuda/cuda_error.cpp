#include "backends/cuda/cuda_error.h"

#include "backends/cuda/cuda_api.h"
#include "util/error.h"

namespace fontana {

std::string cuda_error_name(CUresult code) {
    const char* name = nullptr;
    if (cuda().cuGetErrorName(code, &name) != CUDA_SUCCESS || !name) return "CUDA error " + std::to_string(code);
    return std::string(name) + " (" + std::to_string(code) + ")";
}

void fail_to_start_cuda(CUresult code, const std::string& device, const std::string& call) {
    fail(code == CUDA_ERROR_OUT_OF_MEMORY ? FONTANA_OUT_OF_MEMORY : FONTANA_DEVICE_UNAVAILABLE,
         "the CUDA device '" + device + "' cannot be used: " + call + " failed with " + cuda_error_name(code));
}

}  // namespace fontana
