// The memory of the stand-in device: real memory of the host, whose every use by a kernel is held against what is
// allocated.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "device.h"

namespace stand_in {

// What stops a kernel, with the driver's error code for it.
class DeviceFault : public std::runtime_error {
 public:
    DeviceFault(int code, const std::string& sentence) : std::runtime_error(sentence), code_(code) {}
    int code() const { return code_; }

 private:
    int code_;
};

class DeviceMemory {
 public:
    ~DeviceMemory();

    // Filled with a pattern that no one should take for data. 0 where `bytes` do not fit below `limit` in all.
    std::uint64_t allocate(std::size_t bytes, std::size_t limit);
    bool free(std::uint64_t address);
    bool contains(std::uint64_t address, std::size_t bytes) const;
    std::size_t used_bytes() const { return used_bytes_; }

    // Throws a DeviceFault for an access beyond any allocation or across its multiple, and for a store into a part of
    // one that the launch also reads as constant: a GPU may read what was there before.
    void find(std::uint64_t launch, Site& site, std::uint64_t address, std::size_t bytes, Access access);

 private:
    // What a program may take for a buffer of its own (Backend::part_alignment).
    static constexpr std::size_t k_part = 4096;
    struct Part {
        std::uint64_t constant_in = 0, stored_in = 0;  // the latest launch that read it so, and stored into it
    };
    struct Allocation {
        std::size_t bytes = 0;
        std::vector<Part> parts;
    };
    using Allocations = std::map<std::uint64_t, Allocation>;

    Allocations::iterator around(std::uint64_t address);

    Allocations allocations_;
    std::size_t used_bytes_ = 0;
};

}  // namespace stand_in
