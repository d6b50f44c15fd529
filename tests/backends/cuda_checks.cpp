#include "backends/cuda/cuda_devices.h"
#include "backends/cuda/cuda_kernel.h"
#include "backends/cuda/cuda_program.h"
#include "backends/cuda/cuda_stream.h"
#include "gpu_checks.h"

namespace {

struct Device {
    using Queue = fontana::CudaStream;
    using Program = fontana::CudaModule;
    using Kernel = fontana::CudaKernel;

    Queue make_queue(bool profile) { return Queue(fontana::find_cuda_devices().front(), profile); }
    Program build(Queue& queue) { return fontana::build_cuda_program(queue, fontana::core_text(), false); }
    Kernel kernel(Queue& queue, Program& program, const char* function, const char* label) {
        return Kernel(queue, program.get(), function, label);
    }
    std::size_t group_size(Queue& queue) { return queue.device().group_size; }
    std::size_t too_many_bytes(Queue& queue) { return queue.device().info.memory_bytes + 1; }
    const char* missing_kernel = "cuModuleGetFunction of no_such_kernel";
};

}  // namespace

int main() { return gpu_checks::run_checks(Device()); }
