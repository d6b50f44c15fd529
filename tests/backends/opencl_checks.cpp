#include "backends/opencl/opencl_devices.h"
#include "backends/opencl/opencl_kernel.h"
#include "backends/opencl/opencl_program.h"
#include "backends/opencl/opencl_queue.h"
#include "gpu_checks.h"

namespace {

struct Device {
    using Queue = fontana::CommandQueue;
    using Program = fontana::OpenClProgram;
    using Kernel = fontana::DeviceKernel;

    Queue make_queue(bool profile) { return Queue(fontana::find_opencl_devices().front(), profile); }
    Program build(Queue& queue) {
        return fontana::build_opencl_program(queue.context(), queue.device(), fontana::core_text(), false);
    }
    Kernel kernel(Queue& queue, Program& program, const char* function, const char* label) {
        return Kernel(queue.device(), program.get(), function, label);
    }
    std::size_t group_size(Queue& queue) { return queue.device().group_size; }
    std::size_t too_many_bytes(Queue& queue) { return queue.device().largest_allocation + 1; }
    const char* missing_kernel = "clCreateKernel of no_such_kernel";
};

}  // namespace

int main() { return gpu_checks::run_checks(Device()); }
