// The device types of OpenCL C and CUDA, as the C++ build of the kernels sees them.
#pragma once

#include <cstdint>

using uint = std::uint32_t;

struct alignas(16) float4 {
    float x, y, z, w;
};
