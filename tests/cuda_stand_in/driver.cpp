// A stand-in for libcuda.so.1, NVIDIA's driver, for machines without a GPU: it runs the PTX that NVRTC makes on the
// CPU. What it shows: that kernels compile, that the backend calls the driver as documented, that arguments have the
// sizes and places the PTX expects, that every access stays within its buffer, that all threads of a block reach its
// barriers, and that the results are the CPU's. What it cannot show: anything about a GPU's machine code, its speed,
// its threads running at once, its approximate instructions, or NVIDIA's driver itself. Nothing that ran on it ran on a
// GPU.
//
// It has a device only where FONTANA_STAND_IN_DEVICES says how many. FONTANA_STAND_IN_CAPABILITY (75) is ten times its
// compute capability, FONTANA_STAND_IN_MEMORY (1024) its memory in MiB, FONTANA_STAND_IN_COMPUTE_MODE (0) the mode.
// FONTANA_STAND_IN_REFUSES_PTX=1 makes it a driver that is older than the compiler.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "backends/cuda/cuda_types.h"
#include "execute.h"
#include "faults.h"
#include "memory.h"
#include "program.h"

namespace fontana {

struct CUctx_st {
    stand_in::DeviceMemory memory;
    CUresult fault = CUDA_SUCCESS;  // what a kernel did wrong stays with its context
};
struct CUmod_st {
    CUcontext context;
    const stand_in::KernelCode* kernels;
};
struct CUstream_st {
    CUcontext context;
};
struct CUevent_st {
    CUcontext context;
    bool is_recorded = false;
    std::chrono::steady_clock::time_point time;
};

}  // namespace fontana

using namespace fontana;

namespace {

constexpr CUresult k_not_initialized = 3, k_invalid_context = 201, k_invalid_handle = 400, k_not_found = 500;
constexpr CUresult k_not_ready = 600;

struct State {
    std::mutex mutex;
    bool is_initialized = false;
    std::set<CUcontext> contexts;
    std::set<CUmodule> modules;
    std::set<CUstream> streams;
    std::set<CUevent> events;
};

State& state() {
    static State* everything = new State;  // outlives whoever calls the driver while the process ends
    return *everything;
}

thread_local std::vector<CUcontext> current_contexts;

int setting(const char* name, int otherwise) {
    const char* text = std::getenv(name);
    return text && *text ? std::atoi(text) : otherwise;
}

std::size_t memory_limit() { return static_cast<std::size_t>(setting("FONTANA_STAND_IN_MEMORY", 1024)) << 20; }

template <typename Handle>
bool is_alive(const std::set<Handle>& handles, Handle handle) {
    return handles.count(handle) > 0;
}

// The current context, where a call may use it. What stands against that goes to `code`.
CUcontext usable_context(CUresult& code) {
    CUcontext context = current_contexts.empty() ? nullptr : current_contexts.back();
    code = !context || !is_alive(state().contexts, context) ? k_invalid_context : context->fault;
    return context;
}

bool belongs(CUstream stream, CUcontext context) {
    return is_alive(state().streams, stream) && stream->context == context;
}

bool is_device(CUdevice device) { return device >= 0 && device < setting("FONTANA_STAND_IN_DEVICES", 0); }

CUresult complain(CUresult code, const std::string& sentence) {
    std::fprintf(stderr, "stand-in driver: %s\n", sentence.c_str());
    return code;
}

// A function is its kernel's code, which stays for good.
const stand_in::KernelCode& kernel_of(CUfunction function) {
    return *reinterpret_cast<const stand_in::KernelCode*>(function);
}

void* host(CUdeviceptr address) { return reinterpret_cast<void*>(address); }

// Arguments as the PTX lays them out. The list must end with a null: a driver does not ask for one, but without it
// nobody could tell that an argument is missing.
CUresult pack(const stand_in::KernelCode& kernel, void** arguments, std::vector<unsigned char>& packed) {
    packed.assign(kernel.parameter_bytes, 0);
    for (std::size_t k = 0; k <= kernel.parameter_count; ++k) {
        if ((arguments[k] == nullptr) != (k == kernel.parameter_count))
            return complain(CUDA_ERROR_INVALID_VALUE, "kernel " + std::string(kernel.name) + " takes " +
                                                          std::to_string(kernel.parameter_count) + " arguments, not " +
                                                          (k < kernel.parameter_count ? std::to_string(k) : "more"));
        if (k == kernel.parameter_count) return CUDA_SUCCESS;
        std::memcpy(packed.data() + kernel.parameters[k].offset, arguments[k], kernel.parameters[k].bytes);
    }
    return CUDA_SUCCESS;
}

}  // namespace

#define DRIVER extern "C" __attribute__((visibility("default"))) CUresult
#define BEGIN(function)                                                     \
    const std::lock_guard<std::mutex> lock(state().mutex);                  \
    if (const CUresult fault = stand_in::fault_of(#function)) return fault; \
    if (!state().is_initialized) return k_not_initialized
#define BEGIN_IN_CONTEXT(function)                                   \
    BEGIN(function);                                                 \
    CUresult code = CUDA_SUCCESS;                                    \
    [[maybe_unused]] const CUcontext context = usable_context(code); \
    if (code != CUDA_SUCCESS) return code

// ---- the driver and its devices ------------------------------------------------------------------------------------

DRIVER cuInit(unsigned flags) {
    const std::lock_guard<std::mutex> lock(state().mutex);
    if (const CUresult fault = stand_in::fault_of("cuInit")) return fault;
    state().is_initialized = flags == 0;
    return flags == 0 ? CUDA_SUCCESS : CUDA_ERROR_INVALID_VALUE;
}

DRIVER cuDriverGetVersion(int* version) {
    if (const CUresult fault = stand_in::fault_of("cuDriverGetVersion")) return fault;
    *version = 12040;
    return CUDA_SUCCESS;
}

DRIVER cuGetErrorName(CUresult code, const char** name) {
    if (const CUresult fault = stand_in::fault_of("cuGetErrorName")) return fault;
    switch (code) {
#define NAME(error, number) \
    case number:            \
        *name = #error;     \
        return CUDA_SUCCESS;
        NAME(CUDA_ERROR_INVALID_VALUE, 1)
        NAME(CUDA_ERROR_OUT_OF_MEMORY, 2)
        NAME(CUDA_ERROR_NOT_INITIALIZED, 3)
        NAME(CUDA_ERROR_NO_DEVICE, 100)
        NAME(CUDA_ERROR_INVALID_IMAGE, 200)
        NAME(CUDA_ERROR_INVALID_CONTEXT, 201)
        NAME(CUDA_ERROR_NO_BINARY_FOR_GPU, 209)
        NAME(CUDA_ERROR_INVALID_PTX, 218)
        NAME(CUDA_ERROR_UNSUPPORTED_PTX_VERSION, 222)
        NAME(CUDA_ERROR_INVALID_HANDLE, 400)
        NAME(CUDA_ERROR_NOT_FOUND, 500)
        NAME(CUDA_ERROR_NOT_READY, 600)
        NAME(CUDA_ERROR_ILLEGAL_ADDRESS, 700)
        NAME(CUDA_ERROR_MISALIGNED_ADDRESS, 716)
        NAME(CUDA_ERROR_LAUNCH_FAILED, 719)
#undef NAME
        default:
            return CUDA_ERROR_INVALID_VALUE;
    }
}

DRIVER cuDeviceGetCount(int* count) {
    BEGIN(cuDeviceGetCount);
    *count = setting("FONTANA_STAND_IN_DEVICES", 0);
    return CUDA_SUCCESS;
}

DRIVER cuDeviceGet(CUdevice* device, int index) {
    BEGIN(cuDeviceGet);
    *device = index;
    return is_device(index) ? CUDA_SUCCESS : CUDA_ERROR_INVALID_VALUE;
}

DRIVER cuDeviceGetName(char* name, int bytes, CUdevice device) {
    BEGIN(cuDeviceGetName);
    if (!is_device(device)) return CUDA_ERROR_INVALID_VALUE;
    std::snprintf(name, static_cast<std::size_t>(bytes), "stand-in driver on the CPU, no GPU");
    return CUDA_SUCCESS;
}

DRIVER cuDeviceTotalMem_v2(std::size_t* bytes, CUdevice device) {
    BEGIN(cuDeviceTotalMem);
    *bytes = memory_limit();
    return is_device(device) ? CUDA_SUCCESS : CUDA_ERROR_INVALID_VALUE;
}

DRIVER cuDeviceGetAttribute(int* value, int attribute, CUdevice device) {
    BEGIN(cuDeviceGetAttribute);
    if (!is_device(device)) return CUDA_ERROR_INVALID_VALUE;
    const int capability = setting("FONTANA_STAND_IN_CAPABILITY", 75);
    switch (attribute) {
        case CU_DEVICE_ATTRIBUTE_MAX_THREADS_PER_BLOCK:
            *value = 1024;
            return CUDA_SUCCESS;
        case CU_DEVICE_ATTRIBUTE_MULTIPROCESSOR_COUNT:
            *value = 1;
            return CUDA_SUCCESS;
        case CU_DEVICE_ATTRIBUTE_COMPUTE_MODE:
            *value = setting("FONTANA_STAND_IN_COMPUTE_MODE", 0);
            return CUDA_SUCCESS;
        case CU_DEVICE_ATTRIBUTE_COMPUTE_CAPABILITY_MAJOR:
            *value = capability / 10;
            return CUDA_SUCCESS;
        case CU_DEVICE_ATTRIBUTE_COMPUTE_CAPABILITY_MINOR:
            *value = capability % 10;
            return CUDA_SUCCESS;
        default:
            return CUDA_ERROR_INVALID_VALUE;
    }
}

// ---- contexts ------------------------------------------------------------------------------------------------------

DRIVER cuCtxCreate_v2(CUcontext* context, unsigned, CUdevice device) {
    BEGIN(cuCtxCreate);
    if (!is_device(device)) return CUDA_ERROR_INVALID_VALUE;
    *context = new CUctx_st;
    state().contexts.insert(*context);
    current_contexts.push_back(*context);
    return CUDA_SUCCESS;
}

DRIVER cuCtxDestroy_v2(CUcontext context) {
    const std::lock_guard<std::mutex> lock(state().mutex);
    if (!state().contexts.erase(context)) return k_invalid_context;
    delete context;
    return CUDA_SUCCESS;
}

DRIVER cuCtxPushCurrent_v2(CUcontext context) {
    BEGIN(cuCtxPushCurrent);
    if (!is_alive(state().contexts, context)) return k_invalid_context;
    current_contexts.push_back(context);
    return CUDA_SUCCESS;
}

DRIVER cuCtxPopCurrent_v2(CUcontext* context) {
    if (current_contexts.empty()) return k_invalid_context;
    *context = current_contexts.back();
    current_contexts.pop_back();
    return CUDA_SUCCESS;
}

// ---- modules -------------------------------------------------------------------------------------------------------

DRIVER cuModuleLoadData(CUmodule* module, const void* image) {
    BEGIN_IN_CONTEXT(cuModuleLoadData);
    const char* text = static_cast<const char*>(image);
    if (std::strncmp(text,
                     "\x7f"
                     "ELF",
                     4) == 0)
        return CUDA_ERROR_NO_BINARY_FOR_GPU;  // machine code of a real GPU
    if (!std::strstr(text, ".version")) return CUDA_ERROR_INVALID_IMAGE;
    if (setting("FONTANA_STAND_IN_REFUSES_PTX", 0)) return CUDA_ERROR_UNSUPPORTED_PTX_VERSION;
    const stand_in::KernelCode* kernels = stand_in::load_program(text);
    if (!kernels) return CUDA_ERROR_INVALID_PTX;
    *module = new CUmod_st{context, kernels};
    state().modules.insert(*module);
    return CUDA_SUCCESS;
}

DRIVER cuModuleUnload(CUmodule module) {
    const std::lock_guard<std::mutex> lock(state().mutex);
    if (!state().modules.erase(module)) return k_invalid_handle;
    delete module;
    return CUDA_SUCCESS;
}

DRIVER cuModuleGetFunction(CUfunction* function, CUmodule module, const char* name) {
    BEGIN_IN_CONTEXT(cuModuleGetFunction);
    if (!is_alive(state().modules, module) || module->context != context) return k_invalid_handle;
    for (const stand_in::KernelCode* kernel = module->kernels; kernel->name; ++kernel) {
        if (std::strcmp(kernel->name, name) != 0) continue;
        *function = reinterpret_cast<CUfunction>(const_cast<stand_in::KernelCode*>(kernel));
        return CUDA_SUCCESS;
    }
    return k_not_found;
}

DRIVER cuFuncGetAttribute(int* value, int attribute, CUfunction function) {
    BEGIN_IN_CONTEXT(cuFuncGetAttribute);
    if (attribute != CU_FUNC_ATTRIBUTE_MAX_THREADS_PER_BLOCK) return CUDA_ERROR_INVALID_VALUE;
    *value = kernel_of(function).most_threads ? static_cast<int>(kernel_of(function).most_threads) : 1024;
    return CUDA_SUCCESS;
}

DRIVER cuFuncGetParamInfo(CUfunction function, std::size_t index, std::size_t* offset, std::size_t* bytes) {
    BEGIN_IN_CONTEXT(cuFuncGetParamInfo);
    if (index >= kernel_of(function).parameter_count) return CUDA_ERROR_INVALID_VALUE;
    *offset = kernel_of(function).parameters[index].offset;
    *bytes = kernel_of(function).parameters[index].bytes;
    return CUDA_SUCCESS;
}

// ---- memory --------------------------------------------------------------------------------------------------------

DRIVER cuMemGetInfo_v2(std::size_t* free, std::size_t* total) {
    BEGIN_IN_CONTEXT(cuMemGetInfo);
    *total = memory_limit();
    *free = *total - context->memory.used_bytes();
    return CUDA_SUCCESS;
}

DRIVER cuMemAlloc_v2(CUdeviceptr* memory, std::size_t bytes) {
    BEGIN_IN_CONTEXT(cuMemAlloc);
    if (bytes == 0) return CUDA_ERROR_INVALID_VALUE;
    *memory = context->memory.allocate(bytes, memory_limit());
    return *memory ? CUDA_SUCCESS : CUDA_ERROR_OUT_OF_MEMORY;
}

DRIVER cuMemFree_v2(CUdeviceptr memory) {
    const std::lock_guard<std::mutex> lock(state().mutex);
    CUresult code = CUDA_SUCCESS;
    const CUcontext context = usable_context(code);
    if (code == k_invalid_context) return code;
    return context->memory.free(memory) ? code : CUDA_ERROR_INVALID_VALUE;
}

DRIVER cuMemsetD32Async(CUdeviceptr to, unsigned value, std::size_t count, CUstream stream) {
    BEGIN_IN_CONTEXT(cuMemsetD32Async);
    if (!belongs(stream, context)) return k_invalid_handle;
    if (to % 4 != 0 || !context->memory.contains(to, 4 * count)) return CUDA_ERROR_INVALID_VALUE;
    for (std::size_t k = 0; k < count; ++k) std::memcpy(host(to + 4 * k), &value, 4);
    return CUDA_SUCCESS;
}

DRIVER cuMemcpyHtoDAsync_v2(CUdeviceptr to, const void* from, std::size_t bytes, CUstream stream) {
    BEGIN_IN_CONTEXT(cuMemcpyHtoDAsync);
    if (!belongs(stream, context)) return k_invalid_handle;
    if (!context->memory.contains(to, bytes)) return CUDA_ERROR_INVALID_VALUE;
    std::memcpy(host(to), from, bytes);
    return CUDA_SUCCESS;
}

DRIVER cuMemcpyDtoHAsync_v2(void* to, CUdeviceptr from, std::size_t bytes, CUstream stream) {
    BEGIN_IN_CONTEXT(cuMemcpyDtoHAsync);
    if (!belongs(stream, context)) return k_invalid_handle;
    if (!context->memory.contains(from, bytes)) return CUDA_ERROR_INVALID_VALUE;
    std::memcpy(to, host(from), bytes);
    return CUDA_SUCCESS;
}

DRIVER cuMemcpyDtoDAsync_v2(CUdeviceptr to, CUdeviceptr from, std::size_t bytes, CUstream stream) {
    BEGIN_IN_CONTEXT(cuMemcpyDtoDAsync);
    if (!belongs(stream, context)) return k_invalid_handle;
    if (!context->memory.contains(from, bytes) || !context->memory.contains(to, bytes)) return CUDA_ERROR_INVALID_VALUE;
    std::memmove(host(to), host(from), bytes);
    return CUDA_SUCCESS;
}

// ---- streams, launches, events -------------------------------------------------------------------------------------

DRIVER cuStreamCreate(CUstream* stream, unsigned flags) {
    BEGIN_IN_CONTEXT(cuStreamCreate);
    if (flags > CU_STREAM_NON_BLOCKING) return CUDA_ERROR_INVALID_VALUE;
    *stream = new CUstream_st{context};
    state().streams.insert(*stream);
    return CUDA_SUCCESS;
}

DRIVER cuStreamDestroy_v2(CUstream stream) {
    const std::lock_guard<std::mutex> lock(state().mutex);
    if (!state().streams.erase(stream)) return k_invalid_handle;
    delete stream;
    return CUDA_SUCCESS;
}

DRIVER cuStreamSynchronize(CUstream stream) {
    BEGIN_IN_CONTEXT(cuStreamSynchronize);
    return belongs(stream, context) ? CUDA_SUCCESS : k_invalid_handle;
}

// As with a real driver, what a kernel does wrong shows at a later call.
DRIVER cuLaunchKernel(CUfunction function, unsigned grid_x, unsigned grid_y, unsigned grid_z, unsigned block_x,
                      unsigned block_y, unsigned block_z, unsigned shared_bytes, CUstream stream, void** arguments,
                      void** extra) {
    BEGIN_IN_CONTEXT(cuLaunchKernel);
    if (!belongs(stream, context)) return k_invalid_handle;
    const stand_in::KernelCode& kernel = kernel_of(function);
    const unsigned most_threads = kernel.most_threads ? kernel.most_threads : 1024;
    if (grid_x == 0 || grid_x > 0x7fffffffu || block_x == 0 || block_x > most_threads || grid_y != 1 || grid_z != 1 ||
        block_y != 1 || block_z != 1 || shared_bytes != 0 || !arguments || extra)
        return complain(CUDA_ERROR_INVALID_VALUE, "kernel " + std::string(kernel.name) + " launched on " +
                                                      std::to_string(grid_x) + " blocks of " + std::to_string(block_x));
    std::vector<unsigned char> packed;
    if (const CUresult refused = pack(kernel, arguments, packed)) return refused;
    try {
        stand_in::execute(kernel, grid_x, block_x, packed, context->memory);
    } catch (const stand_in::DeviceFault& fault) {
        context->fault = complain(fault.code(), fault.what());
    }
    return CUDA_SUCCESS;
}

DRIVER cuEventCreate(CUevent* event, unsigned) {
    BEGIN_IN_CONTEXT(cuEventCreate);
    *event = new CUevent_st{context, false, {}};
    state().events.insert(*event);
    return CUDA_SUCCESS;
}

DRIVER cuEventDestroy_v2(CUevent event) {
    const std::lock_guard<std::mutex> lock(state().mutex);
    if (!state().events.erase(event)) return k_invalid_handle;
    delete event;
    return CUDA_SUCCESS;
}

DRIVER cuEventRecord(CUevent event, CUstream stream) {
    BEGIN_IN_CONTEXT(cuEventRecord);
    if (!is_alive(state().events, event) || !belongs(stream, context)) return k_invalid_handle;
    event->is_recorded = true;
    event->time = std::chrono::steady_clock::now();
    return CUDA_SUCCESS;
}

DRIVER cuEventElapsedTime(float* milliseconds, CUevent begin, CUevent end) {
    BEGIN_IN_CONTEXT(cuEventElapsedTime);
    if (!is_alive(state().events, begin) || !is_alive(state().events, end)) return k_invalid_handle;
    if (!begin->is_recorded || !end->is_recorded) return k_not_ready;
    *milliseconds = std::chrono::duration<float, std::milli>(end->time - begin->time).count();
    return CUDA_SUCCESS;
}

// ---- for tests -----------------------------------------------------------------------------------------------------

// How many contexts, modules, streams and events are left, and how deep this thread's stack of contexts is.
extern "C" __attribute__((visibility("default"))) long count_left_objects() {
    const std::lock_guard<std::mutex> lock(state().mutex);
    return static_cast<long>(state().contexts.size() + state().modules.size() + state().streams.size() +
                             state().events.size() + current_contexts.size());
}
