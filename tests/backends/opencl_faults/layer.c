/* An OpenCL layer that makes one call fail: the k-th of a chosen function, with a chosen error code.
 *
 * The loader puts it between a program and the driver if OPENCL_LAYERS names the library (ocl-icd 2.3 or later). The
 * test arms it in its own process through the two functions at the end; until then every call passes and is counted.
 * Functions that release things are left alone: their errors have no remedy and Fontana ignores them.
 */
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>
#include <string.h>

/* The functions, and where they stand in the table of the installable client driver (Khronos' cl_icd.h): an ABI. */
/* clang-format off */
#define FOR_EACH_FUNCTION(apply)         \
    apply(clGetPlatformIDs, 0)           \
    apply(clGetPlatformInfo, 1)          \
    apply(clGetDeviceIDs, 2)             \
    apply(clGetDeviceInfo, 3)            \
    apply(clCreateContext, 4)            \
    apply(clCreateCommandQueue, 9)       \
    apply(clCreateBuffer, 14)            \
    apply(clCreateProgramWithSource, 26) \
    apply(clCreateProgramWithBinary, 27) \
    apply(clBuildProgram, 30)            \
    apply(clGetProgramInfo, 32)          \
    apply(clGetProgramBuildInfo, 33)     \
    apply(clCreateKernel, 34)            \
    apply(clSetKernelArg, 38)            \
    apply(clGetKernelInfo, 39)           \
    apply(clGetKernelWorkGroupInfo, 40)  \
    apply(clGetEventProfilingInfo, 45)   \
    apply(clCreateSubBuffer, 82)         \
    apply(clFinish, 47)                  \
    apply(clEnqueueReadBuffer, 48)       \
    apply(clEnqueueWriteBuffer, 49)      \
    apply(clEnqueueCopyBuffer, 50)       \
    apply(clEnqueueNDRangeKernel, 59)    \
    apply(clEnqueueFillBuffer, 102)
/* clang-format on */

enum {
#define INDEX(function, index) INDEX_##function = index,
    FOR_EACH_FUNCTION(INDEX) TABLE_SIZE
};

typedef void (*any_function)(void);
static any_function layer[TABLE_SIZE]; /* what is null here goes straight to the driver */
static const any_function* driver;

static char armed_function[64];
static long armed_call, call_count;
static cl_int armed_code;

static int fails(const char* function) { return strcmp(function, armed_function) == 0 && ++call_count == armed_call; }

#define NEXT(function) ((__typeof__(&function))driver[INDEX_##function])

#define RETURNS_CODE(function, parameters, arguments)                    \
    static cl_int CL_API_CALL layer_##function parameters {              \
        return fails(#function) ? armed_code : NEXT(function) arguments; \
    }

/* `code` is the last parameter of all functions that return an object. */
#define RETURNS_OBJECT(type, function, parameters, arguments)   \
    static type CL_API_CALL layer_##function parameters {       \
        if (!fails(#function)) return NEXT(function) arguments; \
        if (code) *code = armed_code;                           \
        return NULL;                                            \
    }

typedef void(CL_CALLBACK* context_callback)(const char*, const void*, size_t, void*);
typedef void(CL_CALLBACK* build_callback)(cl_program, void*);

RETURNS_CODE(clGetPlatformIDs, (cl_uint n, cl_platform_id* ids, cl_uint* count), (n, ids, count))
RETURNS_CODE(clGetPlatformInfo, (cl_platform_id id, cl_platform_info what, size_t n, void* to, size_t* size),
             (id, what, n, to, size))
RETURNS_CODE(clGetDeviceIDs, (cl_platform_id id, cl_device_type type, cl_uint n, cl_device_id* ids, cl_uint* count),
             (id, type, n, ids, count))
RETURNS_CODE(clGetDeviceInfo, (cl_device_id id, cl_device_info what, size_t n, void* to, size_t* size),
             (id, what, n, to, size))
RETURNS_OBJECT(cl_context, clCreateContext,
               (const cl_context_properties* properties, cl_uint n, const cl_device_id* ids, context_callback callback,
                void* user, cl_int* code),
               (properties, n, ids, callback, user, code))
RETURNS_OBJECT(cl_command_queue, clCreateCommandQueue,
               (cl_context context, cl_device_id id, cl_command_queue_properties properties, cl_int* code),
               (context, id, properties, code))
RETURNS_OBJECT(cl_mem, clCreateBuffer, (cl_context context, cl_mem_flags flags, size_t n, void* host, cl_int* code),
               (context, flags, n, host, code))
RETURNS_OBJECT(cl_mem, clCreateSubBuffer,
               (cl_mem whole, cl_mem_flags flags, cl_buffer_create_type type, const void* region, cl_int* code),
               (whole, flags, type, region, code))
RETURNS_OBJECT(cl_program, clCreateProgramWithSource,
               (cl_context context, cl_uint n, const char** text, const size_t* sizes, cl_int* code),
               (context, n, text, sizes, code))
RETURNS_OBJECT(cl_program, clCreateProgramWithBinary,
               (cl_context context, cl_uint n, const cl_device_id* ids, const size_t* sizes, const unsigned char** data,
                cl_int* status, cl_int* code),
               (context, n, ids, sizes, data, status, code))
RETURNS_CODE(clBuildProgram,
             (cl_program program, cl_uint n, const cl_device_id* ids, const char* options, build_callback callback,
              void* user),
             (program, n, ids, options, callback, user))
RETURNS_CODE(clGetProgramInfo, (cl_program program, cl_program_info what, size_t n, void* to, size_t* size),
             (program, what, n, to, size))
RETURNS_CODE(clGetProgramBuildInfo,
             (cl_program program, cl_device_id id, cl_program_build_info what, size_t n, void* to, size_t* size),
             (program, id, what, n, to, size))
RETURNS_OBJECT(cl_kernel, clCreateKernel, (cl_program program, const char* name, cl_int* code), (program, name, code))
RETURNS_CODE(clSetKernelArg, (cl_kernel kernel, cl_uint index, size_t n, const void* value), (kernel, index, n, value))
RETURNS_CODE(clGetKernelInfo, (cl_kernel kernel, cl_kernel_info what, size_t n, void* to, size_t* size),
             (kernel, what, n, to, size))
RETURNS_CODE(clGetKernelWorkGroupInfo,
             (cl_kernel kernel, cl_device_id id, cl_kernel_work_group_info what, size_t n, void* to, size_t* size),
             (kernel, id, what, n, to, size))
RETURNS_CODE(clGetEventProfilingInfo, (cl_event event, cl_profiling_info what, size_t n, void* to, size_t* size),
             (event, what, n, to, size))
RETURNS_CODE(clFinish, (cl_command_queue queue), (queue))
RETURNS_CODE(clEnqueueReadBuffer,
             (cl_command_queue queue, cl_mem from, cl_bool wait, size_t offset, size_t n, void* to, cl_uint events,
              const cl_event* list, cl_event* event),
             (queue, from, wait, offset, n, to, events, list, event))
RETURNS_CODE(clEnqueueWriteBuffer,
             (cl_command_queue queue, cl_mem to, cl_bool wait, size_t offset, size_t n, const void* from,
              cl_uint events, const cl_event* list, cl_event* event),
             (queue, to, wait, offset, n, from, events, list, event))
RETURNS_CODE(clEnqueueCopyBuffer,
             (cl_command_queue queue, cl_mem from, cl_mem to, size_t from_offset, size_t to_offset, size_t n,
              cl_uint events, const cl_event* list, cl_event* event),
             (queue, from, to, from_offset, to_offset, n, events, list, event))
RETURNS_CODE(clEnqueueNDRangeKernel,
             (cl_command_queue queue, cl_kernel kernel, cl_uint dimensions, const size_t* offset, const size_t* global,
              const size_t* local, cl_uint events, const cl_event* list, cl_event* event),
             (queue, kernel, dimensions, offset, global, local, events, list, event))
RETURNS_CODE(clEnqueueFillBuffer,
             (cl_command_queue queue, cl_mem to, const void* pattern, size_t pattern_size, size_t offset, size_t n,
              cl_uint events, const cl_event* list, cl_event* event),
             (queue, to, pattern, pattern_size, offset, n, events, list, event))

/* ---- what the loader calls (cl_loader_layers 1.0; the constants are those of Khronos' cl_layer.h) ---- */

CL_API_ENTRY cl_int CL_API_CALL clGetLayerInfo(cl_uint what, size_t n, void* to, size_t* size) {
    static const char name[] = "fontana faults";
    const cl_uint version = 100;
    const int is_version = what == 0x4240;
    if (!is_version && what != 0x4241) return CL_INVALID_VALUE;
    const size_t needed = is_version ? sizeof version : sizeof name;
    if (to && n < needed) return CL_INVALID_VALUE;
    if (to) memcpy(to, is_version ? (const void*)&version : name, needed);
    if (size) *size = needed;
    return CL_SUCCESS;
}

CL_API_ENTRY cl_int CL_API_CALL clInitLayer(cl_uint target_size, const any_function* target, cl_uint* layer_size,
                                            const any_function** table) {
    if (target_size < TABLE_SIZE) return CL_INVALID_VALUE;
#define PUT(function, index) layer[index] = (any_function)layer_##function;
    FOR_EACH_FUNCTION(PUT)
    driver = target;
    *layer_size = TABLE_SIZE;
    *table = layer;
    return CL_SUCCESS;
}

/* ---- what the test calls ---- */

/* From now on call number `call` (1 is the next, 0 none) of `function` returns `code`, and its calls are counted. */
void arm_fault(const char* function, long call, int code) {
    strncpy(armed_function, function, sizeof armed_function - 1);
    armed_call = call;
    armed_code = code;
    call_count = 0;
}

long count_calls(void) { return call_count; }
