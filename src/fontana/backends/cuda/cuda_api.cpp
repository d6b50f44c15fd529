#include "backends/cuda/cuda_api.h"

#include <cstdlib>
#include <mutex>

#include "backends/cuda/shared_library.h"

namespace fontana {
namespace {

struct LoadedDriver {
    std::mutex mutex;
    CudaApi api;
    bool is_open = false;
};

LoadedDriver& loaded_driver() {
    static LoadedDriver driver;
    return driver;
}

// Returns "" or the function that is missing.
std::string fill_table(SharedLibrary& library, CudaApi& api) {
#define OPTIONAL_CUDA_FUNCTION(name, symbol, parameters) library.find(symbol, api.name);
#define CUDA_FUNCTION(name, symbol, parameters) \
    if (!library.find(symbol, api.name)) return symbol;
#include "backends/cuda/cuda_functions.def"
#undef CUDA_FUNCTION
#undef OPTIONAL_CUDA_FUNCTION
    return "";
}

std::string open_library(const std::string& path, CudaApi& api) {
    SharedLibrary library(path);
    if (!library.is_open()) return library.reason();
    const std::string missing = fill_table(library, api);
    if (!missing.empty()) return "it has no function " + missing + ", which CUDA 11.2 has";
    library.keep_open();
    return "";
}

}  // namespace

std::string open_cuda() {
    LoadedDriver& driver = loaded_driver();
    const std::lock_guard<std::mutex> lock(driver.mutex);
    if (driver.is_open) return "";
    const char* chosen = std::getenv("FONTANA_CUDA_LIBRARY");
    const bool is_chosen = chosen && *chosen;
    const std::string reason = open_library(is_chosen ? chosen : "libcuda.so.1", driver.api);
    driver.is_open = reason.empty();
    if (driver.is_open) return "";
    if (is_chosen)
        return "FONTANA_CUDA_LIBRARY is '" + std::string(chosen) + "', which cannot be used (" + reason +
               "): unset it, or give the path of a libcuda.so.1";
    return "no CUDA driver (" + reason + "): install NVIDIA's driver on a machine with one of its GPUs";
}

const CudaApi& cuda() { return loaded_driver().api; }

}  // namespace fontana
