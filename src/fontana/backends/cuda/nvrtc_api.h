// NVRTC, NVIDIA's compiler as a library, opened at run time. It needs no GPU.
#pragma once

#include <string>
#include <vector>

#include "backends/cuda/cuda_types.h"

namespace fontana {

struct NvrtcApi {
#define NVRTC_FUNCTION(name, result, parameters) result(*name) parameters = nullptr;
#include "backends/cuda/nvrtc_functions.def"
#undef NVRTC_FUNCTION
};

// Opens NVRTC unless it is open: the one FONTANA_NVRTC_LIBRARY names, else the system's latest. Returns "", or why
// there is none and what to do about it; the next call tries again.
std::string open_nvrtc();

// Only after open_nvrtc() returned "".
const NvrtcApi& nvrtc();

// "12.9"; "unknown" where it does not say.
std::string nvrtc_version();

// The compute capabilities it compiles for, ten times major and minor, in rising order: 75 is 7.5. None where it does
// not say.
std::vector<int> nvrtc_capabilities();

// "NVRTC_ERROR_COMPILATION (6)"
std::string nvrtc_error_name(nvrtcResult code);

// What brings a compiler that every driver of the last years can follow, as the end of a sentence.
extern const char* const k_nvrtc_remedy;

}  // namespace fontana
