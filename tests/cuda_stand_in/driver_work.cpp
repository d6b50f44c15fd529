// The stand-in driver's memory, streams, launches and events.
#include <cstring>
#include <string>
#include <vector>

#include "driver.h"
#include "execute.h"

using namespace stand_in;

namespace {

void* host(CUdeviceptr address) { return reinterpret_cast<void*>(address); }

// Arguments as the PTX lays them out. The list must end with a null: a driver does not ask for one, but without it
// nobody could tell that an argument is missing.
CUresult pack(const KernelCode& kernel, void** arguments, std::vector<unsigned char>& packed) {
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
    const KernelCode& kernel = kernel_of(function);
    const unsigned most_threads = kernel.most_threads ? kernel.most_threads : 1024;
    if (grid_x == 0 || grid_x > 0x7fffffffu || block_x == 0 || block_x > most_threads || grid_y != 1 || grid_z != 1 ||
        block_y != 1 || block_z != 1 || shared_bytes != 0 || !arguments || extra)
        return complain(CUDA_ERROR_INVALID_VALUE, "kernel " + std::string(kernel.name) + " launched on " +
                                                      std::to_string(grid_x) + " blocks of " + std::to_string(block_x));
    std::vector<unsigned char> packed;
    if (const CUresult refused = pack(kernel, arguments, packed)) return refused;
    try {
        execute(kernel, grid_x, block_x, packed, context->memory);
    } catch (const DeviceFault& fault) {
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
