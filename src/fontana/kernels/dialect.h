// dialect.h: the only file that knows three languages. With it one text compiles as C++17, OpenCL C 1.2 and CUDA.
//
// The subset all kernels keep to: values in, values out for formulas (OpenCL C 1.2 has no generic address space);
// float literals with f; no references, templates, overloads, compound literals or static data; float4, never float3
// (its size differs); only 4-byte members in structs that travel as arguments.
#ifndef FONTANA_DIALECT_H
#define FONTANA_DIALECT_H

#if defined(__OPENCL_VERSION__)

#define FN static inline
#define KERNEL __kernel
#define GLOBAL __global
#define RESTRICT restrict
#define THREAD_ARG
#define THREAD_INDEX ((uint)get_global_id(0))
#ifdef FONTANA_STRICT
#pragma OPENCL FP_CONTRACT OFF
#endif
#define SQRT(a) sqrt(a)
#ifdef FONTANA_STRICT
#define INVERSE_SQRT(a) (1.0f / sqrt(a))
#else
#define INVERSE_SQRT(a) rsqrt(a)
#endif
#define FLOOR(a) floor(a)
#define LOCAL_POINTER __local
#define ATOMIC_MINIMUM(p, value) atomic_min((p), (value))
#define ATOMIC_MAXIMUM(p, value) atomic_max((p), (value))
#define ATOMIC_ADD(p, value) atomic_add((p), (value))
#define ATOMIC_INCREMENT(p) atomic_inc(p)
#define STORE_SAME(p, value) (*(p) = (value))
#define GROUP_KERNEL __kernel __attribute__((reqd_work_group_size(FONTANA_GROUP_SIZE, 1, 1)))
#define LOCAL __local
#define LANE_INDEX ((uint)get_local_id(0))
#define GROUP_INDEX ((uint)get_group_id(0))
#define BARRIER() barrier(CLK_LOCAL_MEM_FENCE)
#define MAKE_FLOAT4(x, y, z, w) ((float4)((x), (y), (z), (w)))

#elif defined(__CUDACC__)

#define FN static __device__ __forceinline__
#define KERNEL extern "C" __global__
#define GLOBAL
#define RESTRICT __restrict__
#define THREAD_ARG
#define THREAD_INDEX ((uint)(blockIdx.x * blockDim.x + threadIdx.x))
#define SQRT(a) sqrtf(a)
#ifdef FONTANA_STRICT
#define INVERSE_SQRT(a) (1.0f / sqrtf(a))
#else
#define INVERSE_SQRT(a) rsqrtf(a)
#endif
#define FLOOR(a) floorf(a)
#define LOCAL_POINTER
#define ATOMIC_MINIMUM(p, value) atomicMin((p), (value))
#define ATOMIC_MAXIMUM(p, value) atomicMax((p), (value))
#define ATOMIC_ADD(p, value) atomicAdd((p), (value))
#define ATOMIC_INCREMENT(p) atomicAdd((p), 1u)
#define STORE_SAME(p, value) (*(p) = (value))
// The 1, a group to a unit at the least, is what keeps NVIDIA's assembler from spilling registers to fit more of them.
#define GROUP_KERNEL extern "C" __global__ __launch_bounds__(FONTANA_GROUP_SIZE, 1)
#define LOCAL __shared__
#define LANE_INDEX ((uint)threadIdx.x)
#define GROUP_INDEX ((uint)blockIdx.x)
#define BARRIER() __syncthreads()
#define MAKE_FLOAT4(x, y, z, w) make_float4((x), (y), (z), (w))
typedef unsigned int uint;

#else  // C++: a kernel is an inline function of the thread's index; the cpu backend loops over it.

#include "backends/cpu/device_types.h"
// Always: a formula takes the constants by value, which must cost nothing.
#define FN static inline __attribute__((always_inline))
#define KERNEL static inline
#define GLOBAL
#define RESTRICT __restrict
#define THREAD_ARG const uint thread_index,
#define THREAD_INDEX thread_index
#define SQRT(a) __builtin_sqrtf(a)
#define INVERSE_SQRT(a) (1.0f / __builtin_sqrtf(a))
#define FLOOR(a) __builtin_floorf(a)
#define ATOMIC_ADD(p, value) __atomic_fetch_add((p), (value), __ATOMIC_RELAXED)
// Where several threads may store, all of them the same value.
#define STORE_SAME(p, value) __atomic_store_n((p), (value), __ATOMIC_RELAXED)
#define MAKE_FLOAT4(x, y, z, w) (float4{(x), (y), (z), (w)})
#define FONTANA_PACKED_LISTS  // as a processor has them (neighbor_list.h)

#endif

FN float min_f(float a, float b) { return a < b ? a : b; }
FN float max_f(float a, float b) { return a > b ? a : b; }

// What a pair of particles is computed in: one neighbour at a time, or, where a backend includes the pair formulas
// again with vectors of them (backends/cpu/wide_kernels.cpp), several at once.
#define REAL_FLOOR(a) FLOOR(a)
#define QUICK_INVERSE_SQRT(a) INVERSE_SQRT(a)
#define REAL float
#define REAL4 float4
#define REAL_ZERO 0.0f

#endif
