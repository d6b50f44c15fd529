// The OpenCL library, opened at run time: Fontana builds and starts without it, and the first machine that has one uses
// it. A function of the library is called as opencl().clFinish(queue).
#pragma once

#include <memory>
#include <string>
#include <type_traits>

#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>

namespace fontana {

struct OpenClApi {
#define OPENCL_FUNCTION(function) decltype(&::function) function = nullptr;
#include "backends/opencl/opencl_functions.def"
#undef OPENCL_FUNCTION
};

// Opens the library unless it is open: the one FONTANA_OPENCL_LIBRARY names, else the system's. Returns "", or why
// there is none and what to do about it; the next call tries again.
std::string open_opencl();

// Only after open_opencl() returned "".
const OpenClApi& opencl();

// What a machine without a usable OpenCL device can do, as the end of a sentence.
extern const char* const k_opencl_remedy;

// Owners of OpenCL objects. An error on release has no remedy and is not looked at.
template <auto release>
struct OpenClReleaser {
    template <typename T>
    void operator()(T* object) const {
        (opencl().*release)(object);
    }
};
using OpenClContext = std::unique_ptr<_cl_context, OpenClReleaser<&OpenClApi::clReleaseContext>>;
using OpenClQueue = std::unique_ptr<_cl_command_queue, OpenClReleaser<&OpenClApi::clReleaseCommandQueue>>;
using OpenClProgram = std::unique_ptr<_cl_program, OpenClReleaser<&OpenClApi::clReleaseProgram>>;
using OpenClKernel = std::unique_ptr<_cl_kernel, OpenClReleaser<&OpenClApi::clReleaseKernel>>;
using OpenClMemory = std::unique_ptr<_cl_mem, OpenClReleaser<&OpenClApi::clReleaseMemObject>>;
using OpenClEvent = std::unique_ptr<_cl_event, OpenClReleaser<&OpenClApi::clReleaseEvent>>;

}  // namespace fontana
