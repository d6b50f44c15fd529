// The simulation's methods by their names in Python.
#include "simulation.h"

namespace fontana_python {

Simulation::Simulation() { check(fontana_create(&handle_)); }

Simulation::~Simulation() { fontana_destroy(handle_); }

namespace {

using SimulationClass = nb::class_<Simulation>;

void bind_scene(SimulationClass& simulation) {
    simulation.def("set", &Simulation::set, "name"_a, "value"_a)
        .def("get", &Simulation::get, "name"_a)
        .def("apply_preset", &Simulation::apply_preset, "preset"_a)
        .def("add_collider", &Simulation::add_collider, "type"_a, "fields"_a)
        .def("set_collider", &Simulation::set_collider, "index"_a, "type"_a, "fields"_a)
        .def("set_collider_keys", &Simulation::set_collider_keys, "index"_a, "times"_a, "centres"_a)
        .def("collider_centre", &Simulation::collider_centre, "index"_a, "time"_a)
        .def_prop_ro("collider_count", &Simulation::collider_count)
        .def("add_emitter", &Simulation::add_emitter, "type"_a, "fields"_a)
        .def("emitted_by", &Simulation::emitted_by, "frame"_a)
        .def("check", &Simulation::check_settings)
        .def("derived", &Simulation::derived)
        .def("estimate_limits", &Simulation::estimate_limits, "speed"_a, "acceleration"_a)
        .def("estimate_memory", &Simulation::estimate_memory, "particle_count"_a);
}

void bind_particles(SimulationClass& simulation) {
    simulation
        .def("add_particles", &Simulation::add_particles, "position"_a, "velocity"_a = nb::none(),
             "mass"_a = nb::none())
        .def("set_force", &Simulation::set_force, "force"_a.none())
        .def_prop_ro("particle_count", &Simulation::particle_count)
        .def("attributes", &Simulation::attributes)
        .def("read", &Simulation::read, "name"_a)
        .def("count_neighbors", &Simulation::count_neighbors);
}

void bind_run(SimulationClass& simulation) {
    simulation.def("step_frame", &Simulation::step_frame, "progress"_a = nb::none())
        .def_prop_ro("frame", &Simulation::frame)
        .def("device", &Simulation::device)
        .def("profile", &Simulation::profile)
        .def("measure_copy", &Simulation::measure_copy, "bytes"_a)
        .def("write_bgeo", &Simulation::write_bgeo, "path"_a)
        .def("save_checkpoint", &Simulation::save_checkpoint, "path"_a, "tag"_a = "")
        .def("load_checkpoint", &Simulation::load_checkpoint, "path"_a);
}

}  // namespace

void bind_simulation(nb::module_& m) {
    SimulationClass simulation(m, "Simulation");
    simulation.def(nb::init<>());
    bind_scene(simulation);
    bind_particles(simulation);
    bind_run(simulation);
}

}  // namespace fontana_python
