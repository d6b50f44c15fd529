// How fast a device moves memory: what the speed of every kernel is compared with.
#pragma once

#include <cstddef>

#include "backends/backend.h"

namespace fontana {

// Bytes a second, read and written ones counted, of copying `bytes` with the kernel copy_vectors: the best of a few.
// Throws BAD_INPUT for fewer than 16 bytes, OUT_OF_MEMORY where the device has no room for two arrays of that size.
double measure_copy_bandwidth(Backend& backend, std::size_t bytes);

}  // namespace fontana
