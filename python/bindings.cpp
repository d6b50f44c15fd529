// fontana._core: the C interface as Python objects. Names, arrays and errors change their form here, and nothing else
// happens: what this module can do, any plugin can.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/function.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "fontana.h"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

using FloatArray = nb::ndarray<const float, nb::c_contig, nb::device::cpu>;
using Point = std::array<double, 3>;

// ---- errors: a class for each status, under FontanaError -----------------------------------------------------------

PyObject* error_classes[FONTANA_INTERNAL + 1];

void add_error_classes(nb::module_& module) {
    PyObject* base = PyErr_NewException("fontana.FontanaError", nullptr, nullptr);
    module.attr("FontanaError") = nb::borrow(base);
    const char* names[] = {nullptr,      "BadInput", "OutOfMemory",  "Unstable", "Interrupted", "DeviceUnavailable",
                           "DeviceLost", "IoError",  "InternalError"};
    for (int status = 1; status <= FONTANA_INTERNAL; ++status) {
        error_classes[status] = PyErr_NewException((std::string("fontana.") + names[status]).c_str(), base, nullptr);
        module.attr(names[status]) = nb::borrow(error_classes[status]);
    }
}

void check(fontana_status status) {
    if (status == FONTANA_OK) return;
    PyErr_SetString(error_classes[status], fontana_last_error());
    throw nb::python_error();
}

[[noreturn]] void bad_input(const std::string& sentence) {
    PyErr_SetString(error_classes[FONTANA_BAD_INPUT], sentence.c_str());
    throw nb::python_error();
}

// ---- words for enumerations ----------------------------------------------------------------------------------------

template <typename Enum>
Enum value_of(const std::vector<std::string>& words, const std::string& word, const char* what) {
    std::string choices;
    for (std::size_t k = 0; k < words.size(); ++k) {
        if (words[k] == word) return static_cast<Enum>(k);
        choices += (k ? ", " : "") + words[k];
    }
    bad_input(std::string("no ") + what + " '" + word + "': expected one of " + choices);
}

const std::vector<std::string> k_types = {"float", "int", "bool", "vector", "choice"};
const std::vector<std::string> k_colliders = {"plane_x",        "plane_y",         "plane_z",         "sphere_inside",
                                              "sphere_outside", "cylinder_inside", "cylinder_outside"};
const std::vector<std::string> k_emitters = {"block", "sphere", "disc"};

// ---- structs filled from keyword arguments
// ---------------------------------------------------------------------------

void set_field(double& field, nb::handle value) { field = nb::cast<double>(value); }
void set_field(int& field, nb::handle value) { field = nb::cast<int>(value); }
void set_field(double (&field)[3], nb::handle value) {
    const auto point = nb::cast<std::vector<double>>(value);
    if (point.size() != 3) bad_input("expected three numbers, not " + std::to_string(point.size()));
    for (std::size_t k = 0; k < 3; ++k) field[k] = point[k];
}

// Takes `name` out of the arguments; what is left over at the end is unknown.
template <typename Field>
void take(nb::dict& arguments, const char* name, Field& field) {
    if (!arguments.contains(name)) return;
    try {
        set_field(field, arguments[name]);
    } catch (const nb::cast_error&) {
        bad_input(std::string(name) + ": expected " + (std::is_array_v<Field> ? "three numbers" : "a number"));
    }
    nb::del(arguments[name]);
}

void refuse_rest(const nb::dict& arguments, const char* what) {
    for (const auto& item : arguments)
        bad_input(std::string("no field '") + nb::cast<std::string>(nb::str(item.first)) + "' of " + what);
}

fontana_collider collider_from(const std::string& type, nb::kwargs keywords) {
    fontana_collider collider;
    fontana_collider_defaults(value_of<fontana_collider_type>(k_colliders, type, "collider type"), &collider);
    nb::dict rest;
    rest.update(keywords);
    if (rest.contains("enabled")) rest["enabled"] = nb::cast(nb::cast<bool>(rest["enabled"]) ? 1 : 0);
    if (rest.contains("flip")) rest["flip"] = nb::cast(nb::cast<bool>(rest["flip"]) ? 1 : 0);
    take(rest, "enabled", collider.enabled);
    take(rest, "flip", collider.flip);
    take(rest, "centre", collider.centre);
    take(rest, "radius", collider.radius);
    take(rest, "cutoff", collider.cutoff);
    take(rest, "thickness", collider.thickness);
    take(rest, "elasticity", collider.elasticity);
    take(rest, "friction", collider.friction);
    take(rest, "velocity", collider.velocity);
    refuse_rest(rest, "a collider");
    return collider;
}

fontana_emitter emitter_from(const std::string& type, nb::kwargs keywords) {
    fontana_emitter emitter;
    fontana_emitter_defaults(value_of<fontana_emitter_type>(k_emitters, type, "emitter type"), &emitter);
    nb::dict rest;
    rest.update(keywords);
    take(rest, "centre", emitter.centre);
    take(rest, "size", emitter.size);
    take(rest, "radius", emitter.radius);
    take(rest, "direction", emitter.direction);
    take(rest, "speed", emitter.speed);
    take(rest, "velocity", emitter.velocity);
    take(rest, "rate", emitter.rate);
    take(rest, "jitter", emitter.jitter);
    take(rest, "first_frame", emitter.first_frame);
    take(rest, "last_frame", emitter.last_frame);
    refuse_rest(rest, "an emitter");
    return emitter;
}

// ---- what the module returns
// -----------------------------------------------------------------------------------------

struct Parameter {
    fontana_parameter row;

    nb::object default_value() const {
        switch (row.type) {
            case FONTANA_INT:
                return nb::cast(static_cast<long>(row.default_value[0]));
            case FONTANA_BOOL:
                return nb::cast(row.default_value[0] != 0.0);
            case FONTANA_VECTOR:
                return nb::make_tuple(row.default_value[0], row.default_value[1], row.default_value[2]);
            case FONTANA_CHOICE:
                return nb::cast(row.default_text);
            default:
                return nb::cast(row.default_value[0]);
        }
    }
    nb::tuple choices() const {
        nb::list words;
        std::string word;
        for (const char* c = row.choices; *row.choices; ++c) {
            if (*c && *c != '|') {
                word += *c;
                continue;
            }
            words.append(word);
            word.clear();
            if (!*c) break;
        }
        return nb::tuple(words);
    }
};

struct KernelProfile {
    std::string name;
    std::uint64_t launches, elements;
    double seconds, bytes, flops;

    KernelProfile(const fontana_kernel_profile& row)
        : name(row.name),
          launches(row.launches),
          elements(row.elements),
          seconds(row.seconds),
          bytes(row.bytes),
          flops(row.flops) {}
};

struct Device {
    std::string backend, name, driver, reason;
    std::uint64_t memory_bytes;
    std::uint32_t compute_units;
    bool is_gpu, available;

    explicit Device(const fontana_device& d)
        : backend(d.backend),
          name(d.name),
          driver(d.driver),
          reason(d.reason),
          memory_bytes(d.memory_bytes),
          compute_units(d.compute_units),
          is_gpu(d.is_gpu != 0),
          available(d.available != 0) {}
};

struct FrameReport : fontana_frame_report {
    std::string limit;
};

std::vector<Device> devices() {
    const fontana_device* found = nullptr;
    std::size_t count = 0;
    check(fontana_list_devices(&found, &count));
    std::vector<Device> result;
    for (std::size_t k = 0; k < count; ++k) result.emplace_back(found[k]);
    return result;
}

template <typename T>
nb::ndarray<nb::numpy, T> make_array(std::size_t rows, std::size_t components) {
    T* data = new T[rows * components];
    nb::capsule owner(data, [](void* p) noexcept { delete[] static_cast<T*>(p); });
    const std::size_t shape[2] = {rows, components};
    return nb::ndarray<nb::numpy, T>(data, components == 1 ? 1 : 2, shape, owner);
}

// ---- the simulation ------------------------------------------------------------------------------------------------

class Simulation {
 public:
    Simulation() { check(fontana_create(&handle_)); }
    ~Simulation() { fontana_destroy(handle_); }
    Simulation(const Simulation&) = delete;
    Simulation& operator=(const Simulation&) = delete;

    void set(const std::string& name, nb::object value) {
        if (nb::isinstance<nb::str>(value)) {
            check(fontana_set_text(handle_, name.c_str(), nb::cast<std::string>(value).c_str()));
            return;
        }
        try {
            const auto numbers = nb::isinstance<nb::sequence>(value) ? nb::cast<std::vector<double>>(value)
                                                                     : std::vector<double>{nb::cast<double>(value)};
            check(fontana_set_number(handle_, name.c_str(), numbers.data(), numbers.size()));
        } catch (const nb::cast_error&) {
            bad_input(name + ": expected a number, three numbers or a word");
        }
    }

    nb::object get(const std::string& name) {
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

    void apply_preset(const std::string& preset) { check(fontana_apply_preset(handle_, preset.c_str())); }

    fontana_derived derived() {
        fontana_derived out;
        check(fontana_derive(handle_, &out));
        return out;
    }

    std::size_t add_collider(const std::string& type, nb::kwargs fields) {
        const fontana_collider collider = collider_from(type, fields);
        std::size_t index = 0;
        check(fontana_add_collider(handle_, &collider, &index));
        return index;
    }

    void set_collider(std::size_t index, const std::string& type, nb::kwargs fields) {
        const fontana_collider collider = collider_from(type, fields);
        check(fontana_set_collider(handle_, index, &collider));
    }

    void set_collider_keys(std::size_t index, const std::vector<double>& times, const std::vector<Point>& centres) {
        if (times.size() != centres.size()) bad_input("as many times as centres are needed for a collider's keys");
        check(fontana_set_collider_keys(handle_, index, times.size(), times.data(),
                                        centres.empty() ? nullptr : centres[0].data()));
    }

    Point collider_centre(std::size_t index, double time) {
        Point centre;
        check(fontana_collider_centre(handle_, index, time, centre.data()));
        return centre;
    }

    std::size_t collider_count() const { return fontana_collider_count(handle_); }

    std::size_t add_emitter(const std::string& type, nb::kwargs fields) {
        const fontana_emitter emitter = emitter_from(type, fields);
        std::size_t index = 0;
        check(fontana_add_emitter(handle_, &emitter, &index));
        return index;
    }

    std::uint64_t emitted_by(std::int64_t frame) {
        std::uint64_t count = 0;
        check(fontana_emitted_by(handle_, frame, &count));
        return count;
    }

    void add_particles(FloatArray position, std::optional<FloatArray> velocity, std::optional<FloatArray> mass) {
        const std::size_t count = rows_of(position, 3, "position");
        if (velocity && rows_of(*velocity, 3, "velocity") != count)
            bad_input("as many velocities as positions are needed");
        if (mass && (mass->ndim() != 1 || mass->shape(0) != count)) bad_input("mass: expected one number a particle");
        const float *x = position.data(), *v = velocity ? velocity->data() : nullptr,
                    *m = mass ? mass->data() : nullptr;
        fontana_status status;
        {
            nb::gil_scoped_release release;
            status = fontana_add_particles(handle_, count, x, v, m);
        }
        check(status);
    }

    void set_force(std::optional<FloatArray> force) {
        const std::size_t count = force ? rows_of(*force, 3, "force") : 0;
        check(fontana_set_force(handle_, count, force ? force->data() : nullptr));
    }

    std::size_t particle_count() const { return fontana_particle_count(handle_); }

    nb::object read(const std::string& name) {
        const std::size_t count = particle_count();
        for (std::size_t k = 0; k < fontana_attribute_count(); ++k) {
            const char* known = nullptr;
            fontana_type type;
            int components = 0;
            check(fontana_attribute_info(k, &known, &type, &components));
            if (name != known) continue;
            const auto width = static_cast<std::size_t>(components);
            if (type == FONTANA_INT) return filled(make_array<std::int32_t>(count, width), name, count * width);
            return filled(make_array<float>(count, width), name, count * width);
        }
        check(fontana_read_attribute(handle_, name.c_str(), nullptr, 0));
        return nb::none();
    }

    FrameReport step_frame(std::optional<std::function<bool(double)>> progress) {
        FrameReport report;
        struct Call {
            std::function<bool(double)>* progress;
            bool failed;
        } call{progress ? &*progress : nullptr, false};
        const auto callback = [](void* user, double fraction) -> int {
            Call& state = *static_cast<Call*>(user);
            nb::gil_scoped_acquire acquire;
            try {
                const bool stop = state.progress && (*state.progress)(fraction);
                if (PyErr_CheckSignals() == 0) return stop ? 1 : 0;
            } catch (nb::python_error& error) {
                error.restore();
            }
            state.failed = true;  // a Python error is set: stop and raise it
            return 1;
        };
        check(fontana_set_progress(handle_, callback, &call));
        fontana_status status;
        {
            nb::gil_scoped_release release;
            status = fontana_step_frame(handle_, &report);
        }
        fontana_set_progress(handle_, nullptr, nullptr);
        if (call.failed) throw nb::python_error();
        check(status);
        report.limit = report.dt_limit;
        return report;
    }

    std::int64_t frame() const { return fontana_frame(handle_); }

    fontana_time_step_limits estimate_limits(double speed, double acceleration) {
        fontana_time_step_limits limits;
        check(fontana_estimate_limits(handle_, speed, acceleration, &limits));
        return limits;
    }

    std::uint64_t estimate_memory(std::uint64_t particle_count) {
        std::uint64_t bytes = 0;
        check(fontana_estimate_memory(handle_, particle_count, &bytes));
        return bytes;
    }

    void check_settings() { check(fontana_check(handle_)); }

    Device device() {
        fontana_device device;
        check(fontana_device_in_use(handle_, &device));
        return Device(device);
    }

    std::vector<KernelProfile> profile() {
        const fontana_kernel_profile* rows = nullptr;
        std::size_t count = 0;
        check(fontana_read_profile(handle_, &rows, &count));
        return {rows, rows + count};
    }

    double measure_copy(std::size_t bytes) {
        double bytes_per_second = 0.0;
        fontana_status status;
        {
            nb::gil_scoped_release release;
            status = fontana_measure_copy(handle_, bytes, &bytes_per_second);
        }
        check(status);
        return bytes_per_second;
    }

    void write_bgeo(const std::string& path) { check(fontana_write_bgeo(handle_, path.c_str())); }
    void save_checkpoint(const std::string& path, const std::string& tag) {
        check(fontana_save_checkpoint(handle_, path.c_str(), tag.c_str()));
    }
    void load_checkpoint(const std::string& path) { check(fontana_load_checkpoint(handle_, path.c_str())); }

    nb::ndarray<nb::numpy, std::uint32_t> count_neighbors() {
        auto counts = make_array<std::uint32_t>(particle_count(), 1);
        check(fontana_count_neighbors(handle_, counts.data(), particle_count()));
        return counts;
    }

 private:
    static std::size_t rows_of(const FloatArray& array, std::size_t components, const char* what) {
        if (array.ndim() != 2 || array.shape(1) != components)
            bad_input(std::string(what) + ": expected an array of shape (N, " + std::to_string(components) + ")");
        return array.shape(0);
    }

    template <typename T>
    nb::object filled(nb::ndarray<nb::numpy, T> array, const std::string& name, std::size_t values) {
        check(fontana_read_attribute(handle_, name.c_str(), array.data(), values * 4));
        return nb::cast(array);
    }

    static fontana_type type_of(const std::string& name) {
        for (std::size_t k = 0; k < fontana_parameter_count(); ++k) {
            fontana_parameter row;
            check(fontana_parameter_info(k, &row));
            if (name == row.name) return row.type;
        }
        return FONTANA_FLOAT;  // unknown: reading it says so
    }

    fontana_simulation* handle_ = nullptr;
};

std::vector<Parameter> parameters() {
    std::vector<Parameter> table(fontana_parameter_count());
    for (std::size_t k = 0; k < table.size(); ++k) check(fontana_parameter_info(k, &table[k].row));
    return table;
}

nb::list attributes() {
    nb::list table;
    for (std::size_t k = 0; k < fontana_attribute_count(); ++k) {
        const char* name = nullptr;
        fontana_type type;
        int components = 0;
        check(fontana_attribute_info(k, &name, &type, &components));
        table.append(nb::make_tuple(name, type == FONTANA_INT ? "int32" : "float32", components));
    }
    return table;
}

std::tuple<std::int64_t, std::uint64_t, std::string> checkpoint_info(const std::string& path) {
    std::int64_t frame = 0;
    std::uint64_t count = 0;
    std::vector<char> tag(std::size_t{1} << 20 | 1);  // the longest a checkpoint may have
    check(fontana_checkpoint_info(path.c_str(), &frame, &count, tag.data(), tag.size()));
    return {frame, count, tag.data()};
}

std::uint64_t publish_file(const std::string& path, nb::bytes data) {
    std::uint64_t hash = 0;
    check(fontana_publish_file(path.c_str(), data.c_str(), data.size(), &hash));
    return hash;
}

void bind_tables(nb::module_& m) {
#define ROW_TEXT(field) [](const Parameter& p) { return p.row.field; }
    nb::class_<Parameter>(m, "Parameter")
        .def_prop_ro("name", ROW_TEXT(name))
        .def_prop_ro("label", ROW_TEXT(label))
        .def_prop_ro("group", ROW_TEXT(group))
        .def_prop_ro("unit", ROW_TEXT(unit))
        .def_prop_ro("doc", ROW_TEXT(doc))
        .def_prop_ro("minimum", ROW_TEXT(minimum))
        .def_prop_ro("maximum", ROW_TEXT(maximum))
        .def_prop_ro("type", [](const Parameter& p) { return k_types[p.row.type]; })
        .def_prop_ro("default", &Parameter::default_value)
        .def_prop_ro("choices", &Parameter::choices);
#undef ROW_TEXT
    nb::class_<KernelProfile>(m, "KernelProfile")
        .def_ro("name", &KernelProfile::name)
        .def_ro("launches", &KernelProfile::launches)
        .def_ro("elements", &KernelProfile::elements)
        .def_ro("seconds", &KernelProfile::seconds)
        .def_ro("bytes", &KernelProfile::bytes)
        .def_ro("flops", &KernelProfile::flops);
    nb::class_<Device>(m, "Device")
        .def_ro("backend", &Device::backend)
        .def_ro("name", &Device::name)
        .def_ro("driver", &Device::driver)
        .def_ro("memory_bytes", &Device::memory_bytes)
        .def_ro("compute_units", &Device::compute_units)
        .def_ro("is_gpu", &Device::is_gpu)
        .def_ro("available", &Device::available)
        .def_ro("reason", &Device::reason);
    nb::class_<fontana_derived>(m, "Derived")
        .def_ro("support_radius", &fontana_derived::support_radius)
        .def_ro("particle_mass", &fontana_derived::particle_mass)
        .def_ro("kinematic_viscosity", &fontana_derived::kinematic_viscosity)
        .def_ro("speed_of_sound", &fontana_derived::speed_of_sound)
        .def_ro("frame_duration", &fontana_derived::frame_duration)
        .def_ro("self_density", &fontana_derived::self_density)
        .def_ro("particle_radius", &fontana_derived::particle_radius);
    nb::class_<fontana_time_step_limits>(m, "TimeStepLimits")
        .def_ro("advection", &fontana_time_step_limits::advection)
        .def_ro("acceleration", &fontana_time_step_limits::acceleration)
        .def_ro("acoustic", &fontana_time_step_limits::acoustic)
        .def_ro("viscosity", &fontana_time_step_limits::viscosity)
        .def_ro("surface_tension", &fontana_time_step_limits::surface_tension)
        .def_ro("convergence", &fontana_time_step_limits::convergence);
    nb::class_<FrameReport>(m, "FrameReport")
        .def_prop_ro("frame", [](const FrameReport& r) { return r.frame; })
        .def_prop_ro("time", [](const FrameReport& r) { return r.time; })
        .def_prop_ro("particle_count", [](const FrameReport& r) { return r.particle_count; })
        .def_prop_ro("substeps", [](const FrameReport& r) { return r.substeps; })
        .def_prop_ro("iterations", [](const FrameReport& r) { return r.iterations; })
        .def_prop_ro("unconverged", [](const FrameReport& r) { return r.unconverged; })
        .def_prop_ro("dt_min", [](const FrameReport& r) { return r.dt_min; })
        .def_prop_ro("dt_max", [](const FrameReport& r) { return r.dt_max; })
        .def_ro("dt_limit", &FrameReport::limit)
        .def_prop_ro("density_error_mean", [](const FrameReport& r) { return r.density_error_mean; })
        .def_prop_ro("density_error_max", [](const FrameReport& r) { return r.density_error_max; })
        .def_prop_ro("max_speed", [](const FrameReport& r) { return r.max_speed; })
        .def_prop_ro("kinetic_energy", [](const FrameReport& r) { return r.kinetic_energy; })
        .def_prop_ro("centre_of_mass",
                     [](const FrameReport& r) {
                         return nb::make_tuple(r.centre_of_mass[0], r.centre_of_mass[1], r.centre_of_mass[2]);
                     })
        .def_prop_ro("seconds", [](const FrameReport& r) { return r.seconds; });
}

void bind_simulation(nb::module_& m) {
    nb::class_<Simulation>(m, "Simulation")
        .def(nb::init<>())
        .def("set", &Simulation::set, "name"_a, "value"_a)
        .def("get", &Simulation::get, "name"_a)
        .def("apply_preset", &Simulation::apply_preset, "preset"_a)
        .def("derived", &Simulation::derived)
        .def("add_collider", &Simulation::add_collider, "type"_a, "fields"_a)
        .def("set_collider", &Simulation::set_collider, "index"_a, "type"_a, "fields"_a)
        .def("set_collider_keys", &Simulation::set_collider_keys, "index"_a, "times"_a, "centres"_a)
        .def("collider_centre", &Simulation::collider_centre, "index"_a, "time"_a)
        .def_prop_ro("collider_count", &Simulation::collider_count)
        .def("add_emitter", &Simulation::add_emitter, "type"_a, "fields"_a)
        .def("emitted_by", &Simulation::emitted_by, "frame"_a)
        .def("add_particles", &Simulation::add_particles, "position"_a, "velocity"_a = nb::none(),
             "mass"_a = nb::none())
        .def("set_force", &Simulation::set_force, "force"_a.none())
        .def_prop_ro("particle_count", &Simulation::particle_count)
        .def("attributes", [](Simulation&) { return attributes(); })
        .def("read", &Simulation::read, "name"_a)
        .def("step_frame", &Simulation::step_frame, "progress"_a = nb::none())
        .def_prop_ro("frame", &Simulation::frame)
        .def("estimate_limits", &Simulation::estimate_limits, "speed"_a, "acceleration"_a)
        .def("estimate_memory", &Simulation::estimate_memory, "particle_count"_a)
        .def("check", &Simulation::check_settings)
        .def("device", &Simulation::device)
        .def("profile", &Simulation::profile)
        .def("measure_copy", &Simulation::measure_copy, "bytes"_a)
        .def("write_bgeo", &Simulation::write_bgeo, "path"_a)
        .def("save_checkpoint", &Simulation::save_checkpoint, "path"_a, "tag"_a = "")
        .def("load_checkpoint", &Simulation::load_checkpoint, "path"_a)
        .def("count_neighbors", &Simulation::count_neighbors);
}

}  // namespace

NB_MODULE(_core, m) {
    // Tables and errors that Python modules hold until the interpreter ends are no leak worth a page of warnings.
    nb::set_leak_warnings(false);
    m.doc() = "The C interface of Fontana (fontana.h) as Python objects.";
    add_error_classes(m);
    bind_tables(m);
    bind_simulation(m);
    m.def("version", &fontana_version);
    m.def("parameters", &parameters);
    m.def("devices", &devices);
    m.def("checkpoint_info", &checkpoint_info, "path"_a);
    m.def("publish_file", &publish_file, "path"_a, "data"_a);
    m.def("hash", [](nb::bytes data) { return fontana_hash(data.c_str(), data.size()); }, "data"_a);
    m.def(
        "smoothing_kernel",
        [](const std::string& kernel, const std::string& quantity, double r, double support_radius) {
            double value = 0.0;
            check(fontana_smoothing_kernel(kernel.c_str(), quantity.c_str(), r, support_radius, &value));
            return value;
        },
        "kernel"_a, "quantity"_a, "r"_a, "support_radius"_a);
}
