#include "backends/opencl/opencl_devices.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <sstream>

#include "backends/gpu/tiles.h"
#include "backends/opencl/opencl_backend.h"
#include "backends/opencl/opencl_error.h"

namespace fontana {
namespace {

// Kernels under a CPU driver run a group as a loop; on a GPU two to four warps hide each other's waiting.
constexpr std::size_t k_cpu_group_size = 64, k_gpu_group_size = 128;

OpenClDevice unusable(const std::string& name, const std::string& reason) {
    OpenClDevice device;
    device.info.backend = "opencl";
    device.info.name = name;
    device.info.reason = reason;
    return device;
}

// Text up to its first zero byte, which drivers include in the size, without the blanks some pad it with.
std::string trimmed(std::string text) {
    text.resize(std::min(text.size(), text.find('\0')));
    const std::size_t begin = text.find_first_not_of(' ');
    if (begin == std::string::npos) return "";
    return text.substr(begin, text.find_last_not_of(' ') - begin + 1);
}

// Asks a device for its properties. Of what went wrong the first is kept.
class DeviceQuery {
 public:
    explicit DeviceQuery(cl_device_id id) : id_(id) {}

    template <typename T>
    T value(cl_device_info what) {
        T value = {};
        note(opencl().clGetDeviceInfo(id_, what, sizeof value, &value, nullptr));
        return value;
    }

    std::string text(cl_device_info what) {
        std::size_t bytes = 0;
        note(opencl().clGetDeviceInfo(id_, what, 0, nullptr, &bytes));
        std::string text(bytes, '\0');
        note(opencl().clGetDeviceInfo(id_, what, bytes, text.data(), nullptr));
        return trimmed(text);
    }

    cl_int first_error() const { return first_error_; }

 private:
    void note(cl_int code) {
        if (first_error_ == CL_SUCCESS) first_error_ = code;
    }

    cl_device_id id_;
    cl_int first_error_ = CL_SUCCESS;
};

std::string platform_text(cl_platform_id id, cl_platform_info what) {
    std::size_t bytes = 0;
    if (opencl().clGetPlatformInfo(id, what, 0, nullptr, &bytes) != CL_SUCCESS) return "";
    std::string text(bytes, '\0');
    if (opencl().clGetPlatformInfo(id, what, bytes, text.data(), nullptr) != CL_SUCCESS) return "";
    return trimmed(text);
}

bool is_on_search_path(const char* program) {
    const char* path = std::getenv("PATH");
    std::istringstream folders(path ? path : "");
    std::error_code error;
    for (std::string folder; std::getline(folders, folder, ':');)
        if (std::filesystem::exists(std::filesystem::path(folder) / program, error)) return true;
    return false;
}

bool is_pocl(const std::string& platform_version) { return platform_version.find("PoCL ") != std::string::npos; }

// PoCL links each kernel with the system's linker against the compiler's run-time library (from version 7 on it may
// carry its own), and ends the whole process where that fails.
bool can_link(const std::string& platform_version) {
    if (std::atoi(platform_version.c_str() + platform_version.find("PoCL ") + 5) >= 7) return true;
    return is_on_search_path("ld") &&
           (is_on_search_path("cc") || is_on_search_path("gcc") || is_on_search_path("clang"));
}

std::string why_unusable(DeviceQuery& query, const std::string& platform_version) {
    const std::string version = query.text(CL_DEVICE_VERSION);
    const bool is_ready = query.value<cl_bool>(CL_DEVICE_AVAILABLE) != CL_FALSE;
    const bool has_compiler = query.value<cl_bool>(CL_DEVICE_COMPILER_AVAILABLE) != CL_FALSE;
    const bool is_little_endian = query.value<cl_bool>(CL_DEVICE_ENDIAN_LITTLE) != CL_FALSE;
    if (query.first_error() != CL_SUCCESS)
        return "its properties cannot be read: clGetDeviceInfo failed with " + opencl_error_name(query.first_error());
    int major = 0, minor = 0;
    std::sscanf(version.c_str(), "OpenCL %d.%d", &major, &minor);
    if (major * 10 + minor < 12) return "it has '" + version + "', OpenCL 1.2 is needed: update its driver";
    if (!is_ready) return "its driver says that it is not available";
    if (!has_compiler) return "its driver has no compiler: install the vendor's full OpenCL package";
    if (!is_little_endian) return "its numbers are big-endian, the host's are not";
    if (is_pocl(platform_version) && !can_link(platform_version))
        return "PoCL needs a C compiler and the linker 'ld' on PATH: install gcc";
    return "";
}

std::size_t choose_group_size(std::size_t limit, bool is_gpu) {
    std::size_t size = is_gpu ? k_gpu_group_size : k_cpu_group_size;
    while (size > limit && size > 1) size /= 2;
    return size;
}

OpenClDevice describe(cl_platform_id platform, cl_device_id id) {
    DeviceQuery query(id);
    OpenClDevice device;
    device.id = id;
    device.platform_version = platform_text(platform, CL_PLATFORM_VERSION);
    device.largest_allocation = query.value<cl_ulong>(CL_DEVICE_MAX_MEM_ALLOC_SIZE);
    const auto rounding = query.value<cl_device_fp_config>(CL_DEVICE_SINGLE_FP_CONFIG);
    device.rounds_divisions_correctly = (rounding & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT) != 0;
    DeviceInfo& info = device.info;
    info.backend = "opencl";
    info.neighbors = k_gpu_neighbors;
    info.name = query.text(CL_DEVICE_NAME);
    info.driver = platform_text(platform, CL_PLATFORM_NAME) + ", driver " + query.text(CL_DRIVER_VERSION);
    info.memory_bytes = query.value<cl_ulong>(CL_DEVICE_GLOBAL_MEM_SIZE);
    info.compute_units = query.value<cl_uint>(CL_DEVICE_MAX_COMPUTE_UNITS);
    info.is_gpu = (query.value<cl_device_type>(CL_DEVICE_TYPE) & CL_DEVICE_TYPE_GPU) != 0;
    device.group_size = choose_group_size(query.value<std::size_t>(CL_DEVICE_MAX_WORK_GROUP_SIZE), info.is_gpu);
    info.reason = why_unusable(query, device.platform_version);
    info.available = info.reason.empty();
    return device;
}

std::string why_empty(cl_platform_id platform) {
    if (is_pocl(platform_text(platform, CL_PLATFORM_VERSION)))
        return "PoCL offers no device where it has no cache: set POCL_CACHE_DIR to a folder that can be written to";
    return "this OpenCL platform finds no device of its kind on this machine";
}

std::vector<OpenClDevice> devices_of(cl_platform_id platform) {
    cl_uint count = 0;
    cl_int code = opencl().clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, 0, nullptr, &count);
    std::vector<cl_device_id> ids(code == CL_SUCCESS ? count : 0);
    if (!ids.empty()) code = opencl().clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, count, ids.data(), nullptr);
    const std::string name = platform_text(platform, CL_PLATFORM_NAME);
    if (ids.empty() && (code == CL_SUCCESS || code == CL_DEVICE_NOT_FOUND))
        return {unusable(name, why_empty(platform))};
    if (code != CL_SUCCESS)
        return {unusable(name, "the devices of '" + name + "' cannot be listed: clGetDeviceIDs failed with " +
                                   opencl_error_name(code))};
    std::vector<OpenClDevice> devices;
    for (cl_device_id id : ids) devices.push_back(describe(platform, id));
    return devices;
}

int preference(const OpenClDevice& device) { return device.info.available ? (device.info.is_gpu ? 0 : 1) : 2; }

}  // namespace

std::vector<OpenClDevice> find_opencl_devices() {
    const std::string closed = open_opencl();
    if (!closed.empty()) return {unusable("none", closed)};
    cl_uint count = 0;
    cl_int code = opencl().clGetPlatformIDs(0, nullptr, &count);
    std::vector<cl_platform_id> platforms(code == CL_SUCCESS ? count : 0);
    if (!platforms.empty()) code = opencl().clGetPlatformIDs(count, platforms.data(), nullptr);
    constexpr cl_int k_no_platform = -1001;  // CL_PLATFORM_NOT_FOUND_KHR
    if (platforms.empty() && (code == CL_SUCCESS || code == k_no_platform))
        return {unusable("none", std::string("the OpenCL library finds no driver: ") + k_opencl_remedy)};
    if (code != CL_SUCCESS)
        return {unusable("none", "clGetPlatformIDs failed with " + opencl_error_name(code) + ": " + k_opencl_remedy)};
    std::vector<OpenClDevice> devices;
    for (cl_platform_id platform : platforms)
        for (OpenClDevice& device : devices_of(platform)) devices.push_back(std::move(device));
    std::stable_sort(devices.begin(), devices.end(),
                     [](const OpenClDevice& a, const OpenClDevice& b) { return preference(a) < preference(b); });
    return devices;
}

std::vector<DeviceInfo> list_opencl_devices() {
    std::vector<DeviceInfo> infos;
    for (OpenClDevice& device : find_opencl_devices()) infos.push_back(std::move(device.info));
    return infos;
}

}  // namespace fontana
