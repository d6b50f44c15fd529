// A simulation's frames, the device they run on, and the files they go to.
#include <utility>

#include "simulation.h"

namespace fontana_python {

namespace {

// What the library calls between substeps. An exception cannot pass through C: it stays set in Python, and the step
// ends.
struct Progress {
    std::optional<ProgressFunction> function;
    bool failed = false;

    bool wants_stop(double fraction) {
        nb::gil_scoped_acquire acquire;
        try {
            const bool stop = function && is_true((*function)(fraction));
            if (PyErr_CheckSignals() == 0) return stop;
        } catch (nb::python_error& error) {
            error.restore();
        }
        failed = true;
        return true;
    }

    // As Python's `if` would see it: a callback that returns nothing goes on.
    static bool is_true(const nb::object& value) {
        const int truth = PyObject_IsTrue(value.ptr());
        if (truth < 0) throw nb::python_error();
        return truth == 1;
    }

    static int call(void* progress, double fraction) {
        return static_cast<Progress*>(progress)->wants_stop(fraction) ? 1 : 0;
    }
};

}  // namespace

FrameReport Simulation::step_frame(std::optional<ProgressFunction> function) {
    FrameReport report;
    Progress progress{std::move(function)};
    check(fontana_set_progress(handle_, &Progress::call, &progress));
    fontana_status status;
    {
        nb::gil_scoped_release release;
        status = fontana_step_frame(handle_, &report.numbers);
    }
    fontana_set_progress(handle_, nullptr, nullptr);
    if (progress.failed) throw nb::python_error();
    check(status);
    report.limit = report.numbers.dt_limit;
    return report;
}

std::int64_t Simulation::frame() const { return fontana_frame(handle_); }

Device Simulation::device() {
    fontana_device device;
    check(fontana_device_in_use(handle_, &device));
    return Device(device);
}

std::vector<KernelProfile> Simulation::profile() {
    const fontana_kernel_profile* rows = nullptr;
    std::size_t count = 0;
    check(fontana_read_profile(handle_, &rows, &count));
    return {rows, rows + count};
}

double Simulation::measure_copy(std::size_t bytes) {
    double bytes_per_second = 0.0;
    fontana_status status;
    {
        nb::gil_scoped_release release;
        status = fontana_measure_copy(handle_, bytes, &bytes_per_second);
    }
    check(status);
    return bytes_per_second;
}

void Simulation::write_bgeo(const FilePath& path) { check(fontana_write_bgeo(handle_, path.c_str())); }

void Simulation::save_checkpoint(const FilePath& path, const std::string& tag) {
    check(fontana_save_checkpoint(handle_, path.c_str(), tag.c_str()));
}

void Simulation::load_checkpoint(const FilePath& path) { check(fontana_load_checkpoint(handle_, path.c_str())); }

}  // namespace fontana_python
