// Of the double, not of the HDK: houdini/double/PROVENANCE.md.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "PRM/PRM_Callback.h"
#include "PRM/PRM_ChoiceList.h"

// A row of a panel. A list of them ends with one that was made without arguments.
class PRM_Template {
 public:
    enum class Kind { end, number, whole, toggle, ordinal, text, button, multi, ornament };

    PRM_Template() = default;

    // The double's own: what the dialog script said.
    Kind kind = Kind::end;
    std::string name, label, folder, help, disable_when;
    int size = 1;
    std::vector<std::string> defaults;
    std::vector<std::pair<std::string, std::string>> menu;  // token, label
    double minimum = 0.0, maximum = 0.0;
    bool is_minimum_strict = false, is_maximum_strict = false, has_range = false;
    std::vector<PRM_Template> children;  // of a multiparm; their names have a #
    PRM_Callback callback;
    PRM_ChoiceList* choices = nullptr;
};
