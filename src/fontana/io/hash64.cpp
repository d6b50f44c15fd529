#include "io/hash64.h"

#include <algorithm>
#include <cstring>

namespace fontana {
namespace {

constexpr std::size_t word_bytes = 8;

std::uint64_t mixed(std::uint64_t state, std::uint64_t word) {
    constexpr std::uint64_t fnv_prime = 0x100000001b3u;
    state = (state ^ word) * fnv_prime;
    return state ^ (state >> 32);
}

std::uint64_t little_endian_word(const unsigned char* bytes) {
    std::uint64_t word;
    std::memcpy(&word, bytes, word_bytes);
#if __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
    word = __builtin_bswap64(word);
#endif
    return word;
}

}  // namespace

void Hash64::update(const void* data, std::size_t bytes) {
    if (bytes == 0) return;
    const auto* next = static_cast<const unsigned char*>(data);
    const std::size_t begun = total_bytes_ % word_bytes;
    total_bytes_ += bytes;
    if (begun > 0) {
        const std::size_t taken = std::min(bytes, word_bytes - begun);
        std::memcpy(tail_ + begun, next, taken);
        if (begun + taken < word_bytes) return;
        state_ = mixed(state_, little_endian_word(tail_));
        next += taken;
        bytes -= taken;
    }
    for (; bytes >= word_bytes; bytes -= word_bytes, next += word_bytes) {
        state_ = mixed(state_, little_endian_word(next));
    }
    std::memset(tail_, 0, word_bytes);
    std::memcpy(tail_, next, bytes);
}

std::uint64_t Hash64::value() const {
    const bool has_tail = total_bytes_ % word_bytes != 0;
    return mixed(has_tail ? mixed(state_, little_endian_word(tail_)) : state_, total_bytes_);
}

std::uint64_t hash64(const void* data, std::size_t bytes) {
    Hash64 hash;
    hash.update(data, bytes);
    return hash.value();
}

}  // namespace fontana
