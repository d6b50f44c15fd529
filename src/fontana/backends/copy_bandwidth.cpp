#include "backends/copy_bandwidth.h"

#include <algorithm>
#include <chrono>
#include <limits>

#include "kernels/step_constants.h"
#include "util/error.h"

namespace fontana {
namespace {

constexpr int k_repeats = 5;
// Launches in a row to a measurement, so that starting one does not count.
constexpr int k_launches = 4;

double seconds_of_copying(Backend& backend, std::uint32_t vector_count, const Buffer& from, const Buffer& to) {
    const auto begin = std::chrono::steady_clock::now();
    for (int k = 0; k < k_launches; ++k) backend.launch(Kernel::copy_vectors, vector_count, {vector_count, from, to});
    backend.finish();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace

double measure_copy_bandwidth(Backend& backend, std::size_t bytes) {
    const std::size_t vector_count = bytes / sizeof(float4);
    if (vector_count == 0 || vector_count > std::numeric_limits<std::uint32_t>::max())
        fail(FONTANA_BAD_INPUT, "copying is measured with 16 bytes to 64 GiB, not with " + std::to_string(bytes));
    const auto count = static_cast<std::uint32_t>(vector_count);
    const auto from = backend.allocate("copied from", vector_count * sizeof(float4));
    const auto to = backend.allocate("copied to", vector_count * sizeof(float4));
    seconds_of_copying(backend, count, *from, *to);  // a device builds or loads the kernel when it first runs
    double best = std::numeric_limits<double>::infinity();
    for (int k = 0; k < k_repeats; ++k) best = std::min(best, seconds_of_copying(backend, count, *from, *to));
    return k_launches * 2.0 * static_cast<double>(vector_count * sizeof(float4)) / best;
}

}  // namespace fontana
