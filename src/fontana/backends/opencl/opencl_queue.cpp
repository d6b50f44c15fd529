#include "backends/opencl/opencl_queue.h"

#include "backends/gpu/device_memory.h"
#include "backends/opencl/opencl_error.h"
#include "util/error.h"

namespace fontana {
namespace {

// An error code, CL_SUCCESS for none.
cl_int read_seconds(const OpenClEvent& event, double& seconds) {
    cl_ulong begin = 0, end = 0;  // ns
    cl_int code =
        opencl().clGetEventProfilingInfo(event.get(), CL_PROFILING_COMMAND_START, sizeof begin, &begin, nullptr);
    if (code == CL_SUCCESS)
        code = opencl().clGetEventProfilingInfo(event.get(), CL_PROFILING_COMMAND_END, sizeof end, &end, nullptr);
    if (code == CL_SUCCESS) seconds = 1e-9 * static_cast<double>(end - begin);
    return code;
}

}  // namespace

CommandQueue::CommandQueue(OpenClDevice device, bool profile) : device_(std::move(device)) {
    cl_int code = CL_SUCCESS;
    context_.reset(opencl().clCreateContext(nullptr, 1, &device_.id, nullptr, nullptr, &code));
    if (code != CL_SUCCESS) fail_to_start(code, device_.info.name, "clCreateContext");
    const cl_command_queue_properties properties = profile ? CL_QUEUE_PROFILING_ENABLE : 0;
    queue_.reset(opencl().clCreateCommandQueue(context_.get(), device_.id, properties, &code));
    if (code != CL_SUCCESS) fail_to_start(code, device_.info.name, "clCreateCommandQueue");
    if (profile) profile_ = std::make_unique<LaunchProfile<OpenClEvent>>();
}

std::unique_ptr<Buffer> CommandQueue::allocate(const std::string& name, std::size_t bytes) {
    require_alive();
    if (bytes > device_.largest_allocation)
        fail(FONTANA_OUT_OF_MEMORY, "the buffer " + name + " needs " + size_text(bytes) + ", and '" +
                                        device_.info.name + "' allows " + size_text(device_.largest_allocation) +
                                        " in one piece: fewer particles, or another device");
    const std::size_t room = allocation_size(bytes);
    cl_int code = CL_SUCCESS;
    OpenClMemory memory(opencl().clCreateBuffer(context_.get(), CL_MEM_READ_WRITE, room, nullptr, &code));
    check(code, "allocating", size_text(room) + " for " + name);
    auto buffer = std::make_unique<OpenClBuffer>(name, bytes, std::move(memory));
    const cl_uint zero = 0;
    code =
        opencl().clEnqueueFillBuffer(queue_.get(), buffer->memory(), &zero, sizeof zero, 0, room, 0, nullptr, nullptr);
    check(code, "clearing", name);
    return buffer;
}

std::unique_ptr<Buffer> CommandQueue::part(Buffer& whole, const std::string& name, std::size_t offset,
                                           std::size_t bytes) {
    require_alive();
    require_inside(whole, offset, bytes, "a part");
    const cl_buffer_region region{offset, bytes};
    cl_int code = CL_SUCCESS;
    OpenClMemory memory(
        opencl().clCreateSubBuffer(memory_of(whole), CL_MEM_READ_WRITE, CL_BUFFER_CREATE_TYPE_REGION, &region, &code));
    check(code, "taking a part of", whole.name() + " for " + name);
    return std::make_unique<OpenClBuffer>(name, bytes, std::move(memory));
}

void CommandQueue::write(Buffer& to, const void* from, std::size_t bytes, std::size_t offset) {
    require_alive();
    require_inside(to, offset, bytes, "a write");
    if (bytes == 0) return;
    check(opencl().clEnqueueWriteBuffer(queue_.get(), memory_of(to), CL_TRUE, offset, bytes, from, 0, nullptr, nullptr),
          "writing", to.name());
}

void CommandQueue::read(const Buffer& from, void* to, std::size_t bytes, std::size_t offset) {
    require_alive();
    require_inside(from, offset, bytes, "a read");
    if (bytes == 0) return;
    check(opencl().clEnqueueReadBuffer(queue_.get(), memory_of(from), CL_TRUE, offset, bytes, to, 0, nullptr, nullptr),
          "reading", from.name());
}

void CommandQueue::copy(const Buffer& from, Buffer& to, std::size_t bytes) {
    require_alive();
    require_inside(from, 0, bytes, "a copy");
    require_inside(to, 0, bytes, "a copy");
    if (bytes == 0) return;
    check(opencl().clEnqueueCopyBuffer(queue_.get(), memory_of(from), memory_of(to), 0, 0, bytes, 0, nullptr, nullptr),
          "copying", from.name());
}

void CommandQueue::clear(Buffer& buffer, std::size_t bytes, const std::string& label) {
    require_alive();
    require_inside(buffer, 0, bytes, "a clear");
    if (bytes == 0) return;
    const cl_uint zero = 0;
    cl_event event = nullptr;
    check(opencl().clEnqueueFillBuffer(queue_.get(), memory_of(buffer), &zero, sizeof zero, 0, bytes, 0, nullptr,
                                       profile_ ? &event : nullptr),
          "clearing", buffer.name());
    note(event, label, bytes / sizeof zero);
}

void CommandQueue::launch(cl_kernel kernel, std::size_t thread_count, std::size_t group_size, const std::string& label,
                          std::uint64_t elements) {
    require_alive();
    if (thread_count == 0) return;
    const std::size_t global_size = round_up(thread_count, group_size);
    cl_event event = nullptr;
    check(opencl().clEnqueueNDRangeKernel(queue_.get(), kernel, 1, nullptr, &global_size, &group_size, 0, nullptr,
                                          profile_ ? &event : nullptr),
          "running the kernel", label);
    note(event, label, elements);
}

void CommandQueue::finish() {
    require_alive();
    check(opencl().clFinish(queue_.get()), "waiting for", "the queue");
}

std::vector<ProfileRow> CommandQueue::profile() {
    if (!profile_) return {};
    collect_profile();
    return profile_->rows();
}

void CommandQueue::note(cl_event event, const std::string& label, std::uint64_t elements) {
    if (!event) return;
    profile_->add(label, elements, OpenClEvent(event));
    if (profile_->is_full()) collect_profile();
}

void CommandQueue::collect_profile() {
    finish();
    check(profile_->collect(read_seconds), "reading the time of", "a launch");
}

void CommandQueue::check(cl_int code, const char* doing, const std::string& name) {
    if (code == CL_SUCCESS) return;
    const std::string where =
        "'" + device_.info.name + "' failed while " + doing + " " + name + ": " + opencl_error_name(code);
    if (is_out_of_memory(code)) fail(FONTANA_OUT_OF_MEMORY, "out of memory: the OpenCL device " + where);
    lost_ = "the OpenCL device is lost: " + where + "; continue from the last checkpoint";
    fail(FONTANA_DEVICE_LOST, lost_);
}

void CommandQueue::require_alive() const {
    if (!lost_.empty()) fail(FONTANA_DEVICE_LOST, lost_);
}

}  // namespace fontana
