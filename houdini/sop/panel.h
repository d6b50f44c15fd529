// The solver's panel, made from the library's table of parameters. A default stands in parameters.def or, for a
// collider, in the library; none stands here. What this panel adds is the node's own: reset, start frame, memory.
#pragma once

#include <string>
#include <vector>

#include "fontana.h"

namespace fontana::houdini {

// A row of the table and what its parameter is called here: "fluid.viscosity" is "fluid_viscosity".
struct PanelRow {
    fontana_parameter parameter;
    std::string name;
    std::vector<std::string> choices;
};

const std::vector<PanelRow>& panel_rows();
// The whole panel as a dialog script.
const std::string& solver_dialog_script();

}  // namespace fontana::houdini
