// NVRTC with faults: hands every call on to the real library, which FONTANA_STAND_IN_NVRTC names, but for the one that
// a test has armed.
#include <dlfcn.h>

#include <cstdio>
#include <cstdlib>
#include <vector>

#include "backends/cuda/cuda_types.h"
#include "faults.h"

using namespace fontana;

namespace {

void* function_of_real(const char* name) {
    static void* const library = dlopen(std::getenv("FONTANA_STAND_IN_NVRTC"), RTLD_NOW | RTLD_LOCAL);
    if (library) return dlsym(library, name);
    std::fprintf(stderr, "stand-in driver: FONTANA_STAND_IN_NVRTC: %s\n", dlerror());
    std::exit(1);
}

// With one option more where FONTANA_STAND_IN_NVRTC_OPTION gives it: to break a build.
std::vector<const char*> extended(const char* const* options, int count) {
    std::vector<const char*> all(options, options + count);
    if (const char* more = std::getenv("FONTANA_STAND_IN_NVRTC_OPTION")) all.push_back(more);
    return all;
}

}  // namespace

#define LAYER(function, parameters, arguments)                                                     \
    extern "C" __attribute__((visibility("default"))) nvrtcResult function parameters {            \
        if (const int fault = stand_in::fault_of(#function)) return fault;                         \
        return reinterpret_cast<nvrtcResult(*) parameters>(function_of_real(#function)) arguments; \
    }

LAYER(nvrtcVersion, (int* major, int* minor), (major, minor))
LAYER(nvrtcGetNumSupportedArchs, (int* count), (count))
LAYER(nvrtcGetSupportedArchs, (int* capabilities), (capabilities))
LAYER(nvrtcCreateProgram,
      (nvrtcProgram * program, const char* text, const char* name, int header_count, const char* const* headers,
       const char* const* header_names),
      (program, text, name, header_count, headers, header_names))
LAYER(nvrtcDestroyProgram, (nvrtcProgram * program), (program))
LAYER(nvrtcCompileProgram, (nvrtcProgram program, int option_count, const char* const* options),
      (program, static_cast<int>(extended(options, option_count).size()), extended(options, option_count).data()))
LAYER(nvrtcGetProgramLogSize, (nvrtcProgram program, std::size_t* bytes), (program, bytes))
LAYER(nvrtcGetProgramLog, (nvrtcProgram program, char* log), (program, log))
LAYER(nvrtcGetCUBINSize, (nvrtcProgram program, std::size_t* bytes), (program, bytes))
LAYER(nvrtcGetCUBIN, (nvrtcProgram program, char* image), (program, image))
LAYER(nvrtcGetPTXSize, (nvrtcProgram program, std::size_t* bytes), (program, bytes))
LAYER(nvrtcGetPTX, (nvrtcProgram program, char* text), (program, text))

extern "C" __attribute__((visibility("default"))) const char* nvrtcGetErrorString(nvrtcResult code) {
    return reinterpret_cast<const char* (*)(nvrtcResult)>(function_of_real("nvrtcGetErrorString"))(code);
}
