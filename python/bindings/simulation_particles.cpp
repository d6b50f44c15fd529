// A simulation's particles as arrays, in order of id.
#include "simulation.h"

namespace fontana_python {

namespace {

struct Attribute {
    const char* name = nullptr;
    fontana_type type = FONTANA_FLOAT;
    int components = 0;
};

Attribute attribute_at(std::size_t index) {
    Attribute attribute;
    check(fontana_attribute_info(index, &attribute.name, &attribute.type, &attribute.components));
    return attribute;
}

std::size_t rows_of(const FloatArray& array, std::size_t components, const char* what) {
    if (array.ndim() != 2 || array.shape(1) != components)
        bad_input(std::string(what) + ": expected an array of shape (N, " + std::to_string(components) + ")");
    return array.shape(0);
}

const float* data_of(const std::optional<FloatArray>& array) { return array ? array->data() : nullptr; }

}  // namespace

void Simulation::add_particles(const FloatArray& position, const std::optional<FloatArray>& velocity,
                               const std::optional<FloatArray>& mass) {
    const std::size_t count = rows_of(position, 3, "position");
    if (velocity && rows_of(*velocity, 3, "velocity") != count) bad_input("as many velocities as positions are needed");
    if (mass && (mass->ndim() != 1 || mass->shape(0) != count)) bad_input("mass: expected one number a particle");
    const float *x = position.data(), *v = data_of(velocity), *m = data_of(mass);
    fontana_status status;
    {
        nb::gil_scoped_release release;
        status = fontana_add_particles(handle_, count, x, v, m);
    }
    check(status);
}

void Simulation::set_force(const std::optional<FloatArray>& force) {
    const std::size_t count = force ? rows_of(*force, 3, "force") : 0;
    check(fontana_set_force(handle_, count, data_of(force)));
}

std::size_t Simulation::particle_count() const { return fontana_particle_count(handle_); }

nb::list Simulation::attributes() const {
    nb::list table;
    for (std::size_t k = 0; k < fontana_attribute_count(); ++k) {
        const Attribute attribute = attribute_at(k);
        const char* type = attribute.type == FONTANA_INT ? "int32" : "float32";
        table.append(nb::make_tuple(attribute.name, type, attribute.components));
    }
    return table;
}

template <typename T>
nb::object Simulation::filled(NumpyArray<T> array, const std::string& name) {
    check(fontana_read_attribute(handle_, name.c_str(), array.data(), array.nbytes()));
    return nb::cast(array);
}

nb::object Simulation::read(const std::string& name) {
    for (std::size_t k = 0; k < fontana_attribute_count(); ++k) {
        const Attribute attribute = attribute_at(k);
        if (name != attribute.name) continue;
        const auto components = static_cast<std::size_t>(attribute.components);
        if (attribute.type == FONTANA_INT) return filled(make_array<std::int32_t>(particle_count(), components), name);
        return filled(make_array<float>(particle_count(), components), name);
    }
    check(fontana_read_attribute(handle_, name.c_str(), nullptr, 0));  // unknown: the library says so
    return nb::none();
}

NumpyArray<std::uint32_t> Simulation::count_neighbors() {
    auto counts = make_array<std::uint32_t>(particle_count(), 1);
    check(fontana_count_neighbors(handle_, counts.data(), particle_count()));
    return counts;
}

}  // namespace fontana_python
