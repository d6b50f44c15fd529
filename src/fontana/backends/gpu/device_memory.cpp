#include "backends/gpu/device_memory.h"

#include <cstdio>

#include "util/error.h"

namespace fontana {

std::size_t allocation_size(std::size_t bytes) {
    constexpr std::size_t k_unit = 16;  // bytes
    return round_up(std::max(bytes, k_unit), k_unit);
}

std::string size_text(std::size_t bytes) {
    constexpr std::size_t k_mebibyte = 1u << 20;
    if (bytes < k_mebibyte) return std::to_string(bytes) + " bytes";
    char text[32];
    std::snprintf(text, sizeof text, "%.1f MiB", static_cast<double>(bytes) / k_mebibyte);
    return text;
}

void require_inside(const Buffer& buffer, std::size_t offset, std::size_t bytes, const char* action) {
    if (offset <= buffer.bytes() && bytes <= buffer.bytes() - offset) return;
    fail(FONTANA_INTERNAL, std::string(action) + " of " + std::to_string(bytes) + " bytes at " +
                               std::to_string(offset) + " is beyond the buffer " + buffer.name() + ", which has " +
                               std::to_string(buffer.bytes()));
}

}  // namespace fontana
