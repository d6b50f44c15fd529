// A single particle that is no number shows in what is measured of all, wherever it is among them: on the cpu backend,
// in strict arithmetic and with every instruction set that the processor has.
#include "solver/diagnostics.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <memory>
#include <vector>

#include "check.h"
#include "util/error.h"

namespace {

constexpr std::size_t k_count = 1003;  // several particles to a lane, and a last row that is not full
constexpr float k_nan = std::numeric_limits<float>::quiet_NaN();

StepConstants make_constants() {
    StepConstants c{};
    c.rest_density = 1000.0f;
    c.inverse_rest_density = 1.0f / c.rest_density;
    return c;
}

class Fluid {
 public:
    explicit Fluid(bool strict) : backend_(make(strict)), particles_(*backend_) {
        const auto source = [](std::size_t k, float4& x, float4& v) {
            x = {static_cast<float>(k), 0.0f, 0.0f, 1.0f};
            v = {k == 500 ? 3.0f : 2.0f, 0.0f, 0.0f, 0.0f};
        };
        particles_.append(k_count, source, 1010.0f);
    }

    void spoil_velocity(std::size_t k) { write(particles_.velocity(), k, float4{0.0f, k_nan, 0.0f, 0.0f}); }
    void spoil_acceleration(std::size_t k) { write(particles_.acceleration(), k, float4{0.0f, 0.0f, k_nan, 0.0f}); }
    void spoil_density(std::size_t k) { write(particles_.density(), k, k_nan); }

    fontana::StepExtremes step() {
        const auto extremes = backend_->allocate("extremes", fontana::k_most_lanes * 16);
        return measure_step(*backend_, particles_, make_constants(), *extremes);
    }
    fontana::Diagnostics all() { return measure(*backend_, particles_, make_constants()); }

 private:
    static std::unique_ptr<fontana::Backend> make(bool strict) {
        fontana::BackendOptions options;
        options.strict = strict;
        options.threads = 2;
        return fontana::make_backend("cpu", options);
    }

    template <typename T>
    void write(fontana::Buffer& to, std::size_t k, const T& value) {
        backend_->write(to, &value, sizeof value, k * sizeof value);
    }

    std::unique_ptr<fontana::Backend> backend_;
    fontana::Particles particles_;
};

void numbers_are_measured(bool strict) {
    Fluid fluid(strict);
    const fontana::StepExtremes step = fluid.step();
    CHECK(step.speed == 3.0 && step.acceleration == 0.0);
    CHECK(std::fabs(step.density_error_max - 0.01) < 1e-6 && std::fabs(step.density_error_mean - 0.01) < 1e-6);
    const fontana::Diagnostics all = fluid.all();
    CHECK(all.is_finite() && all.max_speed == 3.0 && all.mass == k_count);
}

void one_that_is_none_shows(bool strict, std::size_t k) {
    Fluid fast(strict), accelerated(strict), dense(strict);
    fast.spoil_velocity(k);
    CHECK(std::isnan(fast.step().speed));
    CHECK(std::isnan(fast.all().max_speed) && !fast.all().is_finite());
    accelerated.spoil_acceleration(k);
    CHECK(std::isnan(accelerated.step().acceleration) && accelerated.step().speed == 3.0);
    dense.spoil_density(k);
    CHECK(std::isnan(dense.step().density_error_max) && std::isnan(dense.step().density_error_mean));
    CHECK(std::isnan(dense.all().density_error_max) && !dense.all().is_finite());
}

void check(bool strict) {
    numbers_are_measured(strict);
    // The first and the last of a lane, of the first row and of the last one, beside the fastest.
    for (const std::size_t k : {std::size_t{0}, std::size_t{249}, std::size_t{250}, std::size_t{499}, k_count - 1})
        one_that_is_none_shows(strict, k);
}

}  // namespace

int main() {
    try {
        check(true);
        for (const char* instructions : {"baseline", "avx2", "best"}) {
            setenv("FONTANA_CPU_INSTRUCTIONS", instructions, 1);
            check(false);
        }
    } catch (const fontana::Error& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return EXIT_FAILURE;
    }
    if (failed_checks) return EXIT_FAILURE;
    std::puts("what is no number shows");
    return EXIT_SUCCESS;
}
