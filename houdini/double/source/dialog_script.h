// Dialog scripts: the text that describes a panel.
#pragma once

#include <string>
#include <vector>

#include "PRM/PRM_Template.h"

namespace hdk_double {

// The rows of a panel, folders flattened; without the closing template. Throws std::runtime_error with the line.
std::vector<PRM_Template> parse_dialog_script(const std::string& text);

}  // namespace hdk_double
