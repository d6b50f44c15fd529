// The structs of numbers that a simulation answers with.
#include "reports.h"

namespace fontana_python {

namespace {

void bind_derived(nb::module_& m) {
    nb::class_<fontana_derived>(m, "Derived")
        .def_ro("support_radius", &fontana_derived::support_radius)
        .def_ro("particle_mass", &fontana_derived::particle_mass)
        .def_ro("kinematic_viscosity", &fontana_derived::kinematic_viscosity)
        .def_ro("speed_of_sound", &fontana_derived::speed_of_sound)
        .def_ro("frame_duration", &fontana_derived::frame_duration)
        .def_ro("self_density", &fontana_derived::self_density)
        .def_ro("particle_radius", &fontana_derived::particle_radius);
}

void bind_time_step_limits(nb::module_& m) {
    nb::class_<fontana_time_step_limits>(m, "TimeStepLimits")
        .def_ro("advection", &fontana_time_step_limits::advection)
        .def_ro("acceleration", &fontana_time_step_limits::acceleration)
        .def_ro("acoustic", &fontana_time_step_limits::acoustic)
        .def_ro("viscosity", &fontana_time_step_limits::viscosity)
        .def_ro("surface_tension", &fontana_time_step_limits::surface_tension)
        .def_ro("convergence", &fontana_time_step_limits::convergence);
}

nb::tuple centre_of_mass(const FrameReport& report) {
    const double (&centre)[3] = report.numbers.centre_of_mass;
    return nb::make_tuple(centre[0], centre[1], centre[2]);
}

void bind_frame_report(nb::module_& m) {
    nb::class_<FrameReport>(m, "FrameReport")
        .def_prop_ro("frame", [](const FrameReport& r) { return r.numbers.frame; })
        .def_prop_ro("time", [](const FrameReport& r) { return r.numbers.time; })
        .def_prop_ro("particle_count", [](const FrameReport& r) { return r.numbers.particle_count; })
        .def_prop_ro("substeps", [](const FrameReport& r) { return r.numbers.substeps; })
        .def_prop_ro("iterations", [](const FrameReport& r) { return r.numbers.iterations; })
        .def_prop_ro("unconverged", [](const FrameReport& r) { return r.numbers.unconverged; })
        .def_prop_ro("dt_min", [](const FrameReport& r) { return r.numbers.dt_min; })
        .def_prop_ro("dt_max", [](const FrameReport& r) { return r.numbers.dt_max; })
        .def_ro("dt_limit", &FrameReport::limit)
        .def_prop_ro("density_error_mean", [](const FrameReport& r) { return r.numbers.density_error_mean; })
        .def_prop_ro("density_error_max", [](const FrameReport& r) { return r.numbers.density_error_max; })
        .def_prop_ro("max_speed", [](const FrameReport& r) { return r.numbers.max_speed; })
        .def_prop_ro("kinetic_energy", [](const FrameReport& r) { return r.numbers.kinetic_energy; })
        .def_prop_ro("centre_of_mass", &centre_of_mass)
        .def_prop_ro("seconds", [](const FrameReport& r) { return r.numbers.seconds; });
}

}  // namespace

void bind_reports(nb::module_& m) {
    bind_derived(m);
    bind_time_step_limits(m);
    bind_frame_report(m);
}

}  // namespace fontana_python
