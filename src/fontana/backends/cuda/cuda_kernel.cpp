#include "backends/cuda/cuda_kernel.h"

#include <algorithm>

#include "backends/cuda/cuda_error.h"
#include "util/error.h"

namespace fontana {
namespace {

constexpr std::size_t k_most_arguments = 32;

std::size_t bytes_of(const KernelArgument& argument) {
    return argument.buffer() ? sizeof(CUdeviceptr) : argument.value_bytes();
}

}  // namespace

CudaKernel::CudaKernel(const CudaStream& stream, CUmodule program, const std::string& function,
                       const std::string& label)
    : label_(label) {
    const std::string& name = stream.device().info.name;
    const CurrentContext current(*stream.context());
    if (current.code() != CUDA_SUCCESS) fail_to_start_cuda(current.code(), name, "cuCtxPushCurrent");
    CUresult code = cuda().cuModuleGetFunction(&function_, program, function.c_str());
    if (code != CUDA_SUCCESS) fail_to_start_cuda(code, name, "cuModuleGetFunction of " + function);
    int limit = 0;  // by the registers this kernel needs
    code = cuda().cuFuncGetAttribute(&limit, CU_FUNC_ATTRIBUTE_MAX_THREADS_PER_BLOCK, function_);
    if (code != CUDA_SUCCESS) fail_to_start_cuda(code, name, "cuFuncGetAttribute of " + function);
    group_size_ = std::clamp<std::size_t>(static_cast<std::size_t>(std::max(limit, 1)), 1, stream.device().group_size);
    read_parameters(name, function);
}

// A launch with the wrong arguments is undefined and goes unseen by a driver, so the sizes are asked for where they can
// be. The end of the list is an error of its own.
void CudaKernel::read_parameters(const std::string& device, const std::string& function) {
    if (!cuda().cuFuncGetParamInfo) return;
    has_parameters_ = true;
    CUresult code = CUDA_SUCCESS;
    while (code == CUDA_SUCCESS) {
        std::size_t offset = 0, bytes = 0;
        code = cuda().cuFuncGetParamInfo(function_, parameter_bytes_.size(), &offset, &bytes);
        if (code == CUDA_SUCCESS) parameter_bytes_.push_back(bytes);
    }
    if (code != CUDA_ERROR_INVALID_VALUE) fail_to_start_cuda(code, device, "cuFuncGetParamInfo of " + function);
}

void CudaKernel::launch(CudaStream& stream, std::size_t thread_count, KernelArguments arguments) {
    stream.require_alive();
    require_fitting(arguments);
    CUdeviceptr memory[k_most_arguments];
    void* addresses[k_most_arguments + 1] = {};
    std::size_t index = 0;
    for (const KernelArgument& argument : arguments) {
        if (argument.buffer()) memory[index] = memory_of(*argument.buffer());
        addresses[index] = argument.buffer() ? &memory[index] : const_cast<void*>(argument.value());
        ++index;
    }
    stream.launch(function_, thread_count, group_size_, addresses, label_, element_count(arguments));
}

void CudaKernel::require_fitting(KernelArguments arguments) const {
    const std::size_t expected =
        has_parameters_ ? parameter_bytes_.size() : std::min(arguments.size(), k_most_arguments);
    if (arguments.size() != expected || expected > k_most_arguments)
        fail(FONTANA_INTERNAL, "the kernel " + label_ + " takes " + std::to_string(expected) +
                                   " arguments and was given " + std::to_string(arguments.size()));
    if (!has_parameters_) return;
    std::size_t index = 0;
    for (const KernelArgument& argument : arguments) {
        if (bytes_of(argument) != parameter_bytes_[index])
            fail(FONTANA_INTERNAL, "argument " + std::to_string(index) + " of the kernel " + label_ + " has " +
                                       std::to_string(bytes_of(argument)) + " bytes, which its text does not expect");
        ++index;
    }
}

}  // namespace fontana
