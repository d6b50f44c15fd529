#include "scene/parameters.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numeric>
#include <sstream>
#include <variant>

#include "util/error.h"

namespace fontana {
namespace {

using Member = std::variant<double Parameters::*, int Parameters::*, bool Parameters::*, Vector Parameters::*,
                            std::string Parameters::*>;

const std::vector<Member>& members() {
    static const std::vector<Member> table = {
#define FLOAT(group, name, label, unit, value, minimum, maximum, doc) &Parameters::group##_##name,
#define INT(group, name, label, value, minimum, maximum, doc) &Parameters::group##_##name,
#define BOOL(group, name, label, value, doc) &Parameters::group##_##name,
#define VECTOR(group, name, label, unit, x, y, z, doc) &Parameters::group##_##name,
#define CHOICE(group, name, label, value, choices, doc) &Parameters::group##_##name,
#include "scene/parameters.def"
#undef FLOAT
#undef INT
#undef BOOL
#undef VECTOR
#undef CHOICE
    };
    return table;
}

constexpr double k_infinity = std::numeric_limits<double>::infinity();

std::size_t index_of(const std::string& name) {
    const std::vector<fontana_parameter>& table = parameter_table();
    for (std::size_t k = 0; k < table.size(); ++k)
        if (name == table[k].name) return k;
    std::vector<std::string> names;
    for (const fontana_parameter& row : table) names.emplace_back(row.name);
    fail(FONTANA_BAD_INPUT, "no parameter '" + name + "': did you mean '" + nearest_word(name, names) + "'?");
}

std::string text_of(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", value);
    return text;
}

void check_number(const fontana_parameter& row, double value) {
    if (!std::isfinite(value))
        fail(FONTANA_BAD_INPUT, std::string(row.name) + ": expected a finite number, not " + text_of(value));
    if (value < row.minimum || value > row.maximum) {
        std::string unit = *row.unit ? std::string(" ") + row.unit : std::string();
        fail(FONTANA_BAD_INPUT, std::string(row.name) + ": " + text_of(value) + " is out of range; expected " +
                                    text_of(row.minimum) + " to " + text_of(row.maximum) + unit);
    }
    if ((row.type == FONTANA_INT || row.type == FONTANA_BOOL) && value != std::floor(value))
        fail(FONTANA_BAD_INPUT, std::string(row.name) + ": expected a whole number, not " + text_of(value));
}

std::vector<std::string> split(const std::string& words) {
    std::vector<std::string> result;
    std::stringstream stream(words);
    for (std::string word; std::getline(stream, word, '|');) result.push_back(word);
    return result;
}

void check_count(const fontana_parameter& row, std::size_t count) {
    if (row.type == FONTANA_CHOICE)
        fail(FONTANA_BAD_INPUT, std::string(row.name) + ": expected one of " + row.choices + ", not a number");
    const std::size_t expected = row.type == FONTANA_VECTOR ? 3 : 1;
    if (count != expected)
        fail(FONTANA_BAD_INPUT, std::string(row.name) + ": expected " +
                                    (expected == 3 ? "three numbers" : "one number") + ", not " +
                                    std::to_string(count));
}

}  // namespace

const std::vector<fontana_parameter>& parameter_table() {
    static const std::vector<fontana_parameter> table = {
#define FLOAT(group, name, label, unit, value, minimum, maximum, doc) \
    {#group "." #name, label, #group, FONTANA_FLOAT, unit, {value, 0, 0}, "", minimum, maximum, "", doc},
#define INT(group, name, label, value, minimum, maximum, doc) \
    {#group "." #name, label, #group, FONTANA_INT, "", {value, 0, 0}, "", minimum, maximum, "", doc},
#define BOOL(group, name, label, value, doc) \
    {#group "." #name, label, #group, FONTANA_BOOL, "", {value ? 1.0 : 0.0, 0, 0}, "", 0, 1, "", doc},
#define VECTOR(group, name, label, unit, x, y, z, doc) \
    {#group "." #name, label, #group, FONTANA_VECTOR, unit, {x, y, z}, "", -k_infinity, k_infinity, "", doc},
#define CHOICE(group, name, label, value, choices, doc) \
    {#group "." #name, label, #group, FONTANA_CHOICE, "", {0, 0, 0}, value, -k_infinity, k_infinity, choices, doc},
#include "scene/parameters.def"
#undef FLOAT
#undef INT
#undef BOOL
#undef VECTOR
#undef CHOICE
    };
    return table;
}

void set_number(Parameters& parameters, const std::string& name, const double* values, std::size_t count) {
    const std::size_t index = index_of(name);
    const fontana_parameter& row = parameter_table()[index];
    check_count(row, count);
    for (std::size_t k = 0; k < count; ++k) check_number(row, values[k]);
    const Member& member = members()[index];
    switch (row.type) {
        case FONTANA_FLOAT:
            parameters.*std::get<double Parameters::*>(member) = values[0];
            break;
        case FONTANA_INT:
            parameters.*std::get<int Parameters::*>(member) = static_cast<int>(values[0]);
            break;
        case FONTANA_BOOL:
            parameters.*std::get<bool Parameters::*>(member) = values[0] != 0.0;
            break;
        case FONTANA_VECTOR:
            parameters.*std::get<Vector Parameters::*>(member) = {values[0], values[1], values[2]};
            break;
        case FONTANA_CHOICE:
            break;
    }
}

void set_text(Parameters& parameters, const std::string& name, const std::string& text) {
    const std::size_t index = index_of(name);
    const fontana_parameter& row = parameter_table()[index];
    if (row.type != FONTANA_CHOICE) fail(FONTANA_BAD_INPUT, name + ": expected a number, not the text '" + text + "'");
    const std::vector<std::string> choices = split(row.choices);
    if (std::find(choices.begin(), choices.end(), text) == choices.end())
        fail(FONTANA_BAD_INPUT, name + ": no '" + text + "'; expected one of " + row.choices + " (nearest: '" +
                                    nearest_word(text, choices) + "')");
    parameters.*std::get<std::string Parameters::*>(members()[index]) = text;
}

void get_number(const Parameters& parameters, const std::string& name, double* values, std::size_t count) {
    const std::size_t index = index_of(name);
    const fontana_parameter& row = parameter_table()[index];
    check_count(row, count);
    const Member& member = members()[index];
    switch (row.type) {
        case FONTANA_FLOAT:
            values[0] = parameters.*std::get<double Parameters::*>(member);
            break;
        case FONTANA_INT:
            values[0] = parameters.*std::get<int Parameters::*>(member);
            break;
        case FONTANA_BOOL:
            values[0] = parameters.*std::get<bool Parameters::*>(member) ? 1.0 : 0.0;
            break;
        case FONTANA_VECTOR: {
            const Vector& vector = parameters.*std::get<Vector Parameters::*>(member);
            std::copy(vector.begin(), vector.end(), values);
            break;
        }
        case FONTANA_CHOICE:
            break;
    }
}

const std::string& get_text(const Parameters& parameters, const std::string& name) {
    const std::size_t index = index_of(name);
    if (parameter_table()[index].type != FONTANA_CHOICE) fail(FONTANA_BAD_INPUT, name + " is a number: read it as one");
    return parameters.*std::get<std::string Parameters::*>(members()[index]);
}

void apply_preset(Parameters& parameters, const std::string& preset) {
    if (preset != "thesis") fail(FONTANA_BAD_INPUT, "no preset '" + preset + "': expected 'thesis'");
    parameters.fluid_method = "mueller";
    parameters.fluid_rest_density = 1000.0;
    parameters.fluid_pressure_constant = 10.0;
    parameters.fluid_negative_pressure = true;
    parameters.fluid_viscosity = 0.15;
    parameters.fluid_surface_tension = 0.0;
    parameters.fluid_particle_mass = 0.00020543;
    parameters.fluid_support_radius = 0.006;
    // The node takes its particles as they come; for our emitters, half the support radius as elsewhere.
    parameters.fluid_particle_spacing = 0.003;
    parameters.time_simulation_scale = 1.0;
    parameters.time_timestep = 0.002;
    parameters.time_substeps = 10;
    parameters.forces_drag = 0.999;
    parameters.forces_gravity = {0.0, -93.0, 0.0};
}

std::string nearest_word(const std::string& word, const std::vector<std::string>& words) {
    std::string best;
    std::size_t best_distance = std::numeric_limits<std::size_t>::max();
    for (const std::string& candidate : words) {
        // Levenshtein's distance, one row at a time.
        std::vector<std::size_t> row(candidate.size() + 1);
        std::iota(row.begin(), row.end(), std::size_t{0});
        for (std::size_t i = 0; i < word.size(); ++i) {
            std::size_t diagonal = row[0]++;
            for (std::size_t j = 0; j < candidate.size(); ++j) {
                const std::size_t replaced = diagonal + (word[i] == candidate[j] ? 0 : 1);
                diagonal = row[j + 1];
                row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
            }
        }
        if (row.back() < best_distance) {
            best_distance = row.back();
            best = candidate;
        }
    }
    return best;
}

}  // namespace fontana
