// A kernel from outside the core, through Backend::compile: results against the formula in double, and what is refused.
//
//   own_kernel_test cpu opencl
//
// Prints a line for each failure; the exit status is 0 if all holds. A backend that is named must be there.
#include "own_kernel.h"

#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "backends/backend.h"
#include "backends/cpu/kernel_loop.h"
#include "util/error.h"

namespace fontana {
extern const char* const own_kernel_text[];
extern const std::size_t own_kernel_text_count;
}  // namespace fontana

namespace {

int failures = 0;

void expect(bool holds, const std::string& what) {
    if (holds) return;
    ++failures;
    std::printf("fails: %s\n", what.c_str());
}

void expect_error(fontana::Status status, const std::string& part, const std::function<void()>& action) {
    try {
        action();
        expect(false, "no error: " + part);
    } catch (const fontana::Error& error) {
        const std::string sentence = error.what();
        expect(error.status() == status && sentence.find(part) != std::string::npos, part + ", got: " + sentence);
    }
}

constexpr fontana::CpuKernel loop = fontana::cpu_kernel<decltype(&weigh), &weigh>();
const fontana::KernelText text{"weigh", &loop, fontana::own_kernel_text, fontana::own_kernel_text_count};

constexpr std::size_t k_count = 1003;  // no multiple of a work group

std::vector<float4> make_positions() {
    std::vector<float4> position(k_count);
    for (std::size_t i = 0; i < k_count; ++i) position[i] = {0.001f * static_cast<float>(i), 0.25f, -0.125f, 7.0f};
    return position;
}

double expected_weight(const float4& x, double support_radius, double scale) {
    const double left = support_radius * support_radius - (double{x.x} * x.x + double{x.y} * x.y + double{x.z} * x.z);
    return left > 0.0 ? scale * left * left * left : 0.0;
}

void check_results(fontana::Backend& backend) {
    const std::vector<float4> position = make_positions();
    const auto positions = backend.allocate("position", k_count * sizeof(float4));
    const auto weights = backend.allocate("weight", k_count * sizeof(float));
    backend.write(*positions, position.data(), k_count * sizeof(float4));
    const WeighConstants constants{0.75f, 3.0f, static_cast<uint>(k_count)};
    const auto weigh_on_device = backend.compile(text);
    weigh_on_device->launch(k_count, {constants, *positions, *weights});
    std::vector<float> weight(k_count);
    backend.read(*weights, weight.data(), k_count * sizeof(float));

    double largest_difference = 0.0;
    for (std::size_t i = 0; i < k_count; ++i)
        largest_difference = std::fmax(
            largest_difference, std::fabs(expected_weight(position[i], 0.75, 3.0) - static_cast<double>(weight[i])));
    expect(weight.front() > 0.1f && weight.back() == 0.0f, "some are within the support and some are not");
    expect(largest_difference < 1e-6, "the weights are those of the formula");
    const auto rows = backend.profile();
    expect(rows.size() == 1 && rows[0].name == "weigh" && rows[0].launches == 1, "the profile names the kernel");
}

void check_refusals(fontana::Backend& backend) {
    const auto words = backend.allocate("words", 64);
    const auto weigh_on_device = backend.compile(text);
    expect_error(FONTANA_INTERNAL, "weigh", [&] { weigh_on_device->launch(1, {*words, *words}); });
}

// The cpu backend knows a kernel's signature; not every OpenCL driver tells the size of a struct.
void check_sizes(fontana::Backend& backend) {
    const auto words = backend.allocate("words", 64);
    expect_error(FONTANA_INTERNAL, "argument 0 has the wrong kind or size",
                 [&] { backend.compile(text)->launch(1, {1.0, *words, *words}); });
}

// Only where text is compiled: the loop of the cpu backend is compiled with the program.
void check_broken_text(fontana::Backend& backend) {
    const char* const pieces[] = {"__kernel void weigh(__global float* out) { out[0] = ", "no_such_name; }"};
    const fontana::KernelText broken{"weigh", &loop, pieces, 2};
    expect_error(FONTANA_DEVICE_UNAVAILABLE, "no_such_name", [&] { backend.compile(broken); });
    const fontana::KernelText renamed{"other_name", &loop, text.pieces, text.piece_count};
    expect_error(FONTANA_DEVICE_UNAVAILABLE, "other_name", [&] { backend.compile(renamed); });
}

void check_backend(const std::string& name) {
    fontana::BackendOptions options;
    options.profile = true;
    const std::unique_ptr<fontana::Backend> backend = fontana::make_backend(name, options);
    check_results(*backend);
    check_refusals(*backend);
    if (name == "cpu")
        check_sizes(*backend);
    else
        check_broken_text(*backend);
}

}  // namespace

int main(int argument_count, char** arguments) {
    try {
        for (int k = 1; k < argument_count; ++k) check_backend(arguments[k]);
    } catch (const fontana::Error& error) {
        std::printf("error: %s\n", error.what());
        return 2;
    }
    expect(argument_count > 1, "name a backend");
    return failures == 0 ? 0 : 1;
}
