// The CUDA driver, opened at run time: Fontana builds and starts without it, and the first machine that has one uses
// it. A function of the driver is called as cuda().cuStreamSynchronize(stream).
#pragma once

#include <string>

#include "backends/cuda/cuda_types.h"

namespace fontana {

struct CudaApi {
#define CUDA_FUNCTION(name, symbol, parameters) CUresult(*name) parameters = nullptr;
#define OPTIONAL_CUDA_FUNCTION(name, symbol, parameters) CUDA_FUNCTION(name, symbol, parameters)
#include "backends/cuda/cuda_functions.def"
#undef OPTIONAL_CUDA_FUNCTION
#undef CUDA_FUNCTION
};

// Opens the driver unless it is open: the one FONTANA_CUDA_LIBRARY names, else the system's. Returns "", or why there
// is none and what to do about it; the next call tries again.
std::string open_cuda();

// Only after open_cuda() returned "".
const CudaApi& cuda();

}  // namespace fontana
