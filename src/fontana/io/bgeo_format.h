// The parts of the .bgeo format that its writer and its reader share.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace fontana::bgeo {

constexpr char magic[] = {'B', 'g', 'e', 'o', 'V'};
constexpr std::int32_t version = 5;
constexpr unsigned char end_mark[] = {0x00, 0xff};
constexpr std::size_t word_bytes = 4;
constexpr std::size_t block_bytes = std::size_t{1} << 20;  // points go to and from disk in pieces of about this size

enum class Type : std::int32_t { floating = 0, integer = 1, string = 2, indexed_string = 4, vector = 5 };

struct Attribute {
    const char* name;
    Type type;
    std::uint16_t components;
};

// In the order in which the writer puts them, after P.
constexpr std::array<Attribute, 6> attributes = {{
    {"v", Type::vector, 3},
    {"id", Type::integer, 1},
    {"density", Type::floating, 1},
    {"pressure", Type::floating, 1},
    {"pscale", Type::floating, 1},
    {"mass", Type::floating, 1},
}};
constexpr std::size_t position_words = 4;  // x y z w

// Converts both ways. Floats are handled as words only, so that the bits of a NaN survive.
inline std::uint32_t big_endian(std::uint32_t word) {
#if __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
    return word;
#else
    return __builtin_bswap32(word);
#endif
}

inline std::uint16_t big_endian(std::uint16_t half) {
#if __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
    return half;
#else
    return __builtin_bswap16(half);
#endif
}

// Copies `count` items of `words` words each between two strided arrays, swapping the bytes of each word. Strides are
// in words; memory is addressed through memcpy because neither side need be aligned or of type uint32_t.
inline void copy_swapped(unsigned char* to, std::size_t to_stride, const unsigned char* from, std::size_t from_stride,
                         std::size_t words, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t k = 0; k < words; ++k) {
            std::uint32_t word;
            std::memcpy(&word, from + (i * from_stride + k) * word_bytes, word_bytes);
            word = big_endian(word);
            std::memcpy(to + (i * to_stride + k) * word_bytes, &word, word_bytes);
        }
    }
}

}  // namespace fontana::bgeo
