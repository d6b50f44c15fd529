// The list of backends. A backend adds its two functions here, and nothing else above it changes.
#include <functional>

#include "backends/backend.h"
#include "backends/cpu/cpu_backend.h"
#include "backends/cuda/cuda_backend.h"
#include "backends/opencl/opencl_backend.h"
#include "util/error.h"

namespace fontana {
namespace {

struct BackendEntry {
    const char* name;
    std::function<std::vector<DeviceInfo>()> list;
    std::function<std::unique_ptr<Backend>(const BackendOptions&)> make;
};

// In the order in which "auto" looks for a GPU.
const std::vector<BackendEntry>& backends() {
    static const std::vector<BackendEntry> entries = {
        {"cpu", list_cpu_devices, make_cpu_backend},
        {"cuda", list_cuda_devices, make_cuda_backend},
        {"opencl", list_opencl_devices, make_opencl_backend},
    };
    return entries;
}

struct Choice {
    const BackendEntry& backend;
    int device;  // index within it
};

const BackendEntry& find_backend(const std::string& name) {
    for (const BackendEntry& entry : backends())
        if (name == entry.name) return entry;
    fail(FONTANA_BAD_INPUT, "no backend '" + name + "': expected auto, cpu, cuda or opencl");
}

// "auto" asks no backend behind the one that it takes: starting a vendor's library costs time.
Choice choose(const std::string& name, int device) {
    if (name != "auto") return {find_backend(name), device};
    for (const BackendEntry& entry : backends()) {
        int index = 0;
        for (const DeviceInfo& found : entry.list()) {
            if (found.available && found.is_gpu) return {entry, index};
            ++index;
        }
    }
    return {find_backend("cpu"), 0};
}

std::unique_ptr<Backend> require_tiles(std::unique_ptr<Backend> backend, const BackendOptions& options) {
    const DeviceInfo& device = backend->device();
    if (options.tiles && device.neighbors.find("tiles") == std::string::npos)
        fail(FONTANA_BAD_INPUT, "solver.neighbors=tiles is a choice of the backends for GPUs and the run is on " +
                                    device.backend + ", which has " + device.neighbors +
                                    ": use solver.backend=cuda or opencl, or solver.neighbors=grid");
    return backend;
}

}  // namespace

const KernelFacts& kernel_facts(Kernel kernel) {
    static const KernelFacts facts[] = {
#define KERNEL_ENTRY(function, bytes, flops) {#function, bytes, flops},
#include "kernels/kernel_list.def"
#undef KERNEL_ENTRY
    };
    return facts[static_cast<int>(kernel)];
}

const KernelFacts* find_kernel_facts(const std::string& name) {
    for (int k = 0; k < static_cast<int>(Kernel::count); ++k)
        if (const KernelFacts& facts = kernel_facts(static_cast<Kernel>(k)); name == facts.name) return &facts;
    return nullptr;
}

std::vector<DeviceInfo> list_devices() {
    std::vector<DeviceInfo> devices;
    for (const BackendEntry& entry : backends())
        for (DeviceInfo& device : entry.list()) devices.push_back(std::move(device));
    return devices;
}

DeviceInfo choose_device(const std::string& name) {
    const Choice choice = choose(name, 0);
    return choice.backend.list().at(static_cast<std::size_t>(choice.device));
}

std::unique_ptr<Backend> make_backend(const std::string& name, BackendOptions options) {
    const Choice choice = choose(name, options.device);
    options.device = choice.device;
    return require_tiles(choice.backend.make(options), options);
}

}  // namespace fontana
