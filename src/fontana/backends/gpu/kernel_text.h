// The text of all device kernels, and of the sort, as cmake/EmbedKernels.cmake put it into the library: pieces to be
// taken together in order. One text for OpenCL and CUDA.
#pragma once

#include <cstddef>

namespace fontana {

extern const char* const gpu_kernel_text[];
extern const std::size_t gpu_kernel_text_count;

}  // namespace fontana
