// Compiled once per variant, with FONTANA_CPU_KERNELS as the name of the table's function (see CMakeLists.txt).
#include "backends/cpu/cpu_kernels.h"

#include "kernels/kernels.h"

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

constexpr CpuKernel table[] = {
#define KERNEL_ENTRY(function, bytes, flops)              \
    {&Loop<decltype(&function)>::template run<&function>, \
     sizeof(Loop<decltype(&function)>::value_bytes) / sizeof(std::size_t), Loop<decltype(&function)>::value_bytes},
#include "kernels/kernel_list.def"
#undef KERNEL_ENTRY
};

}  // namespace

const CpuKernel* FONTANA_CPU_KERNELS() { return table; }

}  // namespace fontana
