// The table of parameters, row by row, and the smoothing kernels by name.
#include <sstream>

#include "bindings.h"

namespace fontana_python {

namespace {

const std::vector<std::string> k_types = {"float", "int", "bool", "vector", "choice"};

struct Parameter {
    fontana_parameter row;

    std::string type() const { return k_types[row.type]; }

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

    nb::tuple choices() const { return words(row.choices); }
};

std::vector<Parameter> parameters() {
    std::vector<Parameter> table(fontana_parameter_count());
    for (std::size_t k = 0; k < table.size(); ++k) check(fontana_parameter_info(k, &table[k].row));
    return table;
}

double smoothing_kernel(const std::string& kernel, const std::string& quantity, double r, double support_radius) {
    double value = 0.0;
    check(fontana_smoothing_kernel(kernel.c_str(), quantity.c_str(), r, support_radius, &value));
    return value;
}

}  // namespace

nb::tuple words(const std::string& choices) {
    nb::list result;
    std::istringstream text(choices);
    for (std::string word; std::getline(text, word, '|');) result.append(word);
    return nb::tuple(result);
}

void bind_parameters(nb::module_& m) {
    nb::class_<Parameter>(m, "Parameter")
        .def_prop_ro("name", [](const Parameter& p) { return p.row.name; })
        .def_prop_ro("label", [](const Parameter& p) { return p.row.label; })
        .def_prop_ro("group", [](const Parameter& p) { return p.row.group; })
        .def_prop_ro("unit", [](const Parameter& p) { return p.row.unit; })
        .def_prop_ro("doc", [](const Parameter& p) { return p.row.doc; })
        .def_prop_ro("minimum", [](const Parameter& p) { return p.row.minimum; })
        .def_prop_ro("maximum", [](const Parameter& p) { return p.row.maximum; })
        .def_prop_ro("type", &Parameter::type)
        .def_prop_ro("default", &Parameter::default_value)
        .def_prop_ro("choices", &Parameter::choices);
    m.def("parameters", &parameters);
    m.def("smoothing_kernel", &smoothing_kernel, "kernel"_a, "quantity"_a, "r"_a, "support_radius"_a);
}

}  // namespace fontana_python
