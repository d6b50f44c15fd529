#include "backends/cuda/nvrtc_api.h"

#include <algorithm>
#include <cstdlib>
#include <mutex>

#include "backends/cuda/shared_library.h"

namespace fontana {

const char* const k_nvrtc_remedy = "pip install nvidia-cuda-nvrtc-cu12";

namespace {

struct LoadedNvrtc {
    std::mutex mutex;
    NvrtcApi api;
    bool is_open = false;
};

LoadedNvrtc& loaded_nvrtc() {
    static LoadedNvrtc library;
    return library;
}

// Returns "" or the function that is missing.
std::string fill_table(SharedLibrary& library, NvrtcApi& api) {
#define NVRTC_FUNCTION(name, result, parameters) \
    if (!library.find(#name, api.name)) return #name;
#include "backends/cuda/nvrtc_functions.def"
#undef NVRTC_FUNCTION
    return "";
}

std::string open_library(const std::string& path, NvrtcApi& api) {
    SharedLibrary library(path);
    if (!library.is_open()) return library.reason();
    const std::string missing = fill_table(library, api);
    if (!missing.empty()) return "it has no function " + missing + ", which NVRTC 11.2 has";
    library.keep_open();
    return "";
}

std::string open_system_library(NvrtcApi& api) {
    std::string first_reason;
    for (const char* path : {"libnvrtc.so.13", "libnvrtc.so.12", "libnvrtc.so.11.2", "libnvrtc.so"}) {
        const std::string reason = open_library(path, api);
        if (reason.empty()) return "";
        if (first_reason.empty()) first_reason = reason;
    }
    return "no NVRTC, which compiles the kernels (" + first_reason + "): " + k_nvrtc_remedy;
}

}  // namespace

std::string open_nvrtc() {
    LoadedNvrtc& library = loaded_nvrtc();
    const std::lock_guard<std::mutex> lock(library.mutex);
    if (library.is_open) return "";
    const char* chosen = std::getenv("FONTANA_NVRTC_LIBRARY");
    const bool is_chosen = chosen && *chosen;
    const std::string reason = is_chosen ? open_library(chosen, library.api) : open_system_library(library.api);
    library.is_open = reason.empty();
    if (library.is_open || !is_chosen) return reason;
    return "FONTANA_NVRTC_LIBRARY is '" + std::string(chosen) + "', which cannot be used (" + reason +
           "): unset it, or give the path of a libnvrtc";
}

const NvrtcApi& nvrtc() { return loaded_nvrtc().api; }

std::string nvrtc_version() {
    int major = 0, minor = 0;
    if (nvrtc().nvrtcVersion(&major, &minor) != NVRTC_SUCCESS) return "unknown";
    return std::to_string(major) + "." + std::to_string(minor);
}

std::vector<int> nvrtc_capabilities() {
    int count = 0;
    if (nvrtc().nvrtcGetNumSupportedArchs(&count) != NVRTC_SUCCESS || count <= 0) return {};
    std::vector<int> capabilities(static_cast<std::size_t>(count));
    if (nvrtc().nvrtcGetSupportedArchs(capabilities.data()) != NVRTC_SUCCESS) return {};
    std::sort(capabilities.begin(), capabilities.end());
    return capabilities;
}

std::string nvrtc_error_name(nvrtcResult code) {
    const char* name = nvrtc().nvrtcGetErrorString(code);
    return (name ? std::string(name) : "NVRTC error") + " (" + std::to_string(code) + ")";
}

}  // namespace fontana
