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
#include "driver.h"

#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "program.h"

namespace stand_in {

thread_local std::vector<CUcontext> current_contexts;

State& state() {
    static State* everything = new State;  // outlives whoever calls the driver while the process ends
    return *everything;
}

int setting(const char* name, int otherwise) {
    const char* text = std::getenv(name);
    return text && *text ? std::atoi(text) : otherwise;
}

std::size_t memory_limit() { return static_cast<std::size_t>(setting("FONTANA_STAND_IN_MEMORY", 1024)) << 20; }

CUcontext usable_context(CUresult& code) {
    CUcontext context = current_contexts.empty() ? nullptr : current_contexts.back();
    code = !context || !is_alive(state().contexts, context) ? k_invalid_context : context->fault;
    return context;
}

bool belongs(CUstream stream, CUcontext context) {
    return is_alive(state().streams, stream) && stream->context == context;
}

CUresult complain(CUresult code, const std::string& sentence) {
    std::fprintf(stderr, "stand-in driver: %s\n", sentence.c_str());
    return code;
}

}  // namespace stand_in

using namespace stand_in;

namespace {

bool is_device(CUdevice device) { return device >= 0 && device < setting("FONTANA_STAND_IN_DEVICES", 0); }

}  // namespace

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
    const KernelCode* kernels = load_program(text);
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
    for (const KernelCode* kernel = module->kernels; kernel->name; ++kernel) {
        if (std::strcmp(kernel->name, name) != 0) continue;
        *function = reinterpret_cast<CUfunction>(const_cast<KernelCode*>(kernel));
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

// ---- for tests -----------------------------------------------------------------------------------------------------

// How many contexts, modules, streams and events are left, and how deep this thread's stack of contexts is.
extern "C" __attribute__((visibility("default"))) long count_left_objects() {
    const std::lock_guard<std::mutex> lock(state().mutex);
    return static_cast<long>(state().contexts.size() + state().modules.size() + state().streams.size() +
                             state().events.size() + current_contexts.size());
}
