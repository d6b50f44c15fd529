// Every row of parameters.def is on the panel, can be keyed, and reaches the solver.
//
// The plugin's calls of fontana_set_number and two others go through the functions below, since a program's own symbols
// come before those of its libraries; they note the value and pass it on.
#include <dlfcn.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>

#include "checks.h"
#include "fontana.h"
#include "scene.h"

namespace {

// What the solver was told last, by name: numbers, or a text.
std::map<std::string, std::vector<double>> numbers;
std::map<std::string, std::string> texts;
// The keys of the collider that had any last: times (s), and three coordinates each.
std::vector<double> key_times, key_centres;
std::mutex noting;  // other groups of checks cook on several threads

template <typename Note>
void note(const Note& write) {
    const std::lock_guard<std::mutex> lock(noting);
    write();
}

}  // namespace

extern "C" fontana_status fontana_set_number(fontana_simulation* simulation, const char* name, const double* values,
                                             size_t count) {
    note([&] { numbers[name].assign(values, values + count); });
    using Function = fontana_status (*)(fontana_simulation*, const char*, const double*, size_t);
    static const auto real = reinterpret_cast<Function>(dlsym(RTLD_NEXT, "fontana_set_number"));
    return real(simulation, name, values, count);
}

extern "C" fontana_status fontana_set_text(fontana_simulation* simulation, const char* name, const char* text) {
    note([&] { texts[name] = text; });
    using Function = fontana_status (*)(fontana_simulation*, const char*, const char*);
    static const auto real = reinterpret_cast<Function>(dlsym(RTLD_NEXT, "fontana_set_text"));
    return real(simulation, name, text);
}

extern "C" fontana_status fontana_set_collider_keys(fontana_simulation* simulation, size_t index, size_t count,
                                                    const double* time, const double* centre) {
    note([&] {
        if (!count) return;
        key_times.assign(time, time + count);
        key_centres.assign(centre, centre + 3 * count);
    });
    using Function = fontana_status (*)(fontana_simulation*, size_t, size_t, const double*, const double*);
    static const auto real = reinterpret_cast<Function>(dlsym(RTLD_NEXT, "fontana_set_collider_keys"));
    return real(simulation, index, count, time, centre);
}

namespace {

std::string panel_name(const fontana_parameter& parameter) {
    std::string name = parameter.name;
    std::replace(name.begin(), name.end(), '.', '_');
    return name;
}

std::vector<std::string> words_of(const fontana_parameter& parameter) {
    std::vector<std::string> words(1);
    for (const char* c = parameter.choices; *c; ++c)
        if (*c == '|')
            words.emplace_back();
        else
            words.back() += *c;
    return words;
}

int default_index(const fontana_parameter& parameter) {
    const std::vector<std::string> words = words_of(parameter);
    return static_cast<int>(std::find(words.begin(), words.end(), parameter.default_text) - words.begin());
}

// Another value than the default, within the bounds; of a choice, its index.
double other_value(const fontana_parameter& p) {
    switch (p.type) {
        case FONTANA_BOOL:
            return 1.0 - p.default_value[0];
        case FONTANA_INT:
            return p.default_value[0] + 2.0;
        case FONTANA_VECTOR:
            return p.default_value[0] + 1.0;
        case FONTANA_CHOICE:
            return default_index(p) == 0 ? 1.0 : 0.0;
        case FONTANA_FLOAT:
            break;
    }
    const double larger = p.default_value[0] == 0.0 ? 0.25 : 1.25 * p.default_value[0];
    return larger <= p.maximum ? larger : 0.5 * p.default_value[0];
}

bool has_reached(const fontana_parameter& p, double value) {
    if (p.type == FONTANA_CHOICE) return texts[p.name] == words_of(p)[static_cast<std::size_t>(value)];
    return std::abs(numbers[p.name].at(0) - value) < 1e-9 * std::max(1.0, std::abs(value));
}

double default_of(const fontana_parameter& p) {
    return p.type == FONTANA_CHOICE ? default_index(p) : p.default_value[0];
}

// A node with nothing but defaults, except that both rows that a switch overrides are on.
SOP_Node& plain_solver(BlockScene& scene) {
    SOP_Node& solver = scene.network.create("fontana::solver::1.0", "plain");
    solver.setInput(0, scene.source);
    set_int(solver, "use_scene_rate", 0);
    return solver;
}

void a_value_reaches_the_solver(const fontana_parameter& p) {
    BlockScene scene(2);
    SOP_Node& solver = plain_solver(scene);
    hdk_double::cook(solver, 1);
    const bool had_default = has_reached(p, default_of(p));
    set_float(solver, panel_name(p).c_str(), other_value(p));
    hdk_double::cook(solver, 1);  // on a device that is not there this fails, after the solver has heard of it
    if (!had_default || !has_reached(p, other_value(p))) std::fprintf(stderr, "%s\n", p.name);
    CHECK(had_default && has_reached(p, other_value(p)));
}

void a_key_reaches_the_solver(const fontana_parameter& p) {
    BlockScene scene(2);
    SOP_Node& solver = plain_solver(scene);
    set_int(solver, "use_gpu", std::string(p.name) == "solver.backend");
    solver.set_key(panel_name(p), 0, hdk_double::time_of(1), default_of(p));
    solver.set_key(panel_name(p), 0, hdk_double::time_of(2), other_value(p));
    hdk_double::cook(solver, 1);
    const bool had_default = has_reached(p, default_of(p));
    hdk_double::cook(solver, 2);
    if (!had_default || !has_reached(p, other_value(p))) std::fprintf(stderr, "%s, keyed\n", p.name);
    CHECK(had_default && has_reached(p, other_value(p)));
}

void every_row_says_what_the_table_says(const SOP_Node& solver, const fontana_parameter& p) {
    const PRM_Template& parm = solver.template_of(panel_name(p));
    CHECK(contains(parm.label, p.label) && parm.help == p.doc && !parm.folder.empty());
    CHECK(parm.menu.size() == (p.type == FONTANA_CHOICE ? words_of(p).size() : 0));
    CHECK(parm.size == (p.type == FONTANA_VECTOR ? 3 : 1));
}

void the_switches() {
    BlockScene scene(2);
    SOP_Node& solver = plain_solver(scene);
    set_int(solver, "solver_backend", 3);
    set_int(solver, "use_gpu", 0);
    set_int(solver, "use_scene_rate", 1);
    hdk_double::cook(solver, 1);
    CHECK(texts["solver.backend"] == "cpu" && numbers["time.frame_rate"].at(0) == 24.0);
    set_int(solver, "use_gpu", 1);
    hdk_double::cook(solver, 1);
    CHECK(texts["solver.backend"] == solver.template_of("solver_backend").menu.at(3).first);
}

// Within a frame a keyed centre moves from where it was at the frame before.
void a_keyed_collider_moves() {
    BlockScene scene(2);
    scene.solver->set_key("collider_centre1", 1, hdk_double::time_of(1), 0.0);
    scene.solver->set_key("collider_centre1", 1, hdk_double::time_of(5), 0.4);
    hdk_double::cook(*scene.solver, 4);
    CHECK(key_times.size() == 2 && key_centres.size() == 6);
    if (key_times.size() != 2) return;
    CHECK(std::abs(key_times[0] - 2.0 / 240.0) < 1e-9 && std::abs(key_times[1] - 3.0 / 240.0) < 1e-9);
    CHECK(std::abs(key_centres[1] - 0.2) < 1e-9 && std::abs(key_centres[4] - 0.3) < 1e-9);
}

void the_panes_of_the_thesis(const SOP_Node& solver) {
    for (const auto& [name, folder] :
         std::vector<std::pair<const char*, const char*>>{{"fluid_viscosity", "Fluid"},
                                                          {"forces_gravity", "External Forces"},
                                                          {"use_gpu", "Options"},
                                                          {"colliders", "Implicit Collisions"}})
        CHECK(solver.template_of(name).folder == folder);
    for (const char* name : {"enable", "type", "centre", "radius", "cutoff", "elasticity", "friction"})
        CHECK(!solver.template_of(std::string("collider_") + name + "3").label.empty());
    CHECK(solver.template_of("collider_type1").menu.size() == 7);
}

void the_device_menu(SOP_Node& solver) {
    set_int(solver, "solver_backend", 1);
    const auto menu = hdk_double::menu_of(solver, "solver_device");
    const fontana_device* devices = nullptr;
    std::size_t count = 0;
    fontana_list_devices(&devices, &count);
    CHECK(count > 0 && menu.size() == 1 && menu[0].first == "0" && menu[0].second == devices[0].name);
}

}  // namespace

void check_panel() {
    BlockScene scene;
    for (std::size_t k = 0; k < fontana_parameter_count(); ++k) {
        fontana_parameter parameter;
        fontana_parameter_info(k, &parameter);
        every_row_says_what_the_table_says(*scene.solver, parameter);
        a_value_reaches_the_solver(parameter);
        a_key_reaches_the_solver(parameter);
    }
    the_switches();
    a_keyed_collider_moves();
    the_panes_of_the_thesis(*scene.solver);
    the_device_menu(*scene.solver);
}
