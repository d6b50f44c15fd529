// What the solver needs of a device: buffers, launches of named kernels, and one sort. Everything above this header is
// free of vendor words. A backend fills in a dozen virtual functions and a line in registry.cpp.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "kernels/step_constants.h"

namespace fontana {

enum class Kernel {
#define KERNEL_ENTRY(function, bytes, flops) function,
#include "kernels/kernel_list.def"
#undef KERNEL_ENTRY
    count
};

struct KernelFacts {
    const char* name;
    double bytes_per_particle, flops_per_particle;
};
const KernelFacts& kernel_facts(Kernel kernel);
// By the name of a launch; null for what is not in kernel_list.def, such as a backend's sort.
const KernelFacts* find_kernel_facts(const std::string& name);

struct DeviceInfo {
    std::string backend, name, driver;
    std::uint64_t memory_bytes = 0;
    std::uint32_t compute_units = 0;
    bool is_gpu = false;
    bool available = false;
    std::string reason;     // why it is not, and what to do about it
    std::string neighbors;  // the words of solver.neighbors that it has, "grid|all-pairs"
    // Particles in a row that share a list of neighbours (backends/cpu/wide_lists.h); 1: each has its own.
    std::uint32_t list_group = 1;
};

// Memory on a device. Made by Backend::allocate and used only with the backend that made it.
class Buffer {
 public:
    Buffer(std::string name, std::size_t bytes) : name_(std::move(name)), bytes_(bytes) {}
    virtual ~Buffer() = default;
    Buffer(const Buffer&) = delete;
    Buffer& operator=(const Buffer&) = delete;
    const std::string& name() const { return name_; }
    std::size_t bytes() const { return bytes_; }

 private:
    std::string name_;
    std::size_t bytes_;
};

// One argument of a launch: a buffer, or up to max_value_bytes by value.
class KernelArgument {
 public:
    static constexpr std::size_t max_value_bytes = 256;

    KernelArgument(const Buffer& buffer) : buffer_(const_cast<Buffer*>(&buffer)) {}
    template <typename T, typename = std::enable_if_t<std::is_trivially_copyable_v<T>>>
    KernelArgument(const T& value) : value_bytes_(sizeof(T)) {
        static_assert(sizeof(T) <= max_value_bytes);
        std::memcpy(value_, &value, sizeof(T));
    }

    Buffer* buffer() const { return buffer_; }  // null for a value
    const void* value() const { return value_; }
    std::size_t value_bytes() const { return value_bytes_; }

 private:
    Buffer* buffer_ = nullptr;
    std::size_t value_bytes_ = 0;
    alignas(16) unsigned char value_[max_value_bytes] = {};
};

using KernelArguments = std::initializer_list<KernelArgument>;

struct CpuKernel;

// A kernel that is not in kernel_list.def: a plugin's or an experiment's own, in the dialect of kernels/. It comes
// twice out of one file: as the loop of the cpu backend (backends/cpu/kernel_loop.h) and as text for devices, which
// cmake/EmbedKernels.cmake flattens. Both must outlive what is compiled from them.
struct KernelText {
    const char* name;  // of the function; profiles and errors show it
    const CpuKernel* loop;
    const char* const* pieces;
    std::size_t piece_count;
};

// A KernelText ready to launch, as Backend::launch does. Used only while the backend lives that compiled it.
class CompiledKernel {
 public:
    virtual ~CompiledKernel() = default;
    virtual void launch(std::size_t count, KernelArguments arguments) = 0;
};

// What a launch goes through, which is not its thread count where a thread takes several: the first argument of a
// kernel says it, as a count or in the step's constants. 0 where it is neither, as with the levels of kernels/coarse.h.
inline std::uint64_t element_count(KernelArguments arguments) {
    if (arguments.size() == 0) return 0;
    const KernelArgument& first = *arguments.begin();
    if (first.value_bytes() == sizeof(StepConstants))
        return static_cast<const StepConstants*>(first.value())->particle_count;
    std::uint32_t count = 0;
    if (first.value_bytes() == sizeof count) std::memcpy(&count, first.value(), sizeof count);
    return count;
}

struct ProfileRow {
    std::string name;
    std::uint64_t launches = 0;
    std::uint64_t elements = 0;  // particles, or values of a sort, summed over the launches
    double seconds = 0.0;
};

struct BackendOptions {
    bool strict = false;   // no contracted or reassociated arithmetic
    bool profile = false;  // time every launch
    bool tiles = false;    // cuda, opencl: candidates through local memory (backends/gpu/tiles.inl)
    int threads = 0;       // cpu: 0 is one per core
    int device = 0;        // index within the backend
};

// All calls may throw fontana::Error with OUT_OF_MEMORY, DEVICE_UNAVAILABLE or DEVICE_LOST; the sentence names the
// kernel or buffer. Launches run in order; they may return before the work is done, read() waits for it.
class Backend {
 public:
    virtual ~Backend() = default;

    virtual const DeviceInfo& device() const = 0;

    // Zero-filled. Never smaller than 16 bytes, so that an empty array is still a valid argument.
    virtual std::unique_ptr<Buffer> allocate(const std::string& name, std::size_t bytes) = 0;
    // A part of another buffer as one of its own, which has what that has. `offset`: a multiple of part_alignment. The
    // whole must outlive it.
    static constexpr std::size_t part_alignment = 4096;
    virtual std::unique_ptr<Buffer> part(Buffer& whole, const std::string& name, std::size_t offset,
                                         std::size_t bytes) = 0;
    virtual void write(Buffer& to, const void* from, std::size_t bytes, std::size_t offset = 0) = 0;
    virtual void read(const Buffer& from, void* to, std::size_t bytes, std::size_t offset = 0) = 0;
    virtual void copy(const Buffer& from, Buffer& to, std::size_t bytes) = 0;

    // Runs the kernel for thread indices 0 .. count-1 (a device may round up; kernels test their index).
    virtual void launch(Kernel kernel, std::size_t count, KernelArguments arguments) = 0;

    // Throws DEVICE_UNAVAILABLE with the compiler's first lines where the text does not compile.
    virtual std::unique_ptr<CompiledKernel> compile(const KernelText& text) = 0;

    // The order that sorts `key` (count values below key_count) stably: order[k] is the old index of the k-th, and
    // start[key] .. start[key + 1] its range; `start` has key_count + 1 entries. `scratch` has 16 bytes for each value,
    // and is the sort's to write to.
    virtual void sort(const Buffer& key, std::size_t count, std::size_t key_count, Buffer& order, Buffer& start,
                      Buffer& scratch) = 0;

    virtual void finish() = 0;
    virtual std::vector<ProfileRow> profile() const = 0;
};

// ---- registry ---------------------------------------------------------------------------------------------------

// Every device of every backend, and a line for each backend that has none, with the reason.
std::vector<DeviceInfo> list_devices();
// name: "auto", which is the first GPU that is available, else the CPU; "cpu", "cuda", "opencl".
std::unique_ptr<Backend> make_backend(const std::string& name, BackendOptions options);
// The device of that backend with options.device = 0, as list_devices has it.
DeviceInfo choose_device(const std::string& name);

}  // namespace fontana
