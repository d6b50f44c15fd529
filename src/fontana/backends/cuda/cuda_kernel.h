// A kernel of the device program, launched with checked arguments.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "backends/backend.h"
#include "backends/cuda/cuda_stream.h"

namespace fontana {

class CudaKernel {
 public:
    // `function` is its name in the program, `label` the one in the profile and in errors.
    CudaKernel(const CudaStream& stream, CUmodule program, const std::string& function, const std::string& label);

    void launch(CudaStream& stream, std::size_t thread_count, KernelArguments arguments);

 private:
    void read_parameters(const std::string& device, const std::string& function);
    void require_fitting(KernelArguments arguments) const;

    std::string label_;
    CUfunction function_ = nullptr;  // of the program, which outlives it
    std::size_t group_size_ = 0;
    bool has_parameters_ = false;               // whether the driver can tell (CUDA 12.4)
    std::vector<std::size_t> parameter_bytes_;  // as the compiled kernel has them
};

}  // namespace fontana
