// A stable parallel radix sort of indices by key (thesis III.4), which also finds where each key's range starts.
// Our own: the standard library's parallel sort needs oneTBB, and no library gives the ranges in the same pass.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "backends/cpu/thread_pool.h"

namespace fontana {

class RadixSort {
 public:
    struct Item {
        std::uint32_t key, index;
    };

    // order: count indices; start: key_count + 1 entries; scratch: 2 count items. The result does not depend on the
    // number of threads.
    void sort(ThreadPool& pool, const std::uint32_t* key, std::size_t count, std::size_t key_count,
              std::uint32_t* order, std::uint32_t* start, Item* scratch);

 private:
    void pass(ThreadPool& pool, const Item* from, Item* to, std::size_t count, int shift);

    std::vector<std::uint32_t> histogram_;
};

}  // namespace fontana
