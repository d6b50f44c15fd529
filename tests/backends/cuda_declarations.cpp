// Compiles only if our declarations of the CUDA driver and NVRTC agree with their maker's headers: the same number of
// parameters, each of the same size and kind, and the same numbers for constants.
#include <cuda.h>
#include <nvrtc.h>

#include <cstddef>
#include <type_traits>

#include "backends/cuda/cuda_types.h"

namespace {

// Enumerations are their integers; pointers may differ in what they point at, which we name otherwise or not at all.
template <typename Ours, typename Theirs>
constexpr bool fits() {
    const bool both_pointers = std::is_pointer_v<Ours> && std::is_pointer_v<Theirs>;
    const bool both_numbers =
        (std::is_integral_v<Ours> || std::is_enum_v<Ours>) && (std::is_integral_v<Theirs> || std::is_enum_v<Theirs>);
    return sizeof(Ours) == sizeof(Theirs) && (both_pointers || both_numbers);
}

template <typename Ours, typename Theirs>
struct Agree;

template <typename OurResult, typename... Ours, typename TheirResult, typename... Theirs>
struct Agree<OurResult (*)(Ours...), TheirResult (*)(Theirs...)> {
    static constexpr bool value() {
        if constexpr (sizeof...(Ours) == sizeof...(Theirs))
            return fits<OurResult, TheirResult>() && (fits<Ours, Theirs>() && ...);
        else
            return false;
    }
};

}  // namespace

namespace ours {

using namespace fontana;
using fontana::CUcontext;
using fontana::CUdevice;
using fontana::CUdeviceptr;
using fontana::CUevent;
using fontana::CUfunction;
using fontana::CUmodule;
using fontana::CUresult;
using fontana::CUstream;
using fontana::nvrtcProgram;
using fontana::nvrtcResult;

#define CUDA_FUNCTION(name, symbol, parameters) using Of_##name = CUresult(*) parameters;
#define OPTIONAL_CUDA_FUNCTION CUDA_FUNCTION
#define NVRTC_FUNCTION(name, result, parameters) using Of_##name = result(*) parameters;
#include "backends/cuda/cuda_functions.def"
#include "backends/cuda/nvrtc_functions.def"
#undef NVRTC_FUNCTION
#undef OPTIONAL_CUDA_FUNCTION
#undef CUDA_FUNCTION

}  // namespace ours

#define CUDA_FUNCTION(name, symbol, parameters) \
    static_assert(Agree<ours::Of_##name, decltype(&::name)>::value(), #name);
#define OPTIONAL_CUDA_FUNCTION CUDA_FUNCTION
#define NVRTC_FUNCTION(name, result, parameters) CUDA_FUNCTION(name, #name, parameters)
#include "backends/cuda/cuda_functions.def"
#include "backends/cuda/nvrtc_functions.def"

#define SAME(constant) static_assert(static_cast<int>(fontana::constant) == static_cast<int>(::constant), #constant);
SAME(CUDA_SUCCESS)
SAME(CUDA_ERROR_INVALID_VALUE)
SAME(CUDA_ERROR_OUT_OF_MEMORY)
SAME(CUDA_ERROR_NO_DEVICE)
SAME(CUDA_ERROR_INVALID_IMAGE)
SAME(CUDA_ERROR_NO_BINARY_FOR_GPU)
SAME(CUDA_ERROR_INVALID_PTX)
SAME(CUDA_ERROR_JIT_COMPILER_NOT_FOUND)
SAME(CUDA_ERROR_UNSUPPORTED_PTX_VERSION)
SAME(CUDA_ERROR_JIT_COMPILATION_DISABLED)
SAME(CU_DEVICE_ATTRIBUTE_MAX_THREADS_PER_BLOCK)
SAME(CU_DEVICE_ATTRIBUTE_MULTIPROCESSOR_COUNT)
SAME(CU_DEVICE_ATTRIBUTE_COMPUTE_MODE)
SAME(CU_DEVICE_ATTRIBUTE_COMPUTE_CAPABILITY_MAJOR)
SAME(CU_DEVICE_ATTRIBUTE_COMPUTE_CAPABILITY_MINOR)
SAME(CU_COMPUTEMODE_PROHIBITED)
SAME(CU_FUNC_ATTRIBUTE_MAX_THREADS_PER_BLOCK)
SAME(CU_STREAM_NON_BLOCKING)
SAME(NVRTC_SUCCESS)
SAME(NVRTC_ERROR_OUT_OF_MEMORY)
SAME(NVRTC_ERROR_COMPILATION)
