// The content hash of every file Fontana writes.
#pragma once

#include <cstddef>
#include <cstdint>

namespace fontana {

// FNV-1a (Fowler, Noll, Vo) taken over 64-bit little-endian words instead of bytes, for speed: the last word is padded
// with zeros, and the number of bytes goes in at the end so that the padding cannot be taken for content. Each step is
// a bijection of the state, so two inputs of one length that differ inside a single word, a flipped byte for one, never
// share a hash. FNV alone would miss two flipped top bits in a row, since a multiplication carries upwards only; a
// shift folds the upper half down.
//
// Against accidents, not against an adversary: it is not cryptographic. Our own because it is a dozen lines.
class Hash64 {
 public:
    // The pieces may be cut anywhere; only their concatenation counts.
    void update(const void* data, std::size_t bytes);
    std::uint64_t value() const;

 private:
    std::uint64_t state_ = 0xcbf29ce484222325u;  // FNV's offset basis
    std::uint64_t total_bytes_ = 0;
    unsigned char tail_[8] = {};  // the word begun but not full: total_bytes_ % 8 bytes, zeros after
};

std::uint64_t hash64(const void* data, std::size_t bytes);

}  // namespace fontana
