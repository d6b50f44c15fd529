#include "backends/opencl/opencl_sort.h"

#include <cstdint>

#include "util/error.h"

namespace fontana {
namespace {

constexpr std::size_t k_values_per_thread = 4;  // VALUES_PER_THREAD of sort.cl

void require_values(const Buffer& buffer, std::size_t count) {
    if (count <= buffer.bytes() / sizeof(cl_uint)) return;
    fail(FONTANA_INTERNAL,
         "the buffer " + buffer.name() + " has no room for " + std::to_string(count) + " values of the sort");
}

// Never shrinks.
void grow(CommandQueue& queue, std::unique_ptr<Buffer>& buffer, const char* name, std::size_t bytes) {
    if (buffer && buffer->bytes() >= bytes) return;
    buffer.reset();
    buffer = queue.allocate(name, bytes);
}

}  // namespace

DeviceSort::DeviceSort(const OpenClDevice& device, cl_program program)
    : histogram_(device, program, "sort_histogram", "sort: histogram"),
      scan_blocks_(device, program, "sort_scan_blocks", "sort: scan blocks"),
      add_offsets_(device, program, "sort_add_offsets", "sort: add offsets"),
      scatter_(device, program, "sort_scatter", "sort: scatter"),
      order_ties_(device, program, "sort_order_ties", "sort: order ties"),
      values_per_block_(device.group_size * k_values_per_thread) {}

void DeviceSort::sort(CommandQueue& queue, const Buffer& key, std::size_t count, std::size_t key_count, Buffer& order,
                      Buffer& start) {
    queue.require_alive();
    require_values(key, count);
    require_values(order, count);
    require_values(start, key_count + 1);
    grow(queue, rank_, "sort: rank", key.bytes());
    const auto value_count = static_cast<cl_uint>(count);
    queue.clear(start, (key_count + 1) * sizeof(cl_uint), "sort: clear");
    histogram_.launch(queue, count, {value_count, key, start, *rank_});
    // The last entry counts nothing, so its exclusive sum is the end of the last key.
    scan(queue, start, key_count + 1, 0);
    scatter_.launch(queue, count, {value_count, key, *rank_, start, order});
    if (count > 1) order_ties_.launch(queue, key_count, {static_cast<cl_uint>(key_count), start, order});
}

void DeviceSort::scan(CommandQueue& queue, Buffer& value, std::size_t count, std::size_t level) {
    const std::size_t block_count = (count + values_per_block_ - 1) / values_per_block_;
    if (level == block_totals_.size()) block_totals_.emplace_back();
    // Room for all that `value` may come to hold, so that it grows only when that does.
    const std::size_t most_blocks = value.bytes() / sizeof(cl_uint) / values_per_block_ + 1;
    grow(queue, block_totals_[level], "sort: block totals", most_blocks * sizeof(cl_uint));
    Buffer& totals = *block_totals_[level];
    const auto value_count = static_cast<cl_uint>(count);
    scan_blocks_.launch(queue, block_count * values_per_block_ / k_values_per_thread, {value_count, value, totals});
    if (block_count == 1) return;
    scan(queue, totals, block_count, level + 1);
    add_offsets_.launch(queue, count, {value_count, value, totals});
}

}  // namespace fontana
