// What one thread of a kernel sees on the stand-in device: translated kernels (translate.py) are written in terms of
// this header, and the stand-in driver runs them.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

namespace stand_in {

struct Thread;

// Where an instruction last reached into memory: almost always where it reaches next.
struct Site {
    std::uint64_t begin = 0, bytes = 0;
    std::uint64_t launch = 0;  // what is remembered is forgotten at the next launch
};

// `constant` is a load through the read-only cache (ld.global.nc), which may not see what the launch itself writes.
enum class Access { load, constant, store };

struct Launch {
    const char* kernel = nullptr;
    std::uint64_t number = 0;  // from 1
    unsigned block_size = 0, grid_size = 0;
    const unsigned char* parameters = nullptr;
    std::size_t parameter_bytes = 0, shared_bytes = 0;
    // Both throw where a device would stop with an error.
    void (*find)(const Thread& thread, Site& site, std::uint64_t address, std::size_t bytes, Access access) = nullptr;
    void (*barrier)(Thread& thread) = nullptr;
    void (*stop)(const Thread& thread, const char* what) = nullptr;
};

struct Thread {
    const Launch* launch = nullptr;
    unsigned lane = 0, block = 0;
    unsigned char* shared = nullptr;
};

struct Parameter {
    std::size_t offset, bytes;
};

// One kernel of a translated program; the table of them ends with a null name.
struct KernelCode {
    const char* name;
    void (*run)(Thread& thread);
    const Parameter* parameters;
    std::size_t parameter_count, parameter_bytes, shared_bytes;
    unsigned most_threads;  // in a block, 0 for no bound
    bool has_barriers;
};

// ---- registers: bits, which an instruction reads as its own type -----------------------------------------------

template <typename T, typename Bits>
inline T as(Bits bits) {
    static_assert(sizeof(T) == sizeof(Bits));
    T value;
    std::memcpy(&value, &bits, sizeof value);
    return value;
}

template <typename Bits>
inline void put(Bits& bits, float value) {
    static_assert(sizeof(Bits) == sizeof value);
    std::memcpy(&bits, &value, sizeof value);
}
template <typename Bits, typename T>
inline void put(Bits& bits, T value) {
    bits = static_cast<Bits>(value);
}

// ---- memory -----------------------------------------------------------------------------------------------------

inline void reach(const Thread& thread, Site& site, std::uint64_t address, std::size_t bytes, Access access) {
    if (site.launch == thread.launch->number && address - site.begin <= site.bytes - bytes && address % bytes == 0)
        return;
    thread.launch->find(thread, site, address, bytes, access);
}

// `bytes` is what the whole instruction moves: a vector must lie on a multiple of its own size.
inline const unsigned char* global(const Thread& thread, Site& site, std::uint64_t address, std::size_t bytes,
                                   Access access) {
    reach(thread, site, address, bytes, access);
    return reinterpret_cast<const unsigned char*>(address);
}

inline unsigned char* inside(const Thread& thread, unsigned char* memory, std::size_t size, std::uint64_t offset,
                             std::size_t bytes, const char* what) {
    if (offset > size || bytes > size - offset || offset % bytes != 0) thread.launch->stop(thread, what);
    return memory + offset;
}

inline unsigned char* shared(const Thread& thread, std::uint64_t offset, std::size_t bytes) {
    return inside(thread, thread.shared, thread.launch->shared_bytes, offset, bytes, "shared memory out of bounds");
}

inline const unsigned char* parameter(const Thread& thread, std::uint64_t offset, std::size_t bytes) {
    return inside(thread, const_cast<unsigned char*>(thread.launch->parameters), thread.launch->parameter_bytes, offset,
                  bytes, "parameters out of bounds");
}

template <typename T>
inline T load(const unsigned char* from, std::size_t index = 0) {
    T value;
    std::memcpy(&value, from + index * sizeof(T), sizeof value);
    return value;
}

template <typename T>
inline void store(const unsigned char* to, std::size_t index, T value) {
    std::memcpy(const_cast<unsigned char*>(to) + index * sizeof(T), &value, sizeof value);
}

// ---- arithmetic where C++ and PTX differ ("Parallel Thread Execution ISA", docs.nvidia.com/cuda) ------------------

// Of a number and a NaN the number; +0 is greater than -0.
inline float maximum(float a, float b) {
    if (std::isnan(a) || std::isnan(b)) return std::isnan(a) ? b : a;
    if (a == b) return std::signbit(a) ? b : a;
    return a > b ? a : b;
}
inline float minimum(float a, float b) {
    if (std::isnan(a) || std::isnan(b)) return std::isnan(a) ? b : a;
    if (a == b) return std::signbit(a) ? a : b;
    return a < b ? a : b;
}
template <typename T>
inline T maximum(T a, T b) {
    return a > b ? a : b;
}
template <typename T>
inline T minimum(T a, T b) {
    return a < b ? a : b;
}

// Towards zero; what does not fit becomes the nearest number that does, and a NaN zero.
template <typename T>
inline T truncated(float a) {
    if (std::isnan(a)) return 0;
    const double value = a;
    if (value <= static_cast<double>(std::numeric_limits<T>::min())) return std::numeric_limits<T>::min();
    if (value >= static_cast<double>(std::numeric_limits<T>::max())) return std::numeric_limits<T>::max();
    return static_cast<T>(value);
}

// A distance beyond the width moves everything out.
template <typename T>
inline T shifted_left(T a, std::uint32_t distance) {
    return distance >= 8 * sizeof(T) ? T{0} : static_cast<T>(a << distance);
}
template <typename T>
inline T shifted_right(T a, std::uint32_t distance) {
    if (distance >= 8 * sizeof(T)) return a < T{0} ? static_cast<T>(-1) : T{0};
    return static_cast<T>(a >> distance);
}

// What a GPU makes of a division by zero.
template <typename T>
inline T quotient(T a, T b) {
    return b == 0 ? static_cast<T>(-1) : static_cast<T>(a / b);
}
template <typename T>
inline T remainder(T a, T b) {
    return b == 0 ? a : static_cast<T>(a % b);
}

}  // namespace stand_in
