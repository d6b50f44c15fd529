// Sixteen floats at once (AVX-512 F), with just the operations that the pair formulas and their loops need; wide_avx2.h
// says what each does.
#pragma once

#include <immintrin.h>

#include "backends/cpu/device_types.h"

namespace fontana::wide_avx512 {

typedef float Vec8 __attribute__((vector_size(32)));
typedef float Vec __attribute__((vector_size(64)));
constexpr uint width = 16;

struct Vec4 {
    Vec x, y, z, w;
};

inline Vec max_f(Vec a, float b) { return _mm512_max_ps(a, _mm512_set1_ps(b)); }
inline Vec min_of(Vec a, Vec b) { return _mm512_min_ps(a, b); }
inline Vec min_f(Vec a, float b) { return _mm512_min_ps(a, _mm512_set1_ps(b)); }

inline Vec inverse_sqrt(Vec a) {
    const Vec y = _mm512_rsqrt14_ps(a);
    return y * (1.5f - 0.5f * a * y * y);
}

// Fourteen bits: a gradient is wrong by a part in ten thousand (quick_pair_of).
inline Vec quick_inverse_sqrt(Vec a) { return _mm512_rsqrt14_ps(a); }

inline float sum_of(Vec a) { return _mm512_reduce_add_ps(a); }

inline Vec floor_of(Vec a) { return _mm512_roundscale_ps(a, _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC); }

// Sums of a, b, c and d of the quarters of each, a quarter after the other.
inline __m512 quarter_sums(Vec a, Vec b, Vec c, Vec d) {
    const __m512 ab = _mm512_add_ps(_mm512_unpacklo_ps(a, b), _mm512_unpackhi_ps(a, b));
    const __m512 cd = _mm512_add_ps(_mm512_unpacklo_ps(c, d), _mm512_unpackhi_ps(c, d));
    return _mm512_add_ps(_mm512_shuffle_ps(ab, cd, 0x44), _mm512_shuffle_ps(ab, cd, 0xee));
}

inline __m256 halves_of(__m512 a) {
    return _mm256_add_ps(_mm512_castps512_ps256(a), _mm512_castps512_ps256(_mm512_shuffle_f32x4(a, a, 0x4e)));
}

inline float4 sums_of(Vec a, Vec b, Vec c, Vec d) {
    const __m256 half = halves_of(quarter_sums(a, b, c, d));
    float4 sums;
    _mm_store_ps(&sums.x, _mm_add_ps(_mm256_castps256_ps128(half), _mm256_extractf128_ps(half, 1)));
    return sums;
}

inline Vec8 sums_of(const Vec (&a)[8]) {
    const __m256 low = halves_of(quarter_sums(a[0], a[1], a[2], a[3])),
                 high = halves_of(quarter_sums(a[4], a[5], a[6], a[7]));
    return _mm256_add_ps(_mm256_permute2f128_ps(low, high, 0x20), _mm256_permute2f128_ps(low, high, 0x31));
}

inline Vec load(const float* a) { return _mm512_loadu_ps(a); }
inline void store(float* to, Vec a) { _mm512_storeu_ps(to, a); }

// Rows (x y z w) of four particles each, 0|4|8|12 and so on, to columns.
inline Vec4 transpose(__m512 r0, __m512 r1, __m512 r2, __m512 r3) {
    const __m512 xy01 = _mm512_unpacklo_ps(r0, r1), zw01 = _mm512_unpackhi_ps(r0, r1);
    const __m512 xy23 = _mm512_unpacklo_ps(r2, r3), zw23 = _mm512_unpackhi_ps(r2, r3);
    return {_mm512_shuffle_ps(xy01, xy23, 0x44), _mm512_shuffle_ps(xy01, xy23, 0xee),
            _mm512_shuffle_ps(zw01, zw23, 0x44), _mm512_shuffle_ps(zw01, zw23, 0xee)};
}

inline __m512 rows(const float4& a, const float4& b, const float4& c, const float4& d) {
    const __m512 ab = _mm512_insertf32x4(_mm512_castps128_ps512(_mm_load_ps(&a.x)), _mm_load_ps(&b.x), 1);
    return _mm512_insertf32x4(_mm512_insertf32x4(ab, _mm_load_ps(&c.x), 2), _mm_load_ps(&d.x), 3);
}

inline Vec4 load(const float4* a) {
    return transpose(rows(a[0], a[4], a[8], a[12]), rows(a[1], a[5], a[9], a[13]), rows(a[2], a[6], a[10], a[14]),
                     rows(a[3], a[7], a[11], a[15]));
}

inline Vec4 gather(const float4* a, const uint* k) {
    return transpose(rows(a[k[0]], a[k[4]], a[k[8]], a[k[12]]), rows(a[k[1]], a[k[5]], a[k[9]], a[k[13]]),
                     rows(a[k[2]], a[k[6]], a[k[10]], a[k[14]]), rows(a[k[3]], a[k[7]], a[k[11]], a[k[15]]));
}

inline Vec gather(const float* a, const uint* index) { return _mm512_i32gather_ps(_mm512_loadu_si512(index), a, 4); }

inline uint less_mask(Vec a, float b) { return _mm512_cmp_ps_mask(a, _mm512_set1_ps(b), _CMP_LT_OQ); }

inline Vec keep(uint mask, Vec a) { return _mm512_maskz_mov_ps(static_cast<__mmask16>(mask), a); }

inline uint compress_store(uint mask, const uint* words, uint* out) {
    // Through a register: the instruction that compresses into memory is slow on some processors.
    _mm512_storeu_si512(out, _mm512_maskz_compress_epi32(static_cast<__mmask16>(mask), _mm512_loadu_si512(words)));
    return static_cast<uint>(__builtin_popcount(mask));
}

inline void store_indices(uint first, uint* out) {
    const __m512i places = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    _mm512_storeu_si512(out, _mm512_add_epi32(_mm512_set1_epi32(static_cast<int>(first)), places));
}

}  // namespace fontana::wide_avx512
