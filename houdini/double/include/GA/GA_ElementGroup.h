// Of the double, not of the HDK: houdini/double/PROVENANCE.md.
#pragma once

#include <string>
#include <vector>

#include "GA/GA_Types.h"
#include "UT/UT_StringHolder.h"

class GA_ElementGroup {
 public:
    explicit GA_ElementGroup(std::string name) : name_(std::move(name)) {}
    bool containsOffset(GA_Offset offset) const {
        return static_cast<std::size_t>(offset) < members_.size() && members_[static_cast<std::size_t>(offset)];
    }
    void addOffset(GA_Offset offset) {
        if (static_cast<std::size_t>(offset) >= members_.size()) members_.resize(static_cast<std::size_t>(offset) + 1);
        members_[static_cast<std::size_t>(offset)] = true;
    }

    // The double's own.
    void remove(GA_Offset offset) {
        if (containsOffset(offset)) members_[static_cast<std::size_t>(offset)] = false;
    }

 private:
    UT_StringHolder name_;
    std::vector<bool> members_;
};
class GA_PointGroup : public GA_ElementGroup {
 public:
    using GA_ElementGroup::GA_ElementGroup;
};
