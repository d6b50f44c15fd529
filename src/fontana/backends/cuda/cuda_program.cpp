#include "backends/cuda/cuda_program.h"

#include <string>
#include <vector>

#include "backends/cuda/cuda_error.h"
#include "backends/cuda/nvrtc_api.h"
#include "backends/cuda/nvrtc_program.h"
#include "backends/gpu/failed_build.h"
#include "backends/gpu/kernel_cache.h"
#include "util/error.h"

namespace fontana {
namespace {

// NaNs must survive and denormals count, which is NVRTC's default; fast arithmetic may contract, divide within 2 ulp
// and take roots within 3, as OpenCL's may.
std::vector<std::string> build_options(const CudaDevice& device, bool strict) {
    std::vector<std::string> options = {"--gpu-architecture=" + device.architecture, "--std=c++17",
                                        "-DFONTANA_GROUP_SIZE=" + std::to_string(device.group_size)};
    const std::vector<std::string> exact = {"-DFONTANA_STRICT", "--fmad=false", "--prec-div=true", "--prec-sqrt=true"};
    const std::vector<std::string> fast = {"--fmad=true", "--prec-div=false", "--prec-sqrt=false"};
    const std::vector<std::string>& arithmetic = strict ? exact : fast;
    options.insert(options.end(), arithmetic.begin(), arithmetic.end());
    return options;
}

std::string whole(GpuText text) {
    std::string result;
    for (std::size_t i = 0; i < text.piece_count; ++i) result += text.pieces[i];
    return result;
}

// Everything the compiled program depends on.
std::string cache_key(const CudaDevice& device, std::string text, const std::vector<std::string>& options) {
    for (const std::string& option : options) text += '\0' + option;
    for (const std::string& part : {device.info.name, device.driver_version, nvrtc_version()}) text += '\0' + part;
    return KernelCache::key_of(text);
}

// Codes by which a driver says that this image is not for it; another may be.
bool is_refusal(CUresult code) {
    return code == CUDA_ERROR_INVALID_IMAGE || code == CUDA_ERROR_NO_BINARY_FOR_GPU || code == CUDA_ERROR_INVALID_PTX ||
           code == CUDA_ERROR_JIT_COMPILER_NOT_FOUND || code == CUDA_ERROR_UNSUPPORTED_PTX_VERSION ||
           code == CUDA_ERROR_JIT_COMPILATION_DISABLED;
}

CUresult load(const CudaStream& stream, const std::vector<unsigned char>& image, CudaModule& program) {
    if (image.empty()) return CUDA_ERROR_INVALID_IMAGE;
    CUmodule module = nullptr;
    const CUresult code = cuda().cuModuleLoadData(&module, image.data());
    if (code == CUDA_SUCCESS) program = CudaModule(stream.context(), module);
    return code;
}

CompiledImages compile(const CudaDevice& device, const std::string& text, const std::vector<std::string>& options,
                       const KernelCache& cache, const std::string& key) {
    CompiledImages images = compile_with_nvrtc(text, options);
    if (images.is_refused)
        fail_to_build("the CUDA device '" + device.info.name + "' (" + device.info.driver + ")", images.log, cache,
                      key);
    return images;
}

[[noreturn]] void fail_to_load(CUresult code, const CudaDevice& device) {
    if (!is_refusal(code)) fail_to_start_cuda(code, device.info.name, "cuModuleLoadData");
    fail(FONTANA_DEVICE_UNAVAILABLE, "the driver of the CUDA device '" + device.info.name + "' (CUDA " +
                                         device.driver_version + ") does not take what NVRTC " + nvrtc_version() +
                                         " compiles: " + cuda_error_name(code) + ": update the driver, or " +
                                         k_nvrtc_remedy + " and no later NVRTC");
}

}  // namespace

CudaModule build_cuda_program(const CudaStream& stream, GpuText pieces, bool strict) {
    const CudaDevice& device = stream.device();
    const CurrentContext current(*stream.context());
    if (current.code() != CUDA_SUCCESS) fail_to_start_cuda(current.code(), device.info.name, "cuCtxPushCurrent");
    const KernelCache cache;
    const std::string text = whole(pieces);
    const std::vector<std::string> options = build_options(device, strict);
    const std::string key = cache_key(device, text, options);
    CudaModule program;
    if (load(stream, cache.load(key), program) == CUDA_SUCCESS) return program;

    const CompiledImages images = compile(device, text, options, cache, key);
    // Machine code needs a driver of NVRTC's own major version or a later one, PTX one of its version or a later one.
    CUresult code = load(stream, images.machine_code, program);
    if (code == CUDA_SUCCESS) {
        cache.store(key, images.machine_code);
        return program;
    }
    if (is_refusal(code)) code = load(stream, images.ptx, program);
    if (code != CUDA_SUCCESS) fail_to_load(code, device);
    cache.store(key, images.ptx);
    return program;
}

}  // namespace fontana
