// The kernels as tables of loops. cpu_kernels.cpp is compiled several times: for strict arithmetic, and for each
// instruction set worth having. Plain C types only: code for a newer processor must not leak into shared inline
// functions.
#pragma once

#include <cstddef>

namespace fontana {

struct CpuKernel {
    // arguments[k]: the data of a buffer, or the address of a value.
    void (*run)(void* const* arguments, std::size_t begin, std::size_t end);
    int argument_count;
    const std::size_t* value_bytes;  // by argument; 0 for a buffer
};

// Tables indexed by Kernel.
const CpuKernel* strict_kernels();
const CpuKernel* baseline_kernels();
#if defined(__x86_64__)
const CpuKernel* avx2_kernels();
#endif

}  // namespace fontana
