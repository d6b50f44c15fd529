// The device program: all kernels, compiled for one device.
#pragma once

#include "backends/cuda/cuda_context.h"
#include "backends/cuda/cuda_stream.h"

namespace fontana {

// From the kernel cache, or compiled by NVRTC and then kept there. Throws DEVICE_UNAVAILABLE with the compiler's first
// lines and where its whole log is.
CudaModule build_cuda_program(const CudaStream& stream, bool strict);

}  // namespace fontana
