// Runs a translated kernel, block by block, on the calling thread.
#pragma once

#include <cstdint>
#include <vector>

#include "device.h"
#include "memory.h"

namespace stand_in {

// Threads of a block take turns at its barriers. Throws a DeviceFault where a device would stop: an access that memory
// refuses, or a barrier that some threads of a block never reach. With FONTANA_STAND_IN_ORDER=reversed the last block
// and the last thread go first: what depends on the order differs.
void execute(const KernelCode& kernel, unsigned grid_size, unsigned block_size,
             const std::vector<unsigned char>& parameters, DeviceMemory& memory);

}  // namespace stand_in
