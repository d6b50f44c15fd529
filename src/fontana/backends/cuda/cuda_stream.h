// One context and one stream on one device, with every call checked: a CUDA error leaves here as a sentence.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "backends/backend.h"
#include "backends/cuda/cuda_context.h"
#include "backends/cuda/cuda_devices.h"
#include "backends/gpu/launch_profile.h"

namespace fontana {

class CudaBuffer : public Buffer {
 public:
    CudaBuffer(const std::string& name, std::size_t bytes, CudaMemory memory)
        : Buffer(name, bytes), address_(memory.get()), memory_(std::move(memory)) {}
    // A part of another.
    CudaBuffer(const std::string& name, std::size_t bytes, CUdeviceptr address)
        : Buffer(name, bytes), address_(address) {}
    CUdeviceptr memory() const { return address_; }

 private:
    CUdeviceptr address_;
    CudaMemory memory_;
};

// The memory of a buffer that this backend made.
inline CUdeviceptr memory_of(const Buffer& buffer) { return static_cast<const CudaBuffer&>(buffer).memory(); }

// After a failure that is not a lack of memory the device is taken for lost: what it holds cannot be trusted, and every
// later call throws the same error. A kernel's own fault shows at the next call that waits for it.
class CudaStream {
 public:
    CudaStream(CudaDevice device, bool profile);

    const CudaDevice& device() const { return device_; }
    const std::shared_ptr<const CudaContext>& context() const { return context_; }

    std::unique_ptr<Buffer> allocate(const std::string& name, std::size_t bytes);
    std::unique_ptr<Buffer> part(Buffer& whole, const std::string& name, std::size_t offset, std::size_t bytes);
    void write(Buffer& to, const void* from, std::size_t bytes, std::size_t offset);
    void read(const Buffer& from, void* to, std::size_t bytes, std::size_t offset);
    void copy(const Buffer& from, Buffer& to, std::size_t bytes);
    void clear(Buffer& buffer, std::size_t bytes, const std::string& label);
    // `arguments` holds the address of each argument and a null at its end. `label` is the kernel's name in the profile
    // and in errors, `elements` what it goes through (ProfileRow).
    void launch(CUfunction function, std::size_t thread_count, std::size_t group_size, void** arguments,
                const std::string& label, std::uint64_t elements);
    void finish();
    std::vector<ProfileRow> profile();

    // Throws what was thrown when the device was lost, if it was.
    void require_alive() const;

 private:
    struct LaunchTimer {
        CudaEvent begin, end;
    };

    // Throws unless `code` is success: "... while <doing> <name>".
    void check(CUresult code, const char* doing, const std::string& name);
    void check(const CurrentContext& current) { check(current.code(), "using", "its context"); }
    void synchronize(const char* doing, const std::string& name);
    // Does `enqueue`, which returns a code, between two events where a profile is wanted.
    template <typename Enqueue>
    void timed(const std::string& label, std::uint64_t elements, const Enqueue& enqueue);
    CudaEvent record_event();
    void collect_profile();
    [[noreturn]] void fail_to_allocate(const std::string& name, std::size_t bytes) const;

    CudaDevice device_;
    std::shared_ptr<const CudaContext> context_;
    CudaStreamHandle stream_;
    std::unique_ptr<LaunchProfile<LaunchTimer>> profile_;  // null: no profile wanted
    std::string lost_;                                     // what was said when the device was lost
};

}  // namespace fontana
