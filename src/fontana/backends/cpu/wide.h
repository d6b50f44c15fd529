// Eight floats at once (AVX2), with just the operations that the pair formulas and their loops need. Arithmetic is the
// compiler's own on vector types; intrinsics only where the language has no word for it.
#pragma once

#include <immintrin.h>

#include "backends/cpu/device_types.h"

namespace fontana::wide {

typedef float Vec8 __attribute__((vector_size(32)));
constexpr uint width = 8;

struct Vec8x4 {
    Vec8 x, y, z, w;
};

inline Vec8 broadcast(float a) { return _mm256_set1_ps(a); }
inline Vec8 max_f(Vec8 a, float b) { return _mm256_max_ps(a, _mm256_set1_ps(b)); }
inline Vec8 wide_sqrt(Vec8 a) { return _mm256_sqrt_ps(a); }

inline float sum_of(Vec8 a) {
    __m128 s = _mm_add_ps(_mm256_castps256_ps128(a), _mm256_extractf128_ps(a, 1));
    s = _mm_add_ps(s, _mm_movehl_ps(s, s));
    return _mm_cvtss_f32(_mm_add_ss(s, _mm_movehdup_ps(s)));
}

// Rows (x y z w) of two particles each, 0|4 1|5 2|6 3|7, to columns.
inline Vec8x4 transpose(__m256 r04, __m256 r15, __m256 r26, __m256 r37) {
    const __m256 xy01 = _mm256_unpacklo_ps(r04, r15), zw01 = _mm256_unpackhi_ps(r04, r15);
    const __m256 xy23 = _mm256_unpacklo_ps(r26, r37), zw23 = _mm256_unpackhi_ps(r26, r37);
    return {_mm256_shuffle_ps(xy01, xy23, 0x44), _mm256_shuffle_ps(xy01, xy23, 0xee),
            _mm256_shuffle_ps(zw01, zw23, 0x44), _mm256_shuffle_ps(zw01, zw23, 0xee)};
}

inline __m256 two_rows(const float4& low, const float4& high) {
    return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_load_ps(&low.x)), _mm_load_ps(&high.x), 1);
}

inline Vec8x4 load(const float4* a) {
    return transpose(two_rows(a[0], a[4]), two_rows(a[1], a[5]), two_rows(a[2], a[6]), two_rows(a[3], a[7]));
}

inline Vec8x4 gather(const float4* a, const uint* index) {
    return transpose(two_rows(a[index[0]], a[index[4]]), two_rows(a[index[1]], a[index[5]]),
                     two_rows(a[index[2]], a[index[6]]), two_rows(a[index[3]], a[index[7]]));
}

inline Vec8 gather(const float* a, const uint* index) {
    return _mm256_i32gather_ps(a, _mm256_loadu_si256(reinterpret_cast<const __m256i*>(index)), 4);
}

// Bit k: a_k < b.
inline uint less_mask(Vec8 a, float b) {
    return static_cast<uint>(_mm256_movemask_ps(_mm256_cmp_ps(a, _mm256_set1_ps(b), _CMP_LT_OQ)));
}

// a where index is not i, else 0: takes the padding of a list (the particle itself) out of a sum.
inline Vec8 without(Vec8 a, const uint* index, uint i) {
    const __m256i same = _mm256_cmpeq_epi32(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(index)),
                                            _mm256_set1_epi32(static_cast<int>(i)));
    return _mm256_andnot_ps(_mm256_castsi256_ps(same), a);
}

// For every mask of eight bits, the places of its set bits first.
struct CompressTable {
    alignas(64) uint place[256][8];
    constexpr CompressTable() : place() {
        for (uint mask = 0; mask < 256; ++mask) {
            uint found = 0;
            for (uint bit = 0; bit < 8; ++bit)
                if (mask >> bit & 1u) place[mask][found++] = bit;
        }
    }
};
inline constexpr CompressTable k_compress;

// Writes first + k for every set bit k of the mask to `out`, in order, and returns how many; it may write over eight.
inline uint compress_store(uint mask, uint first, uint* out) {
    const __m256i places = _mm256_load_si256(reinterpret_cast<const __m256i*>(k_compress.place[mask]));
    const __m256i indices = _mm256_add_epi32(places, _mm256_set1_epi32(static_cast<int>(first)));
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(out), indices);
    return static_cast<uint>(__builtin_popcount(mask));
}

}  // namespace fontana::wide
