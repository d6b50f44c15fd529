// The stable counting sort on a device; sort.inl has its kernels and says how it works.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "backends/backend.h"
#include "util/error.h"

namespace fontana {

// Queue: allocate(name, bytes), clear(buffer, bytes, label), require_alive().
// Kernel: launch(queue, thread_count, arguments).
template <typename Queue, typename Kernel>
class DeviceSort {
 public:
    // `make_kernel(function, label)` takes a kernel out of the device program, which was compiled for groups of
    // `group_size` threads.
    template <typename MakeKernel>
    DeviceSort(std::size_t group_size, const MakeKernel& make_kernel)
        : histogram_(make_kernel("sort_histogram", "sort: histogram")),
          scan_blocks_(make_kernel("sort_scan_blocks", "sort: scan blocks")),
          add_offsets_(make_kernel("sort_add_offsets", "sort: add offsets")),
          scatter_(make_kernel("sort_scatter", "sort: scatter")),
          order_ties_(make_kernel("sort_order_ties", "sort: order ties")),
          values_per_block_(group_size * k_values_per_thread) {}

    // As Backend::sort. The buffers it needs beside are kept for the next call and grow with those it is given.
    void sort(Queue& queue, const Buffer& key, std::size_t count, std::size_t key_count, Buffer& order, Buffer& start,
              Buffer& rank) {
        queue.require_alive();
        require_values(key, count);
        require_values(order, count);
        require_values(start, key_count + 1);
        require_values(rank, count);
        const auto value_count = static_cast<std::uint32_t>(count);
        queue.clear(start, (key_count + 1) * sizeof(std::uint32_t), "sort: clear");
        histogram_.launch(queue, count, {value_count, key, start, rank});
        // The last entry counts nothing, so its exclusive sum is the end of the last key.
        scan(queue, start, key_count + 1, 0);
        scatter_.launch(queue, count, {value_count, key, rank, start, order});
        if (count > 1) order_ties_.launch(queue, key_count, {static_cast<std::uint32_t>(key_count), start, order});
    }

 private:
    static constexpr std::size_t k_values_per_thread = 4;  // VALUES_PER_THREAD of sort.inl

    static void require_values(const Buffer& buffer, std::size_t count) {
        if (count <= buffer.bytes() / sizeof(std::uint32_t)) return;
        fail(FONTANA_INTERNAL,
             "the buffer " + buffer.name() + " has no room for " + std::to_string(count) + " values of the sort");
    }

    // Never shrinks.
    static void grow(Queue& queue, std::unique_ptr<Buffer>& buffer, const char* name, std::size_t bytes) {
        if (buffer && buffer->bytes() >= bytes) return;
        buffer.reset();
        buffer = queue.allocate(name, bytes);
    }

    void scan(Queue& queue, Buffer& value, std::size_t count, std::size_t level) {
        const std::size_t block_count = (count + values_per_block_ - 1) / values_per_block_;
        if (level == block_totals_.size()) block_totals_.emplace_back();
        // Room for all that `value` may come to hold, so that it grows only when that does.
        const std::size_t most_blocks = value.bytes() / sizeof(std::uint32_t) / values_per_block_ + 1;
        grow(queue, block_totals_[level], "sort: block totals", most_blocks * sizeof(std::uint32_t));
        Buffer& totals = *block_totals_[level];
        const auto value_count = static_cast<std::uint32_t>(count);
        scan_blocks_.launch(queue, block_count * values_per_block_ / k_values_per_thread, {value_count, value, totals});
        if (block_count == 1) return;
        scan(queue, totals, block_count, level + 1);
        add_offsets_.launch(queue, count, {value_count, value, totals});
    }

    Kernel histogram_, scan_blocks_, add_offsets_, scatter_, order_ties_;
    std::size_t values_per_block_;
    std::vector<std::unique_ptr<Buffer>> block_totals_;  // by level of the scan
};

}  // namespace fontana
