// Compiled once per variant, with FONTANA_CPU_KERNELS as the name of the table's function (see CMakeLists.txt).
#include "backends/cpu/cpu_kernels.h"
#include "backends/cpu/kernel_loop.h"
#include "kernels/kernels.h"

namespace fontana {
namespace {

constexpr CpuKernel table[] = {
#define KERNEL_ENTRY(function, bytes, flops) cpu_kernel<decltype(&function), &function>(),
#include "kernels/kernel_list.def"
#undef KERNEL_ENTRY
};

}  // namespace

const CpuKernel* FONTANA_CPU_KERNELS() { return table; }

}  // namespace fontana
