// Which kernels have a second loop, in tiles.inl.
#pragma once

#include <string>

namespace fontana {

// The function of the device program that a kernel is launched as.
inline std::string function_of(const std::string& kernel, bool tiles) {
    const bool has_tiles = kernel == "density" || kernel == "fluid_force";
    return tiles && has_tiles ? kernel + "_tiles" : kernel;
}

}  // namespace fontana
