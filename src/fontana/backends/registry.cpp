// The list of backends. A backend adds its two functions here, and nothing else above it changes.
#include <functional>

#include "backends/backend.h"
#include "backends/cpu/cpu_backend.h"
#include "backends/opencl/opencl_backend.h"
#include "util/error.h"

namespace fontana {
namespace {

struct BackendEntry {
    const char* name;
    std::function<std::vector<DeviceInfo>()> list;
    std::function<std::unique_ptr<Backend>(const BackendOptions&)> make;
};

const std::vector<BackendEntry>& backends() {
    static const std::vector<BackendEntry> entries = {
        {"cpu", list_cpu_devices, make_cpu_backend},
        {"opencl", list_opencl_devices, make_opencl_backend},
    };
    return entries;
}

std::unique_ptr<Backend> make_first_gpu(BackendOptions options) {
    for (const BackendEntry& entry : backends()) {
        int index = 0;
        for (const DeviceInfo& device : entry.list()) {
            if (device.available && device.is_gpu) {
                options.device = index;
                return entry.make(options);
            }
            ++index;
        }
    }
    return nullptr;
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

std::unique_ptr<CompiledKernel> Backend::compile(const KernelText& text) {
    fail(FONTANA_DEVICE_UNAVAILABLE, "the backend " + device().backend + " launches the core's kernels only, not '" +
                                         text.name + "': expected a backend with a compiler of its own, such as cpu");
}

std::vector<DeviceInfo> list_devices() {
    std::vector<DeviceInfo> devices;
    for (const BackendEntry& entry : backends())
        for (DeviceInfo& device : entry.list()) devices.push_back(std::move(device));
    return devices;
}

std::unique_ptr<Backend> make_backend(const std::string& name, const BackendOptions& options) {
    if (name == "auto") {
        std::unique_ptr<Backend> gpu = make_first_gpu(options);
        return gpu ? std::move(gpu) : make_cpu_backend(options);
    }
    for (const BackendEntry& entry : backends())
        if (name == entry.name) return entry.make(options);
    fail(FONTANA_BAD_INPUT, "no backend '" + name + "': expected auto, cpu or opencl");
}

}  // namespace fontana
