#include "backends/opencl/opencl_api.h"

#include <dlfcn.h>

#include <cstdlib>
#include <mutex>
#include <vector>

namespace fontana {

const char* const k_opencl_remedy =
    "pip install pyopencl pocl-binary-distribution, or install your GPU vendor's driver";

namespace {

struct LoadedLibrary {
    std::mutex mutex;
    OpenClApi api;
    bool is_open = false;
};

LoadedLibrary& loaded_library() {
    static LoadedLibrary library;
    return library;
}

std::string last_loader_message() {
    const char* message = dlerror();
    return message ? message : "no reason given";
}

// The loader inside the pyopencl wheel dereferences PYOPENCL_HOME unseen; a sentence is better than its crash.
std::string why_not_to_open(const std::string& path) {
    const bool in_pyopencl = path.find("/pyopencl/.libs/") != std::string::npos;
    if (!in_pyopencl || std::getenv("PYOPENCL_HOME")) return "";
    return "FONTANA_OPENCL_LIBRARY is '" + path +
           "', which crashes unless PYOPENCL_HOME names the folder 'pyopencl' it lies in: set that too";
}

// Fills in the table. Returns "" or the function that is missing. The handle is kept open for the life of the process:
// drivers have threads that do not survive being unloaded.
std::string fill_table(void* handle, OpenClApi& api) {
#define OPENCL_FUNCTION(function)                                                      \
    api.function = reinterpret_cast<decltype(api.function)>(dlsym(handle, #function)); \
    if (!api.function) return #function;
#include "backends/opencl/opencl_functions.def"
#undef OPENCL_FUNCTION
    return "";
}

std::string open_library(const std::string& path, OpenClApi& api) {
    void* handle = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!handle) return last_loader_message();
    const std::string missing = fill_table(handle, api);
    if (missing.empty()) return "";
    dlclose(handle);
    return "it has no function " + missing + ", which OpenCL 1.2 requires";
}

std::string open_chosen(const std::string& path, OpenClApi& api) {
    std::string reason = why_not_to_open(path);
    if (!reason.empty()) return reason;
    reason = open_library(path, api);
    if (reason.empty()) return "";
    return "FONTANA_OPENCL_LIBRARY is '" + path + "', which cannot be used (" + reason +
           "): unset it, or give the path of a libOpenCL";
}

std::string open_system_library(OpenClApi& api) {
#if defined(__APPLE__)
    const std::vector<std::string> paths = {"/System/Library/Frameworks/OpenCL.framework/OpenCL"};
#else
    const std::vector<std::string> paths = {"libOpenCL.so.1", "libOpenCL.so"};
#endif
    std::string first_reason;
    for (const std::string& path : paths) {
        const std::string reason = open_library(path, api);
        if (reason.empty()) return "";
        if (first_reason.empty()) first_reason = reason;
    }
    return "no OpenCL library (" + first_reason + "): " + k_opencl_remedy;
}

}  // namespace

std::string open_opencl() {
    LoadedLibrary& library = loaded_library();
    const std::lock_guard<std::mutex> lock(library.mutex);
    if (library.is_open) return "";
    const char* chosen = std::getenv("FONTANA_OPENCL_LIBRARY");
    const std::string reason = chosen && *chosen ? open_chosen(chosen, library.api) : open_system_library(library.api);
    library.is_open = reason.empty();
    return reason;
}

const OpenClApi& opencl() { return loaded_library().api; }

}  // namespace fontana
