#include "panel.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <sstream>

namespace fontana::houdini {
namespace {

// Tabs by group of the table, named as artists know them; a group that is not here gets a tab of its own name.
const struct {
    const char *group, *label;
} tabs[] = {{"fluid", "Fluid"}, {"forces", "External Forces"}, {"time", "Time"}, {"solver", "Options"}};

// What the node has above the tabs.
const char* const head = R"DS(
    parm { name "reset" label "Reset Simulation" type button
           help "Forgets every frame and simulates anew from the start frame." }
    parm { name "activation" label "Activation" type toggle default { "1" }
           help "Off: the points of the first input pass through." }
    parm { name "start_frame" label "Start Frame" type integer default { "1" } range { 1 100 }
           help "The frame that shows the sources as they are; simulation begins after it." }
    parm { name "source_group" label "Source Group" type string default { "" }
           help "Points of the first input to take as particles; empty: all." }
)DS";

// Goes before the rows of a tab.
const struct {
    const char *group, *text;
} tab_heads[] = {{"time", R"DS(
        parm { name "use_scene_rate" label "Frame Rate of the Scene" type toggle default { "1" }
               help "On: a frame lasts as long as Houdini's. Off: Frame rate below decides." }
)DS"},
                 {"solver", R"DS(
        parm { name "use_gpu" label "Use GPU" type toggle default { "1" }
               help "On: Backend below decides, and auto takes the first GPU. Off: the CPU." }
        parm { name "memory_limit" label "Memory Limit (MiB)" type integer default { "4096" } range { 16! 65536 }
               help "For the frames that scrubbing goes back to. Beyond it every second frame is kept, then every fourth." }
)DS"}};

std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.9g", value);
    return text;
}

std::string quoted(const std::string& text) {
    std::string result = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') result += '\\';
        result += c;
    }
    return result + '"';
}

// "m**2/s**2" as m^2/s^2.
std::string as_written(std::string unit) {
    for (std::size_t at; (at = unit.find("**")) != std::string::npos;) unit.replace(at, 2, "^");
    return unit;
}

std::string capitalised(std::string text) {
    if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
    return text;
}

// The bounds of the table are hard. Where they are far apart the slider ends at a few times the default instead.
std::string range_of(const fontana_parameter& p) {
    const bool is_near = p.maximum <= 100.0, has_minimum = std::isfinite(p.minimum);
    const double end = is_near ? p.maximum : std::max(1.0, 5.0 * p.default_value[0]);
    return "range { " + number(has_minimum ? p.minimum : 0.0) + (has_minimum ? "! " : " ") + number(end) +
           (is_near ? "! }" : " }");
}

std::string value_of(const PanelRow& row) {
    const fontana_parameter& p = row.parameter;
    switch (p.type) {
        case FONTANA_BOOL:
            return "type toggle default { \"" + number(p.default_value[0]) + "\" }";
        case FONTANA_INT:
            return "type integer default { \"" + number(p.default_value[0]) + "\" } " + range_of(p);
        case FONTANA_FLOAT:
            return "type float default { \"" + number(p.default_value[0]) + "\" } " + range_of(p);
        case FONTANA_VECTOR:
            return "type vector size 3 default { \"" + number(p.default_value[0]) + "\" \"" +
                   number(p.default_value[1]) + "\" \"" + number(p.default_value[2]) + "\" }";
        case FONTANA_CHOICE:
            break;
    }
    // By number: the samples of the HDK give the default of a menu so.
    const auto at = std::find(row.choices.begin(), row.choices.end(), p.default_text) - row.choices.begin();
    std::string menu;
    for (const std::string& word : row.choices) menu += quoted(word) + " " + quoted(capitalised(word)) + " ";
    return "type ordinal default { \"" + std::to_string(at) + "\" } menu { " + menu + "}";
}

std::string row_text(const PanelRow& row) {
    const fontana_parameter& p = row.parameter;
    const std::string name = p.name;
    const std::string label = std::string(p.label) + (*p.unit ? " (" + as_written(p.unit) + ")" : "");
    std::string condition;
    if (name == "time.frame_rate") condition = " disablewhen \"{ use_scene_rate == 1 }\"";
    if (name == "solver.backend" || name == "solver.device") condition = " disablewhen \"{ use_gpu == 0 }\"";
    return "        parm { name " + quoted(row.name) + " label " + quoted(label) + " " + value_of(row) + condition +
           "\n               help " + quoted(p.doc) + " }\n";
}

std::string collisions_text() {
    fontana_collider c;
    fontana_collider_defaults(FONTANA_PLANE_Y, &c);
    std::ostringstream text;
    text << R"DS(
    group { name "collisions" label "Implicit Collisions"
        multiparm { name "colliders" label "Colliders" default 0 parmtag { "multistartoffset" "1" }
            parm { name "collider_enable#" label "Enable" type toggle default { ")DS"
         << c.enabled << R"DS(" } }
            parm { name "collider_type#" label "Type" type ordinal default { "1" }
                   menu { "plane_x" "0: Plane X" "plane_y" "1: Plane Y" "plane_z" "2: Plane Z"
                          "sphere_inside" "3: Sphere, inside" "sphere_outside" "4: Sphere, outside"
                          "cylinder_inside" "5: Cylinder, inside" "cylinder_outside" "6: Cylinder, outside" }
                   help "Planes keep the fluid on the positive side. Inside keeps it in, outside keeps it out." }
            parm { name "collider_flip#" label "Flip" type toggle default { ")DS"
         << c.flip << R"DS(" }
                   help "Of a plane: keeps the fluid on the negative side." }
            parm { name "collider_centre#" label "Centre" type vector size 3
                   default { "0" "0" "0" } help "Keyed: the surface moves, and takes the fluid along." }
            parm { name "collider_radius#" label "Radius" type float default { ")DS"
         << number(c.radius) << R"DS(" }
                   range { 0! 10 } help "Of a sphere or cylinder." }
            parm { name "collider_use_cutoff#" label "Use Cutoff" type toggle default { "0" }
                   help "Of a cylinder: its wall ends at a height. Off: it goes on for ever." }
            parm { name "collider_cutoff#" label "Cutoff" type float default { "0" } range { -10 10 }
                   disablewhen "{ collider_use_cutoff# == 0 }" help "Height (y) up to which a cylinder's wall stands." }
            parm { name "collider_thickness#" label "Thickness" type float default { "0" } range { 0! 1 }
                   help "Of the wall of a sphere or cylinder. 0: solid." }
            parm { name "collider_elasticity#" label "Elasticity" type float default { ")DS"
         << number(c.elasticity) << R"DS(" } range { 0! 1! } help "Kept share of the velocity along the normal." }
            parm { name "collider_friction#" label "Friction" type float default { ")DS"
         << number(c.friction) << R"DS(" } range { 0! 1! } help "Lost share of the velocity along the surface." }
        }
    }
)DS";
    return text.str();
}

std::string label_of(const std::string& group) {
    for (const auto& tab : tabs)
        if (group == tab.group) return tab.label;
    return capitalised(group);
}

std::string tab_text(const std::string& group) {
    std::string text = "    group { name \"tab_" + group + "\" label " + quoted(label_of(group)) + "\n";
    for (const auto& tab_head : tab_heads)
        if (group == tab_head.group) text += tab_head.text;
    for (const PanelRow& row : panel_rows())
        if (group == row.parameter.group) text += row_text(row);
    return text + "    }\n";
}

std::vector<std::string> split(const std::string& words) {
    std::istringstream stream(words);
    std::vector<std::string> result;
    for (std::string word; std::getline(stream, word, '|');) result.push_back(word);
    return result;
}

std::vector<PanelRow> make_rows() {
    std::vector<PanelRow> rows(fontana_parameter_count());
    for (std::size_t k = 0; k < rows.size(); ++k) {
        fontana_parameter_info(k, &rows[k].parameter);
        rows[k].name = rows[k].parameter.name;
        std::replace(rows[k].name.begin(), rows[k].name.end(), '.', '_');
        rows[k].choices = split(rows[k].parameter.choices);
    }
    return rows;
}

std::string make_dialog_script() {
    std::string text = std::string("{\n    name parameters") + head;
    std::vector<std::string> done;
    for (const PanelRow& row : panel_rows()) {
        const std::string group = row.parameter.group;
        if (std::find(done.begin(), done.end(), group) != done.end()) continue;
        text += tab_text(group);
        if (group == "forces") text += collisions_text();
        done.push_back(group);
    }
    return text + "}\n";
}

}  // namespace

const std::vector<PanelRow>& panel_rows() {
    static const std::vector<PanelRow> rows = make_rows();
    return rows;
}

const std::string& solver_dialog_script() {
    static const std::string text = make_dialog_script();
    return text;
}

}  // namespace fontana::houdini
