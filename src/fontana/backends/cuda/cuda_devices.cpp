#include "backends/cuda/cuda_devices.h"

#include <algorithm>

#include "backends/cuda/cuda_api.h"
#include "backends/cuda/cuda_backend.h"
#include "backends/cuda/cuda_error.h"
#include "backends/cuda/nvrtc_api.h"
#include "backends/gpu/tiles.h"

namespace fontana {
namespace {

constexpr int k_group_size = 128;  // two to four warps hide each other's waiting

CudaDevice unusable(const std::string& reason) {
    CudaDevice device;
    device.info.backend = "cuda";
    device.info.name = "none";
    device.info.reason = reason;
    return device;
}

std::string dotted(int major, int minor) { return std::to_string(major) + "." + std::to_string(minor); }

// Asks a device for its properties. Of what went wrong the first is kept.
class DeviceQuery {
 public:
    explicit DeviceQuery(int index) { note(cuda().cuDeviceGet(&id_, index), "cuDeviceGet"); }

    CUdevice id() const { return id_; }

    int attribute(CudaDeviceAttribute what) {
        int value = 0;
        note(cuda().cuDeviceGetAttribute(&value, what, id_), "cuDeviceGetAttribute");
        return value;
    }

    std::string name() {
        char text[256] = {};
        note(cuda().cuDeviceGetName(text, sizeof text - 1, id_), "cuDeviceGetName");
        return text;
    }

    std::size_t memory_bytes() {
        std::size_t bytes = 0;
        note(cuda().cuDeviceTotalMem(&bytes, id_), "cuDeviceTotalMem");
        return bytes;
    }

    const std::string& first_error() const { return first_error_; }

 private:
    void note(CUresult code, const char* call) {
        if (code != CUDA_SUCCESS && first_error_.empty())
            first_error_ = std::string(call) + " failed with " + cuda_error_name(code);
    }

    CUdevice id_ = -1;
    std::string first_error_;
};

std::string driver_version() {
    int version = 0;  // 12040 is 12.4
    if (cuda().cuDriverGetVersion(&version) != CUDA_SUCCESS) return "unknown";
    return dotted(version / 1000, version % 1000 / 10);
}

// Sets the architecture. Returns why there is none, or "".
std::string choose_architecture(CudaDevice& device) {
    const std::string closed = open_nvrtc();
    if (!closed.empty()) return closed;
    const std::vector<int> known = nvrtc_capabilities();
    const auto above = std::upper_bound(known.begin(), known.end(), device.capability);
    if (known.empty()) return "NVRTC " + nvrtc_version() + " does not say what it compiles for: " + k_nvrtc_remedy;
    if (above == known.begin())
        return "NVRTC " + nvrtc_version() + " compiles for compute capability " +
               dotted(known.front() / 10, known.front() % 10) + " and above, and the device has " +
               dotted(device.capability / 10, device.capability % 10) + ": " + k_nvrtc_remedy;
    const int chosen = *(above - 1);
    device.architecture = (chosen == device.capability ? "sm_" : "compute_") + std::to_string(chosen);
    return "";
}

std::string why_unusable(CudaDevice& device, DeviceQuery& query) {
    const int compute_mode = query.attribute(CU_DEVICE_ATTRIBUTE_COMPUTE_MODE);
    if (!query.first_error().empty()) return "its properties cannot be read: " + query.first_error();
    if (compute_mode == CU_COMPUTEMODE_PROHIBITED)
        return "it is closed to computing: its owner can open it with 'nvidia-smi -c 0'";
    return choose_architecture(device);
}

CudaDevice describe(int index) {
    DeviceQuery query(index);
    CudaDevice device;
    device.id = query.id();
    const int major = query.attribute(CU_DEVICE_ATTRIBUTE_COMPUTE_CAPABILITY_MAJOR);
    const int minor = query.attribute(CU_DEVICE_ATTRIBUTE_COMPUTE_CAPABILITY_MINOR);
    device.capability = 10 * major + minor;
    device.driver_version = driver_version();
    const int most_threads = query.attribute(CU_DEVICE_ATTRIBUTE_MAX_THREADS_PER_BLOCK);
    device.group_size = static_cast<std::size_t>(std::clamp(most_threads, 1, k_group_size));
    DeviceInfo& info = device.info;
    info.backend = "cuda";
    info.neighbors = k_gpu_neighbors;
    info.name = query.name();
    info.memory_bytes = query.memory_bytes();
    info.compute_units = static_cast<std::uint32_t>(query.attribute(CU_DEVICE_ATTRIBUTE_MULTIPROCESSOR_COUNT));
    info.is_gpu = true;
    info.reason = why_unusable(device, query);
    info.available = info.reason.empty();
    info.driver = "CUDA " + device.driver_version + ", compute capability " + dotted(major, minor);
    if (info.available) info.driver += ", NVRTC " + nvrtc_version();
    return device;
}

}  // namespace

std::vector<CudaDevice> find_cuda_devices() {
    const std::string closed = open_cuda();
    if (!closed.empty()) return {unusable(closed)};
    int count = 0;
    CUresult code = cuda().cuInit(0);
    const char* call = "cuInit";
    if (code == CUDA_SUCCESS) {
        code = cuda().cuDeviceGetCount(&count);
        call = "cuDeviceGetCount";
    }
    if (code == CUDA_ERROR_NO_DEVICE || (code == CUDA_SUCCESS && count == 0))
        return {unusable("the CUDA driver finds no GPU on this machine")};
    if (code != CUDA_SUCCESS)
        return {
            unusable(std::string("the CUDA driver does not start: ") + call + " failed with " + cuda_error_name(code))};
    std::vector<CudaDevice> devices;
    for (int index = 0; index < count; ++index) devices.push_back(describe(index));
    std::stable_sort(devices.begin(), devices.end(),
                     [](const CudaDevice& a, const CudaDevice& b) { return a.info.available && !b.info.available; });
    return devices;
}

std::vector<DeviceInfo> list_cuda_devices() {
    std::vector<DeviceInfo> infos;
    for (CudaDevice& device : find_cuda_devices()) infos.push_back(std::move(device.info));
    return infos;
}

}  // namespace fontana
