#include "backends/cuda/cuda_stream.h"

#include "backends/cuda/cuda_error.h"
#include "backends/gpu/device_memory.h"
#include "util/error.h"

namespace fontana {

CudaStream::CudaStream(CudaDevice device, bool profile)
    : device_(std::move(device)), context_(std::make_shared<const CudaContext>(device_)) {
    const CurrentContext current(*context_);
    if (current.code() != CUDA_SUCCESS) fail_to_start_cuda(current.code(), device_.info.name, "cuCtxPushCurrent");
    CUstream stream = nullptr;
    const CUresult code = cuda().cuStreamCreate(&stream, CU_STREAM_NON_BLOCKING);
    if (code != CUDA_SUCCESS) fail_to_start_cuda(code, device_.info.name, "cuStreamCreate");
    stream_ = CudaStreamHandle(context_, stream);
    if (profile) profile_ = std::make_unique<LaunchProfile<LaunchTimer>>();
}

std::unique_ptr<Buffer> CudaStream::allocate(const std::string& name, std::size_t bytes) {
    require_alive();
    const CurrentContext current(*context_);
    check(current);
    if (bytes > device_.info.memory_bytes) fail_to_allocate(name, bytes);  // also what rounding up would wrap around
    const std::size_t room = allocation_size(bytes);
    CUdeviceptr address = 0;
    const CUresult code = cuda().cuMemAlloc(&address, room);
    if (code == CUDA_ERROR_OUT_OF_MEMORY) fail_to_allocate(name, room);
    check(code, "allocating", size_text(room) + " for " + name);
    auto buffer = std::make_unique<CudaBuffer>(name, bytes, CudaMemory(context_, address));
    check(cuda().cuMemsetD32Async(address, 0, room / 4, stream_.get()), "clearing", name);
    return buffer;
}

std::unique_ptr<Buffer> CudaStream::part(Buffer& whole, const std::string& name, std::size_t offset,
                                         std::size_t bytes) {
    require_alive();
    require_inside(whole, offset, bytes, "a part");
    return std::make_unique<CudaBuffer>(name, bytes, memory_of(whole) + offset);
}

// Both return when the host's memory is free again.
void CudaStream::write(Buffer& to, const void* from, std::size_t bytes, std::size_t offset) {
    require_alive();
    require_inside(to, offset, bytes, "a write");
    if (bytes == 0) return;
    const CurrentContext current(*context_);
    check(current);
    check(cuda().cuMemcpyHtoDAsync(memory_of(to) + offset, from, bytes, stream_.get()), "writing", to.name());
    synchronize("writing", to.name());
}

void CudaStream::read(const Buffer& from, void* to, std::size_t bytes, std::size_t offset) {
    require_alive();
    require_inside(from, offset, bytes, "a read");
    if (bytes == 0) return;
    const CurrentContext current(*context_);
    check(current);
    check(cuda().cuMemcpyDtoHAsync(to, memory_of(from) + offset, bytes, stream_.get()), "reading", from.name());
    synchronize("reading", from.name());
}

void CudaStream::copy(const Buffer& from, Buffer& to, std::size_t bytes) {
    require_alive();
    require_inside(from, 0, bytes, "a copy");
    require_inside(to, 0, bytes, "a copy");
    if (bytes == 0) return;
    const CurrentContext current(*context_);
    check(current);
    check(cuda().cuMemcpyDtoDAsync(memory_of(to), memory_of(from), bytes, stream_.get()), "copying", from.name());
}

void CudaStream::clear(Buffer& buffer, std::size_t bytes, const std::string& label) {
    require_alive();
    require_inside(buffer, 0, bytes, "a clear");
    if (bytes == 0) return;
    const CurrentContext current(*context_);
    check(current);
    timed(label, bytes / 4, [&] {
        check(cuda().cuMemsetD32Async(memory_of(buffer), 0, bytes / 4, stream_.get()), "clearing", buffer.name());
    });
}

void CudaStream::launch(CUfunction function, std::size_t thread_count, std::size_t group_size, void** arguments,
                        const std::string& label, std::uint64_t elements) {
    require_alive();
    if (thread_count == 0) return;
    const CurrentContext current(*context_);
    check(current);
    const auto group_count = static_cast<unsigned>((thread_count + group_size - 1) / group_size);
    timed(label, elements, [&] {
        check(cuda().cuLaunchKernel(function, group_count, 1, 1, static_cast<unsigned>(group_size), 1, 1, 0,
                                    stream_.get(), arguments, nullptr),
              "running the kernel", label);
    });
}

void CudaStream::finish() {
    require_alive();
    const CurrentContext current(*context_);
    check(current);
    synchronize("waiting for", "the stream");
}

std::vector<ProfileRow> CudaStream::profile() {
    if (!profile_) return {};
    require_alive();
    const CurrentContext current(*context_);
    check(current);
    collect_profile();
    return profile_->rows();
}

template <typename Enqueue>
void CudaStream::timed(const std::string& label, std::uint64_t elements, const Enqueue& enqueue) {
    if (!profile_) {
        enqueue();
        return;
    }
    LaunchTimer timer;
    timer.begin = record_event();
    enqueue();
    timer.end = record_event();
    profile_->add(label, elements, std::move(timer));
    if (profile_->is_full()) collect_profile();
}

CudaEvent CudaStream::record_event() {
    CUevent event = nullptr;
    check(cuda().cuEventCreate(&event, 0), "making", "an event");
    CudaEvent owner(context_, event);
    check(cuda().cuEventRecord(event, stream_.get()), "recording", "an event");
    return owner;
}

void CudaStream::collect_profile() {
    synchronize("waiting for", "the stream");
    const auto read_seconds = [](const LaunchTimer& timer, double& seconds) {
        float milliseconds = 0.0f;
        const CUresult code = cuda().cuEventElapsedTime(&milliseconds, timer.begin.get(), timer.end.get());
        seconds = 1e-3 * static_cast<double>(milliseconds);
        return code;
    };
    check(profile_->collect(read_seconds), "reading the time of", "a launch");
}

void CudaStream::synchronize(const char* doing, const std::string& name) {
    check(cuda().cuStreamSynchronize(stream_.get()), doing, name);
}

void CudaStream::check(CUresult code, const char* doing, const std::string& name) {
    if (code == CUDA_SUCCESS) return;
    const std::string where =
        "'" + device_.info.name + "' failed while " + doing + " " + name + ": " + cuda_error_name(code);
    if (code == CUDA_ERROR_OUT_OF_MEMORY) fail(FONTANA_OUT_OF_MEMORY, "out of memory: the CUDA device " + where);
    lost_ = "the CUDA device is lost: " + where + "; continue from the last checkpoint";
    fail(FONTANA_DEVICE_LOST, lost_);
}

void CudaStream::fail_to_allocate(const std::string& name, std::size_t bytes) const {
    std::size_t free = 0, total = 0;
    const bool is_known = cuda().cuMemGetInfo(&free, &total) == CUDA_SUCCESS;
    const std::string present =
        is_known ? size_text(free) + " free of " + size_text(total) : size_text(device_.info.memory_bytes) + " in all";
    fail(FONTANA_OUT_OF_MEMORY, "out of memory: the buffer " + name + " needs " + size_text(bytes) +
                                    ", and the CUDA device '" + device_.info.name + "' has " + present +
                                    ": fewer particles, or another device");
}

void CudaStream::require_alive() const {
    if (!lost_.empty()) fail(FONTANA_DEVICE_LOST, lost_);
}

}  // namespace fontana
