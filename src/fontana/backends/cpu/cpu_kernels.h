// The kernels as tables of loops. cpu_kernels.cpp is compiled several times: for strict arithmetic, and for each
// instruction set worth having. Plain C types only: code for a newer processor must not leak into shared inline
// functions.
#pragma once

#include <cstddef>
#include <type_traits>
#include <utility>

namespace fontana {

// arguments[k]: the data of a buffer, or the address of a value.
using KernelLoop = void (*)(void* const* arguments, std::size_t begin, std::size_t end);

struct CpuKernel {
    KernelLoop run;
    int argument_count;
    const std::size_t* value_bytes;  // by argument; 0 for a buffer
};

// Tables indexed by Kernel.
const CpuKernel* strict_kernels();
const CpuKernel* baseline_kernels();
#if defined(__x86_64__)
const CpuKernel* avx2_kernels();
// The loop of a kernel over eight neighbours at once (AVX2 and FMA), or sixteen (AVX-512); null if it has none.
KernelLoop avx2_loop(const char* kernel);
KernelLoop avx512_loop(const char* kernel);
#endif
// Particles in a row that share a list of neighbours in the loops over several (wide_lists.h). The more they are, the
// less is read and kept, and the more is computed for nothing.
constexpr unsigned k_list_group = 4;

// How a kernel's argument of type T is had from what the backend collected.
template <typename T>
struct KernelValue {  // a value
    static constexpr std::size_t bytes = sizeof(T);
    static const T& get(void* address) { return *static_cast<const T*>(address); }
};

template <typename T>
struct KernelValue<T*> {  // a buffer
    static constexpr std::size_t bytes = 0;
    static T* get(void* address) { return static_cast<T*>(address); }
};

}  // namespace fontana
