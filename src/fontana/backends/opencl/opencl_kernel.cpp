#include "backends/opencl/opencl_kernel.h"

#include <algorithm>

#include "backends/opencl/opencl_error.h"
#include "util/error.h"

namespace fontana {

DeviceKernel::DeviceKernel(const OpenClDevice& device, cl_program program, const std::string& function,
                           const std::string& label)
    : label_(label) {
    const std::string& name = device.info.name;
    cl_int code = CL_SUCCESS;
    kernel_.reset(opencl().clCreateKernel(program, function.c_str(), &code));
    if (code != CL_SUCCESS) fail_to_start(code, name, "clCreateKernel of " + function);
    cl_uint argument_count = 0;
    code = opencl().clGetKernelInfo(kernel_.get(), CL_KERNEL_NUM_ARGS, sizeof argument_count, &argument_count, nullptr);
    if (code != CL_SUCCESS) fail_to_start(code, name, "clGetKernelInfo of " + function);
    argument_count_ = argument_count;
    std::size_t limit = 0;  // by the registers this kernel needs
    code = opencl().clGetKernelWorkGroupInfo(kernel_.get(), device.id, CL_KERNEL_WORK_GROUP_SIZE, sizeof limit, &limit,
                                             nullptr);
    if (code != CL_SUCCESS) fail_to_start(code, name, "clGetKernelWorkGroupInfo of " + function);
    group_size_ = std::clamp<std::size_t>(limit, 1, device.group_size);
}

void DeviceKernel::launch(CommandQueue& queue, std::size_t thread_count, KernelArguments arguments) {
    queue.require_alive();
    if (arguments.size() != argument_count_)
        fail(FONTANA_INTERNAL, "the kernel " + label_ + " takes " + std::to_string(argument_count_) +
                                   " arguments and was given " + std::to_string(arguments.size()));
    std::size_t index = 0;
    for (const KernelArgument& argument : arguments) set_argument(queue, index++, argument);
    queue.launch(kernel_.get(), thread_count, group_size_, label_, element_count(arguments));
}

void DeviceKernel::set_argument(CommandQueue& queue, std::size_t index, const KernelArgument& argument) {
    const cl_mem memory = argument.buffer() ? memory_of(*argument.buffer()) : nullptr;
    const void* value = argument.buffer() ? &memory : argument.value();
    const std::size_t bytes = argument.buffer() ? sizeof memory : argument.value_bytes();
    const cl_int code = opencl().clSetKernelArg(kernel_.get(), static_cast<cl_uint>(index), bytes, value);
    if (code == CL_INVALID_ARG_SIZE || code == CL_INVALID_ARG_VALUE)
        fail(FONTANA_INTERNAL, "argument " + std::to_string(index) + " of the kernel " + label_ + " has " +
                                   std::to_string(bytes) + " bytes, which its text does not expect");
    queue.check(code, "setting an argument of the kernel", label_);
}

}  // namespace fontana
