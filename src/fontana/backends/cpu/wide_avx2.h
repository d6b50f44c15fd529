// Eight floats at once (AVX2 and FMA), with just the operations that the pair formulas and their loops need. Arithmetic
// is the compiler's own on vector types; intrinsics only where the language has no word for it.
#pragma once

#include <immintrin.h>

#include "backends/cpu/device_types.h"

namespace fontana::wide_avx2 {

typedef float Vec8 __attribute__((vector_size(32)));
typedef Vec8 Vec;
constexpr uint width = 8;

struct Vec4 {
    Vec x, y, z, w;
};

inline Vec max_f(Vec a, float b) { return _mm256_max_ps(a, _mm256_set1_ps(b)); }
inline Vec min_of(Vec a, Vec b) { return _mm256_min_ps(a, b); }
inline Vec min_f(Vec a, float b) { return _mm256_min_ps(a, _mm256_set1_ps(b)); }

// 1 / sqrt(a): the processor's estimate and one step of Newton, two units in the last place.
inline Vec inverse_sqrt(Vec a) {
    const Vec y = _mm256_rsqrt_ps(a);
    return y * (1.5f - 0.5f * a * y * y);
}

// As near to that as is quick: here the estimate alone has twelve bits, too few.
inline Vec quick_inverse_sqrt(Vec a) { return inverse_sqrt(a); }

inline float sum_of(Vec a) {
    __m128 s = _mm_add_ps(_mm256_castps256_ps128(a), _mm256_extractf128_ps(a, 1));
    s = _mm_add_ps(s, _mm_movehl_ps(s, s));
    return _mm_cvtss_f32(_mm_add_ss(s, _mm_movehdup_ps(s)));
}

// The sums of a, b, c and d.
inline float4 sums_of(Vec a, Vec b, Vec c, Vec d) {
    const __m256 abcd = _mm256_hadd_ps(_mm256_hadd_ps(a, b), _mm256_hadd_ps(c, d));
    float4 sums;
    _mm_store_ps(&sums.x, _mm_add_ps(_mm256_castps256_ps128(abcd), _mm256_extractf128_ps(abcd, 1)));
    return sums;
}

inline Vec floor_of(Vec a) { return _mm256_floor_ps(a); }

// The sums of eight vectors, as a vector.
inline Vec sums_of(const Vec (&a)[8]) {
    const __m256 s01 = _mm256_hadd_ps(a[0], a[1]), s23 = _mm256_hadd_ps(a[2], a[3]);
    const __m256 s45 = _mm256_hadd_ps(a[4], a[5]), s67 = _mm256_hadd_ps(a[6], a[7]);
    const __m256 low = _mm256_hadd_ps(s01, s23), high = _mm256_hadd_ps(s45, s67);
    return _mm256_add_ps(_mm256_permute2f128_ps(low, high, 0x20), _mm256_permute2f128_ps(low, high, 0x31));
}

inline Vec load(const float* a) { return _mm256_loadu_ps(a); }
inline void store(float* to, Vec a) { _mm256_storeu_ps(to, a); }

// Rows (x y z w) of two particles each, 0|4 1|5 2|6 3|7, to columns.
inline Vec4 transpose(__m256 r0, __m256 r1, __m256 r2, __m256 r3) {
    const __m256 xy01 = _mm256_unpacklo_ps(r0, r1), zw01 = _mm256_unpackhi_ps(r0, r1);
    const __m256 xy23 = _mm256_unpacklo_ps(r2, r3), zw23 = _mm256_unpackhi_ps(r2, r3);
    return {_mm256_shuffle_ps(xy01, xy23, 0x44), _mm256_shuffle_ps(xy01, xy23, 0xee),
            _mm256_shuffle_ps(zw01, zw23, 0x44), _mm256_shuffle_ps(zw01, zw23, 0xee)};
}

inline __m256 rows(const float4& a, const float4& b) {
    return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_load_ps(&a.x)), _mm_load_ps(&b.x), 1);
}

inline Vec4 load(const float4* a) {
    return transpose(rows(a[0], a[4]), rows(a[1], a[5]), rows(a[2], a[6]), rows(a[3], a[7]));
}

inline Vec4 gather(const float4* a, const uint* k) {
    return transpose(rows(a[k[0]], a[k[4]]), rows(a[k[1]], a[k[5]]), rows(a[k[2]], a[k[6]]), rows(a[k[3]], a[k[7]]));
}

inline Vec gather(const float* a, const uint* index) {
    return _mm256_i32gather_ps(a, _mm256_loadu_si256(reinterpret_cast<const __m256i*>(index)), 4);
}

// Bit k: a_k < b.
inline uint less_mask(Vec a, float b) {
    return static_cast<uint>(_mm256_movemask_ps(_mm256_cmp_ps(a, _mm256_set1_ps(b), _CMP_LT_OQ)));
}

// Lanes whose bit is set; 0 in the others.
inline Vec keep(uint mask, Vec a) {
    const __m256i bits = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
    const __m256i set = _mm256_and_si256(_mm256_set1_epi32(static_cast<int>(mask)), bits);
    return _mm256_and_ps(_mm256_castsi256_ps(_mm256_cmpeq_epi32(set, bits)), a);
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

// Writes the words whose bit is set to `out`, in order, and returns how many; it may write over eight.
inline uint compress_store(uint mask, const uint* words, uint* out) {
    const __m256i places = _mm256_load_si256(reinterpret_cast<const __m256i*>(k_compress.place[mask]));
    const __m256i all = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(words));
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(out), _mm256_permutevar8x32_epi32(all, places));
    return static_cast<uint>(__builtin_popcount(mask));
}

// out[k] = first + k
inline void store_indices(uint first, uint* out) {
    const __m256i places = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(out),
                        _mm256_add_epi32(_mm256_set1_epi32(static_cast<int>(first)), places));
}

}  // namespace fontana::wide_avx2
