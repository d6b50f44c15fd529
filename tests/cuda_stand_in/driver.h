// What the two halves of the stand-in driver share: the objects it hands out, and what every call begins with.
#pragma once

#include <chrono>
#include <cstddef>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "backends/cuda/cuda_types.h"
#include "device.h"
#include "faults.h"
#include "memory.h"

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

namespace stand_in {

using namespace fontana;

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
State& state();

extern thread_local std::vector<CUcontext> current_contexts;

// An environment variable as a number.
int setting(const char* name, int otherwise);
std::size_t memory_limit();  // bytes

template <typename Handle>
bool is_alive(const std::set<Handle>& handles, Handle handle) {
    return handles.count(handle) > 0;
}

// The current context, where a call may use it. What stands against that goes to `code`.
CUcontext usable_context(CUresult& code);
bool belongs(CUstream stream, CUcontext context);

// Says a sentence on stderr and returns the code.
CUresult complain(CUresult code, const std::string& sentence);

// A function is its kernel's code, which stays for good.
inline const KernelCode& kernel_of(CUfunction function) { return *reinterpret_cast<const KernelCode*>(function); }

}  // namespace stand_in

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
