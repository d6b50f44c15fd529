// Text in, images of a device program out: NVRTC for one compilation.
#pragma once

#include <string>
#include <vector>

namespace fontana {

struct CompiledImages {
    // Machine code, where it was compiled for the device itself, and PTX, which the driver translates.
    std::vector<unsigned char> machine_code, ptx;
    std::string log;  // what the compiler said, where it refused the text
    bool is_refused = false;
};

// Throws DEVICE_UNAVAILABLE or OUT_OF_MEMORY where NVRTC itself fails.
CompiledImages compile_with_nvrtc(const std::string& text, const std::vector<std::string>& options);

}  // namespace fontana
