#include "backends/opencl/opencl_backend.h"

#include "backends/gpu/device_sort.h"
#include "backends/gpu/tiles.h"
#include "backends/opencl/opencl_devices.h"
#include "backends/opencl/opencl_kernel.h"
#include "backends/opencl/opencl_program.h"
#include "backends/opencl/opencl_queue.h"
#include "util/error.h"

namespace fontana {
namespace {

class CompiledFromText : public CompiledKernel {
 public:
    CompiledFromText(CommandQueue& queue, OpenClProgram program, const char* name)
        : queue_(queue), program_(std::move(program)), kernel_(queue.device(), program_.get(), name, name) {}

    void launch(std::size_t count, KernelArguments arguments) override { kernel_.launch(queue_, count, arguments); }

 private:
    CommandQueue& queue_;
    OpenClProgram program_;
    DeviceKernel kernel_;
};

class OpenClBackend : public Backend {
 public:
    OpenClBackend(OpenClDevice device, const BackendOptions& options)
        : queue_(std::move(device), options.profile),
          strict_(options.strict),
          program_(build_opencl_program(queue_.context(), queue_.device(), core_text(), options.strict)),
          sort_(queue_.device().group_size, [this](const char* function, const char* label) {
              return DeviceKernel(queue_.device(), program_.get(), function, label);
          }) {
        for (int i = 0; i < static_cast<int>(Kernel::count); ++i) {
            const char* name = kernel_facts(static_cast<Kernel>(i)).name;
            kernels_.emplace_back(queue_.device(), program_.get(), function_of(name, options.tiles), name);
        }
    }

    const DeviceInfo& device() const override { return queue_.device().info; }

    std::unique_ptr<Buffer> allocate(const std::string& name, std::size_t bytes) override {
        return queue_.allocate(name, bytes);
    }
    std::unique_ptr<Buffer> part(Buffer& whole, const std::string& name, std::size_t offset,
                                 std::size_t bytes) override {
        return queue_.part(whole, name, offset, bytes);
    }
    void write(Buffer& to, const void* from, std::size_t bytes, std::size_t offset) override {
        queue_.write(to, from, bytes, offset);
    }
    void read(const Buffer& from, void* to, std::size_t bytes, std::size_t offset) override {
        queue_.read(from, to, bytes, offset);
    }
    void copy(const Buffer& from, Buffer& to, std::size_t bytes) override { queue_.copy(from, to, bytes); }

    void launch(Kernel kernel, std::size_t count, KernelArguments arguments) override {
        kernels_[static_cast<std::size_t>(kernel)].launch(queue_, count, arguments);
    }
    std::unique_ptr<CompiledKernel> compile(const KernelText& text) override {
        OpenClProgram program =
            build_opencl_program(queue_.context(), queue_.device(), {text.pieces, text.piece_count}, strict_);
        return std::make_unique<CompiledFromText>(queue_, std::move(program), text.name);
    }
    void sort(const Buffer& key, std::size_t count, std::size_t key_count, Buffer& order, Buffer& start,
              Buffer& scratch) override {
        sort_.sort(queue_, key, count, key_count, order, start, scratch);
    }

    void finish() override { queue_.finish(); }
    std::vector<ProfileRow> profile() const override { return queue_.profile(); }

 private:
    mutable CommandQueue queue_;  // collecting a profile waits for the queue, and may find the device lost
    const bool strict_;
    OpenClProgram program_;
    DeviceSort<CommandQueue, DeviceKernel> sort_;
    std::vector<DeviceKernel> kernels_;  // by Kernel
};

}  // namespace

std::unique_ptr<Backend> make_opencl_backend(const BackendOptions& options) {
    std::vector<OpenClDevice> devices = find_opencl_devices();
    const auto index = static_cast<std::size_t>(options.device);
    if (index >= devices.size())
        fail(FONTANA_DEVICE_UNAVAILABLE, "there is no OpenCL device " + std::to_string(options.device) +
                                             ": expected 0" +
                                             (devices.size() > 1 ? " to " + std::to_string(devices.size() - 1) : ""));
    OpenClDevice& device = devices[index];
    if (!device.info.available && !device.id)
        fail(FONTANA_DEVICE_UNAVAILABLE, "no OpenCL device: " + device.info.reason);
    if (!device.info.available)
        fail(FONTANA_DEVICE_UNAVAILABLE,
             "the OpenCL device '" + device.info.name + "' cannot be used: " + device.info.reason);
    return std::make_unique<OpenClBackend>(std::move(device), options);
}

}  // namespace fontana
