#include "swirl_device.h"

#include "backends/cpu/kernel_loop.h"
#include "swirl.h"

namespace fontana {
// The text of swirl.h for devices, embedded by fontana_own_kernel (CMakeLists.txt).
extern const char* const swirl_text[];
extern const std::size_t swirl_text_count;
}  // namespace fontana

namespace {

// The same kernel twice: as the loop of the cpu backend, and as text for the others.
constexpr fontana::CpuKernel swirl_loop = fontana::cpu_kernel<decltype(&swirl), &swirl>();
const fontana::KernelText swirl_kernel{"swirl", &swirl_loop, fontana::swirl_text, fontana::swirl_text_count};

}  // namespace

SwirlDevice::SwirlDevice(const std::string& backend)
    : backend_name_(backend),
      backend_(fontana::make_backend(backend, fontana::BackendOptions())),
      swirl_(backend_->compile(swirl_kernel)) {}

bool SwirlDevice::move(float* position, std::size_t point_count, const SwirlSettings& settings,
                       const IsInterrupted& is_interrupted) {
    if (point_count == 0) return true;
    const std::size_t bytes = 3 * point_count * sizeof(float);
    const auto step_count = static_cast<float>(settings.step_count);
    const SwirlConstants constants{settings.centre_x, settings.centre_z, settings.angle / step_count, settings.radius,
                                   static_cast<uint>(point_count)};
    fontana::Buffer& on_device = buffer_for(bytes);
    backend_->write(on_device, position, bytes);
    for (int step = 0; step < settings.step_count; ++step) {
        swirl_->launch(point_count, {constants, on_device});
        backend_->finish();  // a launch returns at once; without this, Esc would be asked about before the work is done
        if (is_interrupted(static_cast<double>(step + 1) / settings.step_count)) return false;
    }
    backend_->read(on_device, position, bytes);
    return true;
}

// Kept from cook to cook; a new one only where there are more points than ever before.
fontana::Buffer& SwirlDevice::buffer_for(std::size_t bytes) {
    if (!position_ || position_->bytes() < bytes) position_ = backend_->allocate("swirl position", bytes);
    return *position_;
}
