#include "backends/cuda/cuda_context.h"

#include "backends/cuda/cuda_error.h"

namespace fontana {

CudaContext::CudaContext(const CudaDevice& device) {
    const CUresult code = cuda().cuCtxCreate(&context_, 0, device.id);
    if (code != CUDA_SUCCESS) fail_to_start_cuda(code, device.info.name, "cuCtxCreate");
    CUcontext popped = nullptr;  // creating it has made it current, and the host may have one of its own
    cuda().cuCtxPopCurrent(&popped);
}

CudaContext::~CudaContext() { cuda().cuCtxDestroy(context_); }

}  // namespace fontana
