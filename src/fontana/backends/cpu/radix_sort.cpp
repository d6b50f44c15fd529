#include "backends/cpu/radix_sort.h"

#include <algorithm>
#include <utility>

namespace fontana {
namespace {

constexpr int k_digit_bits = 11;  // 2048 counters of a chunk stay in the first-level cache
constexpr std::size_t k_digits = std::size_t{1} << k_digit_bits;
constexpr std::size_t k_chunk = 16384;
constexpr std::size_t k_grain = 8192;

}  // namespace

void RadixSort::sort(ThreadPool& pool, const std::uint32_t* key, std::size_t count, std::size_t key_count,
                     std::uint32_t* order, std::uint32_t* start, Item* scratch) {
    Item *items = scratch, *other = scratch + count;
    pool.run(count, k_grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) items[i] = {key[i], static_cast<std::uint32_t>(i)};
    });
    for (int shift = 0; (std::uint64_t{key_count} - 1) >> shift != 0; shift += k_digit_bits) {
        pass(pool, items, other, count, shift);
        std::swap(items, other);
    }
    pool.run(count, k_grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            order[i] = items[i].index;
            const std::size_t first_new = i == 0 ? 0 : std::size_t{items[i - 1].key} + 1;
            for (std::size_t k = first_new; k <= items[i].key; ++k) start[k] = static_cast<std::uint32_t>(i);
        }
    });
    const std::size_t after_last = count == 0 ? 0 : std::size_t{items[count - 1].key} + 1;
    std::fill(start + after_last, start + key_count + 1, static_cast<std::uint32_t>(count));
}

// One digit: each chunk counts its own, the counts become positions (all chunks of a digit in order, so it is stable),
// and each chunk places its items.
void RadixSort::pass(ThreadPool& pool, const Item* from, Item* to, std::size_t count, int shift) {
    const std::size_t chunk_count = (count + k_chunk - 1) / k_chunk;
    histogram_.assign(chunk_count * k_digits, 0);
    const auto digit = [shift](const Item& item) { return (item.key >> shift) & (k_digits - 1); };
    pool.run(chunk_count, 1, [&](std::size_t first, std::size_t last) {
        for (std::size_t chunk = first; chunk < last; ++chunk) {
            std::uint32_t* const counts = &histogram_[chunk * k_digits];
            const std::size_t end = std::min(count, (chunk + 1) * k_chunk);
            for (std::size_t i = chunk * k_chunk; i < end; ++i) ++counts[digit(from[i])];
        }
    });
    std::uint32_t position = 0;
    for (std::size_t d = 0; d < k_digits; ++d)
        for (std::size_t chunk = 0; chunk < chunk_count; ++chunk) {
            const std::uint32_t n = histogram_[chunk * k_digits + d];
            histogram_[chunk * k_digits + d] = position;
            position += n;
        }
    pool.run(chunk_count, 1, [&](std::size_t first, std::size_t last) {
        for (std::size_t chunk = first; chunk < last; ++chunk) {
            std::uint32_t* const positions = &histogram_[chunk * k_digits];
            const std::size_t end = std::min(count, (chunk + 1) * k_chunk);
            for (std::size_t i = chunk * k_chunk; i < end; ++i) to[positions[digit(from[i])]++] = from[i];
        }
    });
}

}  // namespace fontana
