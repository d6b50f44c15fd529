// The device program: all kernels, or one of a plugin's own, compiled for one device.
#pragma once

#include "backends/cuda/cuda_context.h"
#include "backends/cuda/cuda_stream.h"
#include "backends/gpu/kernel_text.h"

namespace fontana {

// From the kernel cache, or compiled by NVRTC and then kept there. Throws DEVICE_UNAVAILABLE with the compiler's first
// lines and where its whole log is.
CudaModule build_cuda_program(const CudaStream& stream, GpuText text, bool strict);

}  // namespace fontana
