// A simulation's parameters, colliders and emitters, and what follows from them.
#include "shapes.h"
#include "simulation.h"

namespace fontana_python {

namespace {

fontana_type type_of(const std::string& name) {
    for (std::size_t k = 0; k < fontana_parameter_count(); ++k) {
        fontana_parameter row;
        check(fontana_parameter_info(k, &row));
        if (name == row.name) return row.type;
    }
    return FONTANA_FLOAT;  // unknown: reading it says so
}

std::vector<double> numbers_of(const nb::object& value) {
    if (nb::isinstance<nb::sequence>(value)) return nb::cast<std::vector<double>>(value);
    return {nb::cast<double>(value)};
}

}  // namespace

void Simulation::set(const std::string& name, const nb::object& value) {
    if (nb::isinstance<nb::str>(value)) {
        check(fontana_set_text(handle_, name.c_str(), nb::cast<std::string>(value).c_str()));
        return;
    }
    try {
        const std::vector<double> numbers = numbers_of(value);
        check(fontana_set_number(handle_, name.c_str(), numbers.data(), numbers.size()));
    } catch (const nb::cast_error&) {
        bad_input(name + ": expected a number, three numbers or a word");
    }
}

nb::object Simulation::get(const std::string& name) {
    const fontana_type type = type_of(name);
    if (type == FONTANA_CHOICE) {
        const char* text = nullptr;
        check(fontana_get_text(handle_, name.c_str(), &text));
        return nb::cast(text);
    }
    double v[3] = {};
    check(fontana_get_number(handle_, name.c_str(), v, type == FONTANA_VECTOR ? 3 : 1));
    if (type == FONTANA_VECTOR) return nb::make_tuple(v[0], v[1], v[2]);
    if (type == FONTANA_INT) return nb::cast(static_cast<long>(v[0]));
    if (type == FONTANA_BOOL) return nb::cast(v[0] != 0.0);
    return nb::cast(v[0]);
}

void Simulation::apply_preset(const std::string& preset) { check(fontana_apply_preset(handle_, preset.c_str())); }

std::size_t Simulation::add_collider(const std::string& type, const nb::kwargs& fields) {
    const fontana_collider collider = collider_from(type, fields);
    std::size_t index = 0;
    check(fontana_add_collider(handle_, &collider, &index));
    return index;
}

void Simulation::set_collider(std::size_t index, const std::string& type, const nb::kwargs& fields) {
    const fontana_collider collider = collider_from(type, fields);
    check(fontana_set_collider(handle_, index, &collider));
}

void Simulation::set_collider_keys(std::size_t index, const std::vector<double>& times,
                                   const std::vector<Point>& centres) {
    if (times.size() != centres.size()) bad_input("as many times as centres are needed for a collider's keys");
    check(fontana_set_collider_keys(handle_, index, times.size(), times.data(),
                                    centres.empty() ? nullptr : centres[0].data()));
}

Point Simulation::collider_centre(std::size_t index, double time) {
    Point centre;
    check(fontana_collider_centre(handle_, index, time, centre.data()));
    return centre;
}

std::size_t Simulation::collider_count() const { return fontana_collider_count(handle_); }

std::size_t Simulation::add_emitter(const std::string& type, const nb::kwargs& fields) {
    const fontana_emitter emitter = emitter_from(type, fields);
    std::size_t index = 0;
    check(fontana_add_emitter(handle_, &emitter, &index));
    return index;
}

std::uint64_t Simulation::emitted_by(std::int64_t frame) {
    std::uint64_t count = 0;
    check(fontana_emitted_by(handle_, frame, &count));
    return count;
}

void Simulation::check_settings() { check(fontana_check(handle_)); }

fontana_derived Simulation::derived() {
    fontana_derived out;
    check(fontana_derive(handle_, &out));
    return out;
}

fontana_time_step_limits Simulation::estimate_limits(double speed, double acceleration) {
    fontana_time_step_limits limits;
    check(fontana_estimate_limits(handle_, speed, acceleration, &limits));
    return limits;
}

std::uint64_t Simulation::estimate_memory(std::uint64_t particle_count) {
    std::uint64_t bytes = 0;
    check(fontana_estimate_memory(handle_, particle_count, &bytes));
    return bytes;
}

}  // namespace fontana_python
