// The neighbour schemes of a GPU, and which kernels have a second loop for tiles, in tiles.inl.
#pragma once

#include <string>

namespace fontana {

constexpr const char* k_gpu_neighbors = "grid|tiles|all-pairs";  // DeviceInfo::neighbors

// The function of the device program that a kernel is launched as.
inline std::string function_of(const std::string& kernel, bool tiles) {
    const bool has_tiles = kernel == "density" || kernel == "fluid_force";
    return tiles && has_tiles ? kernel + "_tiles" : kernel;
}

}  // namespace fontana
