// A kernel of the device program, launched with checked arguments.
#pragma once

#include <cstddef>
#include <string>

#include "backends/backend.h"
#include "backends/opencl/opencl_queue.h"

namespace fontana {

class DeviceKernel {
 public:
    // `function` is its name in the program, `label` the one in the profile and in errors.
    DeviceKernel(const OpenClDevice& device, cl_program program, const std::string& function, const std::string& label);

    void launch(CommandQueue& queue, std::size_t thread_count, KernelArguments arguments);

 private:
    void set_argument(CommandQueue& queue, std::size_t index, const KernelArgument& argument);

    std::string label_;
    OpenClKernel kernel_;
    std::size_t argument_count_ = 0;
    std::size_t group_size_ = 0;
};

}  // namespace fontana
