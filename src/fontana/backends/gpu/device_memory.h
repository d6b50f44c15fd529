// Sizes of buffers on a device: rounded, checked, and in words.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>

#include "backends/backend.h"

namespace fontana {

inline std::size_t round_up(std::size_t value, std::size_t unit) { return (value + unit - 1) / unit * unit; }

// What is allocated for a buffer of `bytes`: never nothing, and a multiple of a float4, which is also one of the words
// that clear it.
std::size_t allocation_size(std::size_t bytes);

// "12 bytes", "3.5 MiB"
std::string size_text(std::size_t bytes);

// Throws unless the range lies in the buffer. `action` is as in "a write".
void require_inside(const Buffer& buffer, std::size_t offset, std::size_t bytes, const char* action);

}  // namespace fontana
