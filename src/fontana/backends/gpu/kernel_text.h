// The text of a device program: all kernels of the core and the sort, as cmake/EmbedKernels.cmake put them into the
// library, or a kernel of a plugin's own. One text for OpenCL and CUDA.
#pragma once

#include <cstddef>

namespace fontana {

extern const char* const gpu_kernel_text[];
extern const std::size_t gpu_kernel_text_count;

// Pieces to be taken together in order.
struct GpuText {
    const char* const* pieces;
    std::size_t piece_count;
};
inline GpuText core_text() { return {gpu_kernel_text, gpu_kernel_text_count}; }

}  // namespace fontana
