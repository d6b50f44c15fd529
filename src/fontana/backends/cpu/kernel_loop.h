// The loop over the threads of a kernel, made from its signature: KERNEL void f(THREAD_ARG ...) becomes a CpuKernel.
// For one .cpp file a kernel: what is here is that file's own, because a file may be compiled for a newer processor.
#pragma once

#include "backends/cpu/cpu_kernels.h"
#include "backends/cpu/device_types.h"

namespace fontana {
namespace {

// Reads the signature of a kernel, so that no list of arguments is kept by hand.
template <typename Signature>
struct Loop;

template <typename... T>
struct Loop<void (*)(uint, T...)> {
    static constexpr std::size_t value_bytes[] = {KernelValue<T>::bytes...};

    template <void (*kernel)(uint, T...)>
    static void run(void* const* arguments, std::size_t begin, std::size_t end) {
        run_with<kernel>(arguments, begin, end, std::index_sequence_for<T...>());
    }

    template <void (*kernel)(uint, T...), std::size_t... k>
    static void run_with(void* const* arguments, std::size_t begin, std::size_t end, std::index_sequence<k...>) {
        for (std::size_t i = begin; i < end; ++i) kernel(static_cast<uint>(i), KernelValue<T>::get(arguments[k])...);
    }
};

template <typename Kernel, Kernel kernel>
constexpr CpuKernel cpu_kernel() {
    return {&Loop<Kernel>::template run<kernel>, sizeof(Loop<Kernel>::value_bytes) / sizeof(std::size_t),
            Loop<Kernel>::value_bytes};
}

}  // namespace
}  // namespace fontana
