// Of the double, not of the HDK: houdini/double/PROVENANCE.md.
#pragma once

#include <cstddef>

#include "SYS/SYS_Types.h"

class PRM_Template;

// What a button calls, with the node it is on.
class PRM_Callback {
 public:
    using PRM_Callback64 = int (*)(void* data, int index, fpreal64 time, const PRM_Template* parm);

    PRM_Callback() = default;
    PRM_Callback(std::nullptr_t) {}
    PRM_Callback(PRM_Callback64 function) : function_(function) {}
    bool isNull() const { return !function_; }
    int operator()(void* data, int index, fpreal64 time, const PRM_Template* parm) {
        return function_(data, index, time, parm);
    }

 private:
    PRM_Callback64 function_ = nullptr;
};
