// The stable counting sort on the device; sort.cl has its kernels and says how it works.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "backends/opencl/opencl_kernel.h"
#include "backends/opencl/opencl_queue.h"

namespace fontana {

class DeviceSort {
 public:
    DeviceSort(const OpenClDevice& device, cl_program program);

    // As Backend::sort. The buffers it needs beside are kept for the next call and grow with those it is given.
    void sort(CommandQueue& queue, const Buffer& key, std::size_t count, std::size_t key_count, Buffer& order,
              Buffer& start);

 private:
    void scan(CommandQueue& queue, Buffer& value, std::size_t count, std::size_t level);

    DeviceKernel histogram_, scan_blocks_, add_offsets_, scatter_, order_ties_;
    std::size_t values_per_block_;
    std::unique_ptr<Buffer> rank_;
    std::vector<std::unique_ptr<Buffer>> block_totals_;  // by level of the scan
};

}  // namespace fontana
