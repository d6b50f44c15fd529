#include "backends/opencl/opencl_program.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "backends/gpu/failed_build.h"
#include "backends/gpu/kernel_cache.h"
#include "backends/gpu/kernel_text.h"
#include "backends/opencl/opencl_error.h"

namespace fontana {

namespace {

// NaNs must survive, so nothing here may assume finite numbers.
std::string build_options(const OpenClDevice& device, bool strict) {
    std::string options = "-cl-std=CL1.2 -DFONTANA_GROUP_SIZE=" + std::to_string(device.group_size);
    if (!device.info.is_gpu) options += " -DFONTANA_PACKED_LISTS";  // kernels/neighbor_list.h
    if (!strict) return options + " -cl-mad-enable -cl-no-signed-zeros";
    options += " -DFONTANA_STRICT";
    if (device.rounds_divisions_correctly) options += " -cl-fp32-correctly-rounded-divide-sqrt";
    return options;
}

// Everything the compiled program depends on.
std::string cache_key(const OpenClDevice& device, GpuText text, const std::string& options) {
    std::string whole;
    for (std::size_t i = 0; i < text.piece_count; ++i) whole += text.pieces[i];
    for (const std::string& part : {options, device.info.name, device.info.driver, device.platform_version})
        whole += '\0' + part;
    return KernelCache::key_of(whole);
}

std::string build_log(cl_program program, cl_device_id device) {
    std::size_t bytes = 0;
    opencl().clGetProgramBuildInfo(program, device, CL_PROGRAM_BUILD_LOG, 0, nullptr, &bytes);
    std::string log(bytes, '\0');
    if (opencl().clGetProgramBuildInfo(program, device, CL_PROGRAM_BUILD_LOG, bytes, log.data(), nullptr) != CL_SUCCESS)
        return "";
    log.resize(std::min(log.size(), log.find('\0')));
    return log;
}

OpenClProgram build_from_binary(cl_context context, const OpenClDevice& device, const std::string& options,
                                const std::vector<unsigned char>& binary) {
    if (binary.empty()) return nullptr;
    const unsigned char* data = binary.data();
    const std::size_t bytes = binary.size();
    cl_int code = CL_SUCCESS;
    OpenClProgram program(opencl().clCreateProgramWithBinary(context, 1, &device.id, &bytes, &data, nullptr, &code));
    if (code != CL_SUCCESS) return nullptr;
    code = opencl().clBuildProgram(program.get(), 1, &device.id, options.c_str(), nullptr, nullptr);
    return code == CL_SUCCESS ? std::move(program) : nullptr;
}

std::vector<unsigned char> binary_of(cl_program program) {
    std::size_t bytes = 0;
    if (opencl().clGetProgramInfo(program, CL_PROGRAM_BINARY_SIZES, sizeof bytes, &bytes, nullptr) != CL_SUCCESS)
        return {};
    std::vector<unsigned char> binary(bytes);
    unsigned char* data = binary.data();
    if (opencl().clGetProgramInfo(program, CL_PROGRAM_BINARIES, sizeof data, &data, nullptr) != CL_SUCCESS) return {};
    return binary;
}

}  // namespace

OpenClProgram build_opencl_program(cl_context context, const OpenClDevice& device, GpuText text, bool strict) {
    const KernelCache cache;
    const std::string options = build_options(device, strict);
    const std::string key = cache_key(device, text, options);
    OpenClProgram cached = build_from_binary(context, device, options, cache.load(key));
    if (cached) return cached;

    cl_int code = CL_SUCCESS;
    OpenClProgram program(opencl().clCreateProgramWithSource(context, static_cast<cl_uint>(text.piece_count),
                                                             const_cast<const char**>(text.pieces), nullptr, &code));
    if (code != CL_SUCCESS) fail_to_start(code, device.info.name, "clCreateProgramWithSource");
    code = opencl().clBuildProgram(program.get(), 1, &device.id, options.c_str(), nullptr, nullptr);
    if (code == CL_BUILD_PROGRAM_FAILURE)
        fail_to_build("the OpenCL device '" + device.info.name + "' (" + device.info.driver + ")",
                      build_log(program.get(), device.id), cache, key);
    if (code != CL_SUCCESS) fail_to_start(code, device.info.name, "clBuildProgram");
    if (!cache.is_open()) return program;  // making a binary costs some drivers as much as the build
    const std::vector<unsigned char> binary = binary_of(program.get());
    if (!binary.empty()) cache.store(key, binary);
    return program;
}

}  // namespace fontana
