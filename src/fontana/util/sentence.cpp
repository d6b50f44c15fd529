#include "util/sentence.h"

#include <algorithm>
#include <cstddef>

namespace fontana {
namespace {

constexpr std::size_t k_longest = 8000;  // bytes: the longest path and a sentence around it

// Bytes of the character that starts at `index`, or 0 if there is none in UTF-8 (RFC 3629).
std::size_t character_bytes(const std::string& text, std::size_t index) {
    const auto byte = [&](std::size_t k) { return k < text.size() ? static_cast<unsigned char>(text[k]) : 0u; };
    const unsigned first = byte(index), second = byte(index + 1);
    const std::size_t length = first < 0x80   ? 1
                               : first < 0xc2 ? 0
                               : first < 0xe0 ? 2
                               : first < 0xf0 ? 3
                               : first < 0xf5 ? 4
                                              : 0;
    for (std::size_t k = 1; k < length; ++k)
        if ((byte(index + k) & 0xc0) != 0x80) return 0;
    const bool is_overlong = (first == 0xe0 && second < 0xa0) || (first == 0xf0 && second < 0x90);
    const bool is_beyond = (first == 0xed && second >= 0xa0) || (first == 0xf4 && second >= 0x90);
    return is_overlong || is_beyond ? 0 : length;
}

}  // namespace

std::string one_line(const std::string& text) {
    if (text.size() > k_longest)
        return one_line(text.substr(0, k_longest / 2 - 5) + " ... " + text.substr(text.size() - k_longest / 2));
    std::string line;
    line.reserve(text.size());
    for (std::size_t index = 0; index < text.size();) {
        const std::size_t bytes = character_bytes(text, index);
        const bool is_control = static_cast<unsigned char>(text[index]) < 0x20 || text[index] == 0x7f;
        if (bytes == 0 || is_control)
            line += is_control ? ' ' : '?';
        else
            line.append(text, index, bytes);
        index += std::max<std::size_t>(bytes, 1);
    }
    return line;
}

}  // namespace fontana
