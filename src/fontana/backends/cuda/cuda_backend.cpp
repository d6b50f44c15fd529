#include "backends/cuda/cuda_backend.h"

#include "backends/cuda/cuda_devices.h"
#include "backends/cuda/cuda_kernel.h"
#include "backends/cuda/cuda_program.h"
#include "backends/cuda/cuda_stream.h"
#include "backends/gpu/device_sort.h"
#include "backends/gpu/tiles.h"
#include "util/error.h"

namespace fontana {
namespace {

class CompiledFromText : public CompiledKernel {
 public:
    CompiledFromText(CudaStream& stream, CudaModule program, const char* name)
        : stream_(stream), program_(std::move(program)), kernel_(stream, program_.get(), name, name) {}

    void launch(std::size_t count, KernelArguments arguments) override { kernel_.launch(stream_, count, arguments); }

 private:
    CudaStream& stream_;
    CudaModule program_;
    CudaKernel kernel_;
};

class CudaBackend : public Backend {
 public:
    CudaBackend(CudaDevice device, const BackendOptions& options)
        : stream_(std::move(device), options.profile),
          strict_(options.strict),
          program_(build_cuda_program(stream_, core_text(), options.strict)),
          sort_(stream_.device().group_size, [this](const char* function, const char* label) {
              return CudaKernel(stream_, program_.get(), function, label);
          }) {
        for (int i = 0; i < static_cast<int>(Kernel::count); ++i) {
            const char* name = kernel_facts(static_cast<Kernel>(i)).name;
            kernels_.emplace_back(stream_, program_.get(), function_of(name, options.tiles), name);
        }
    }

    const DeviceInfo& device() const override { return stream_.device().info; }

    std::unique_ptr<Buffer> allocate(const std::string& name, std::size_t bytes) override {
        return stream_.allocate(name, bytes);
    }
    std::unique_ptr<Buffer> part(Buffer& whole, const std::string& name, std::size_t offset,
                                 std::size_t bytes) override {
        return stream_.part(whole, name, offset, bytes);
    }
    void write(Buffer& to, const void* from, std::size_t bytes, std::size_t offset) override {
        stream_.write(to, from, bytes, offset);
    }
    void read(const Buffer& from, void* to, std::size_t bytes, std::size_t offset) override {
        stream_.read(from, to, bytes, offset);
    }
    void copy(const Buffer& from, Buffer& to, std::size_t bytes) override { stream_.copy(from, to, bytes); }

    void launch(Kernel kernel, std::size_t count, KernelArguments arguments) override {
        kernels_[static_cast<std::size_t>(kernel)].launch(stream_, count, arguments);
    }
    std::unique_ptr<CompiledKernel> compile(const KernelText& text) override {
        CudaModule program = build_cuda_program(stream_, {text.pieces, text.piece_count}, strict_);
        return std::make_unique<CompiledFromText>(stream_, std::move(program), text.name);
    }
    void sort(const Buffer& key, std::size_t count, std::size_t key_count, Buffer& order, Buffer& start,
              Buffer& scratch) override {
        sort_.sort(stream_, key, count, key_count, order, start, scratch);
    }

    void finish() override { stream_.finish(); }
    std::vector<ProfileRow> profile() const override { return stream_.profile(); }

 private:
    mutable CudaStream stream_;  // collecting a profile waits for the stream, and may find the device lost
    const bool strict_;
    CudaModule program_;
    DeviceSort<CudaStream, CudaKernel> sort_;
    std::vector<CudaKernel> kernels_;  // by Kernel
};

}  // namespace

std::unique_ptr<Backend> make_cuda_backend(const BackendOptions& options) {
    std::vector<CudaDevice> devices = find_cuda_devices();
    const auto index = static_cast<std::size_t>(options.device);
    if (index >= devices.size())
        fail(FONTANA_DEVICE_UNAVAILABLE, "there is no CUDA device " + std::to_string(options.device) + ": expected 0" +
                                             (devices.size() > 1 ? " to " + std::to_string(devices.size() - 1) : ""));
    CudaDevice& device = devices[index];
    if (!device.info.available && device.id < 0)
        fail(FONTANA_DEVICE_UNAVAILABLE, "no CUDA device: " + device.info.reason);
    if (!device.info.available)
        fail(FONTANA_DEVICE_UNAVAILABLE,
             "the CUDA device '" + device.info.name + "' cannot be used: " + device.info.reason);
    return std::make_unique<CudaBackend>(std::move(device), options);
}

}  // namespace fontana
