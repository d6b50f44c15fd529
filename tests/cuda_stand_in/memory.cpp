#include "memory.h"

#include <algorithm>
#include <cstdlib>
#include <iterator>

namespace stand_in {
namespace {

constexpr int k_illegal_address = 700, k_misaligned_address = 716, k_launch_failed = 719;
constexpr std::size_t k_alignment = 256;  // what a driver promises of an allocation
constexpr int k_pattern = 0xA5;

const char* name_of(Access access) { return access == Access::store ? "a store" : "a load"; }

std::string place_of(std::uint64_t address, std::uint64_t begin, std::size_t bytes) {
    return "byte " + std::to_string(static_cast<std::int64_t>(address - begin)) + " of an allocation of " +
           std::to_string(bytes);
}

}  // namespace

DeviceMemory::~DeviceMemory() {
    for (const auto& [address, allocation] : allocations_) std::free(reinterpret_cast<void*>(address));
}

std::uint64_t DeviceMemory::allocate(std::size_t bytes, std::size_t limit) {
    if (bytes > limit || used_bytes_ > limit - bytes) return 0;
    void* memory = std::aligned_alloc(k_alignment, (bytes + k_alignment - 1) / k_alignment * k_alignment);
    if (!memory) return 0;
    std::memset(memory, k_pattern, bytes);
    const auto address = reinterpret_cast<std::uint64_t>(memory);
    allocations_[address] = {bytes, std::vector<Part>(bytes / k_part + 1)};
    used_bytes_ += bytes;
    return address;
}

bool DeviceMemory::free(std::uint64_t address) {
    const auto found = allocations_.find(address);
    if (found == allocations_.end()) return false;
    used_bytes_ -= found->second.bytes;
    std::free(reinterpret_cast<void*>(address));
    allocations_.erase(found);
    return true;
}

DeviceMemory::Allocations::iterator DeviceMemory::around(std::uint64_t address) {
    const auto above = allocations_.upper_bound(address);
    return above == allocations_.begin() ? allocations_.end() : std::prev(above);
}

bool DeviceMemory::contains(std::uint64_t address, std::size_t bytes) const {
    const auto found = const_cast<DeviceMemory*>(this)->around(address);
    if (found == allocations_.end()) return false;
    const std::uint64_t offset = address - found->first;
    return offset <= found->second.bytes && bytes <= found->second.bytes - offset;
}

void DeviceMemory::find(std::uint64_t launch, Site& site, std::uint64_t address, std::size_t bytes, Access access) {
    const auto found = around(address);
    if (found == allocations_.end())
        throw DeviceFault(k_illegal_address, std::string(name_of(access)) + " where nothing is allocated");
    auto& [begin, allocation] = *found;
    const std::string where =
        name_of(access) + (" of " + std::to_string(bytes)) + " bytes at " + place_of(address, begin, allocation.bytes);
    if (!contains(address, bytes)) throw DeviceFault(k_illegal_address, where);
    if (address % bytes != 0) throw DeviceFault(k_misaligned_address, where + " is not on a multiple of its size");
    const std::size_t number = (address - begin) / k_part;
    Part& part = allocation.parts[number];
    if (access == Access::constant) part.constant_in = launch;
    if (access == Access::store) part.stored_in = launch;
    if (part.constant_in == launch && part.stored_in == launch)
        throw DeviceFault(k_launch_failed, where + ", which the same launch both stores into and reads as constant");
    site.begin = begin + number * k_part;
    site.bytes = std::min(k_part, allocation.bytes - number * k_part);
    site.launch = launch;
}

}  // namespace stand_in
