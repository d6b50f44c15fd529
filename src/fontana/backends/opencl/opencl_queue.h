// One context and one in-order queue on one device, with every call checked: an OpenCL error leaves here as a sentence.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "backends/backend.h"
#include "backends/gpu/launch_profile.h"
#include "backends/opencl/opencl_api.h"
#include "backends/opencl/opencl_devices.h"

namespace fontana {

class OpenClBuffer : public Buffer {
 public:
    OpenClBuffer(const std::string& name, std::size_t bytes, OpenClMemory memory)
        : Buffer(name, bytes), memory_(std::move(memory)) {}
    cl_mem memory() const { return memory_.get(); }

 private:
    OpenClMemory memory_;
};

// The memory of a buffer that this backend made.
inline cl_mem memory_of(const Buffer& buffer) { return static_cast<const OpenClBuffer&>(buffer).memory(); }

// After a failure that is not a lack of memory the device is taken for lost: what it holds cannot be trusted, and every
// later call throws the same error.
class CommandQueue {
 public:
    CommandQueue(OpenClDevice device, bool profile);

    const OpenClDevice& device() const { return device_; }
    cl_context context() const { return context_.get(); }

    std::unique_ptr<Buffer> allocate(const std::string& name, std::size_t bytes);
    std::unique_ptr<Buffer> part(Buffer& whole, const std::string& name, std::size_t offset, std::size_t bytes);
    void write(Buffer& to, const void* from, std::size_t bytes, std::size_t offset);
    void read(const Buffer& from, void* to, std::size_t bytes, std::size_t offset);
    void copy(const Buffer& from, Buffer& to, std::size_t bytes);
    void clear(Buffer& buffer, std::size_t bytes, const std::string& label);
    // Runs a kernel whose arguments are set. `label` is its name in the profile and in errors, `elements` what it goes
    // through (ProfileRow).
    void launch(cl_kernel kernel, std::size_t thread_count, std::size_t group_size, const std::string& label,
                std::uint64_t elements);
    void finish();
    std::vector<ProfileRow> profile();

    // Throws unless `code` is success: "... while <doing> <name>".
    void check(cl_int code, const char* doing, const std::string& name);
    // Throws what was thrown when the device was lost, if it was.
    void require_alive() const;

 private:
    void note(cl_event event, const std::string& label, std::uint64_t elements);
    void collect_profile();

    OpenClDevice device_;
    OpenClContext context_;
    OpenClQueue queue_;
    std::unique_ptr<LaunchProfile<OpenClEvent>> profile_;  // null: no profile wanted
    std::string lost_;                                     // what was said when the device was lost
};

}  // namespace fontana
