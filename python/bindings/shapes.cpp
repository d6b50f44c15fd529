#include "shapes.h"

#include <type_traits>

namespace fontana_python {

namespace {

const std::vector<std::string> k_colliders = {"plane_x",        "plane_y",         "plane_z",         "sphere_inside",
                                              "sphere_outside", "cylinder_inside", "cylinder_outside"};
const std::vector<std::string> k_emitters = {"block", "sphere", "disc"};

template <typename Enum>
Enum value_of(const std::vector<std::string>& words, const std::string& word, const char* what) {
    std::string choices;
    for (std::size_t k = 0; k < words.size(); ++k) {
        if (words[k] == word) return static_cast<Enum>(k);
        choices += (k ? ", " : "") + words[k];
    }
    bad_input(std::string("no ") + what + " '" + word + "': expected one of " + choices);
}

void set_field(double& field, nb::handle value) { field = nb::cast<double>(value); }
void set_field(int& field, nb::handle value) { field = nb::cast<int>(value); }
void set_field(bool& field, nb::handle value) { field = nb::cast<bool>(value); }
void set_field(double (&field)[3], nb::handle value) {
    const auto point = nb::cast<std::vector<double>>(value);
    if (point.size() != 3) bad_input("expected three numbers, not " + std::to_string(point.size()));
    for (std::size_t k = 0; k < 3; ++k) field[k] = point[k];
}

template <typename Field>
const char* expectation() {
    if (std::is_array_v<Field>) return "three numbers";
    if (std::is_same_v<Field, bool>) return "true or false";
    return std::is_same_v<Field, int> ? "a whole number" : "a number";
}

// The fields that a caller gave. Each that is known is taken out; what is left over at the end is unknown.
class Fields {
 public:
    explicit Fields(const nb::kwargs& keywords) { rest_.update(keywords); }

    template <typename Field>
    void take(const char* name, Field& field) {
        if (!rest_.contains(name)) return;
        try {
            set_field(field, rest_[name]);
        } catch (const nb::cast_error&) {
            bad_input(std::string(name) + ": expected " + expectation<Field>());
        }
        nb::del(rest_[name]);
    }

    // The C interface has an int where Python has a bool.
    void take_flag(const char* name, int& field) {
        bool flag = field != 0;
        take(name, flag);
        field = flag ? 1 : 0;
    }

    void refuse_rest(const char* what) const {
        for (const auto& item : rest_)
            bad_input(std::string("no field '") + nb::cast<std::string>(nb::str(item.first)) + "' of " + what);
    }

 private:
    nb::dict rest_;
};

nb::tuple tuple_of(const double (&point)[3]) { return nb::make_tuple(point[0], point[1], point[2]); }

// Every field of a collider that says nothing but its type, by the names that collider_from takes.
nb::dict collider_defaults(const std::string& type) {
    const fontana_collider collider = collider_from(type, nb::kwargs());
    nb::dict fields;
    fields["enabled"] = collider.enabled != 0;
    fields["flip"] = collider.flip != 0;
    fields["centre"] = tuple_of(collider.centre);
    fields["radius"] = collider.radius;
    fields["cutoff"] = collider.cutoff;
    fields["thickness"] = collider.thickness;
    fields["elasticity"] = collider.elasticity;
    fields["friction"] = collider.friction;
    fields["velocity"] = tuple_of(collider.velocity);
    return fields;
}

}  // namespace

fontana_collider collider_from(const std::string& type, const nb::kwargs& keywords) {
    fontana_collider collider;
    fontana_collider_defaults(value_of<fontana_collider_type>(k_colliders, type, "collider type"), &collider);
    Fields fields(keywords);
    fields.take_flag("enabled", collider.enabled);
    fields.take_flag("flip", collider.flip);
    fields.take("centre", collider.centre);
    fields.take("radius", collider.radius);
    fields.take("cutoff", collider.cutoff);
    fields.take("thickness", collider.thickness);
    fields.take("elasticity", collider.elasticity);
    fields.take("friction", collider.friction);
    fields.take("velocity", collider.velocity);
    fields.refuse_rest("a collider");
    return collider;
}

fontana_emitter emitter_from(const std::string& type, const nb::kwargs& keywords) {
    fontana_emitter emitter;
    fontana_emitter_defaults(value_of<fontana_emitter_type>(k_emitters, type, "emitter type"), &emitter);
    Fields fields(keywords);
    fields.take("centre", emitter.centre);
    fields.take("size", emitter.size);
    fields.take("radius", emitter.radius);
    fields.take("direction", emitter.direction);
    fields.take("speed", emitter.speed);
    fields.take("velocity", emitter.velocity);
    fields.take("rate", emitter.rate);
    fields.take("jitter", emitter.jitter);
    fields.take("first_frame", emitter.first_frame);
    fields.take("last_frame", emitter.last_frame);
    fields.refuse_rest("an emitter");
    return emitter;
}

void bind_shapes(nb::module_& m) { m.def("collider_defaults", &collider_defaults, "type"_a); }

}  // namespace fontana_python
