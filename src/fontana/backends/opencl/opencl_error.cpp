#include "backends/opencl/opencl_error.h"

#include "util/error.h"

namespace fontana {
namespace {

const char* standard_name(cl_int code) {
    switch (code) {
#define FONTANA_NAME(error) \
    case error:             \
        return #error;
        FONTANA_NAME(CL_DEVICE_NOT_FOUND)
        FONTANA_NAME(CL_DEVICE_NOT_AVAILABLE)
        FONTANA_NAME(CL_COMPILER_NOT_AVAILABLE)
        FONTANA_NAME(CL_MEM_OBJECT_ALLOCATION_FAILURE)
        FONTANA_NAME(CL_OUT_OF_RESOURCES)
        FONTANA_NAME(CL_OUT_OF_HOST_MEMORY)
        FONTANA_NAME(CL_PROFILING_INFO_NOT_AVAILABLE)
        FONTANA_NAME(CL_MEM_COPY_OVERLAP)
        FONTANA_NAME(CL_BUILD_PROGRAM_FAILURE)
        FONTANA_NAME(CL_MISALIGNED_SUB_BUFFER_OFFSET)
        FONTANA_NAME(CL_EXEC_STATUS_ERROR_FOR_EVENTS_IN_WAIT_LIST)
        FONTANA_NAME(CL_INVALID_VALUE)
        FONTANA_NAME(CL_INVALID_DEVICE_TYPE)
        FONTANA_NAME(CL_INVALID_PLATFORM)
        FONTANA_NAME(CL_INVALID_DEVICE)
        FONTANA_NAME(CL_INVALID_CONTEXT)
        FONTANA_NAME(CL_INVALID_QUEUE_PROPERTIES)
        FONTANA_NAME(CL_INVALID_COMMAND_QUEUE)
        FONTANA_NAME(CL_INVALID_HOST_PTR)
        FONTANA_NAME(CL_INVALID_MEM_OBJECT)
        FONTANA_NAME(CL_INVALID_BINARY)
        FONTANA_NAME(CL_INVALID_BUILD_OPTIONS)
        FONTANA_NAME(CL_INVALID_PROGRAM)
        FONTANA_NAME(CL_INVALID_PROGRAM_EXECUTABLE)
        FONTANA_NAME(CL_INVALID_KERNEL_NAME)
        FONTANA_NAME(CL_INVALID_KERNEL_DEFINITION)
        FONTANA_NAME(CL_INVALID_KERNEL)
        FONTANA_NAME(CL_INVALID_ARG_INDEX)
        FONTANA_NAME(CL_INVALID_ARG_VALUE)
        FONTANA_NAME(CL_INVALID_ARG_SIZE)
        FONTANA_NAME(CL_INVALID_KERNEL_ARGS)
        FONTANA_NAME(CL_INVALID_WORK_DIMENSION)
        FONTANA_NAME(CL_INVALID_WORK_GROUP_SIZE)
        FONTANA_NAME(CL_INVALID_WORK_ITEM_SIZE)
        FONTANA_NAME(CL_INVALID_GLOBAL_OFFSET)
        FONTANA_NAME(CL_INVALID_EVENT_WAIT_LIST)
        FONTANA_NAME(CL_INVALID_EVENT)
        FONTANA_NAME(CL_INVALID_OPERATION)
        FONTANA_NAME(CL_INVALID_BUFFER_SIZE)
        FONTANA_NAME(CL_INVALID_GLOBAL_WORK_SIZE)
#undef FONTANA_NAME
        case -1001:
            return "CL_PLATFORM_NOT_FOUND_KHR";  // of the loader extension, cl_khr_icd
        default:
            return nullptr;
    }
}

}  // namespace

std::string opencl_error_name(cl_int code) {
    const char* name = standard_name(code);
    return name ? std::string(name) + " (" + std::to_string(code) + ")" : "OpenCL error " + std::to_string(code);
}

bool is_out_of_memory(cl_int code) {
    return code == CL_MEM_OBJECT_ALLOCATION_FAILURE || code == CL_OUT_OF_RESOURCES || code == CL_OUT_OF_HOST_MEMORY;
}

void fail_to_start(cl_int code, const std::string& device, const std::string& call) {
    fail(is_out_of_memory(code) ? FONTANA_OUT_OF_MEMORY : FONTANA_DEVICE_UNAVAILABLE,
         "the OpenCL device '" + device + "' cannot be used: " + call + " failed with " + opencl_error_name(code));
}

}  // namespace fontana
