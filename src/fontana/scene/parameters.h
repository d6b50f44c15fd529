// The values of parameters.def, and the table that describes them to hosts.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "fontana.h"

namespace fontana {

using Vector = std::array<double, 3>;

// One member a parameter, named group_name.
struct Parameters {
#define FLOAT(group, name, label, unit, value, minimum, maximum, doc) double group##_##name = value;
#define INT(group, name, label, value, minimum, maximum, doc) int group##_##name = value;
#define BOOL(group, name, label, value, doc) bool group##_##name = value;
#define VECTOR(group, name, label, unit, x, y, z, doc) Vector group##_##name{{x, y, z}};
#define CHOICE(group, name, label, value, choices, doc) std::string group##_##name = value;
#include "scene/parameters.def"
#undef FLOAT
#undef INT
#undef BOOL
#undef VECTOR
#undef CHOICE
};

// In the order of parameters.def.
const std::vector<fontana_parameter>& parameter_table();

// By name; throw BAD_INPUT with the name, what was expected, and for an unknown name the nearest one.
void set_number(Parameters& parameters, const std::string& name, const double* values, std::size_t count);
void set_text(Parameters& parameters, const std::string& name, const std::string& text);
void get_number(const Parameters& parameters, const std::string& name, double* values, std::size_t count);
const std::string& get_text(const Parameters& parameters, const std::string& name);

// "thesis": its method and the defaults of its node (III.8.1). Leaves all else as it is.
void apply_preset(Parameters& parameters, const std::string& preset);

// The word of `words` with the smallest edit distance to `word`.
std::string nearest_word(const std::string& word, const std::vector<std::string>& words);

}  // namespace fontana
