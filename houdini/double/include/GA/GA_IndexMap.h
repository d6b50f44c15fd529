// Of the double, not of the HDK: houdini/double/PROVENANCE.md.
#pragma once

#include <vector>

#include "GA/GA_Types.h"

class GA_IndexMap {
 public:
    GA_Size indexSize() const { return static_cast<GA_Size>(offsets_.size()); }
    GA_Size offsetSize() const { return static_cast<GA_Size>(indices_.size()); }
    GA_Offset offsetFromIndex(GA_Index index) const { return offsets_[static_cast<std::size_t>(index)]; }
    GA_Index indexFromOffset(GA_Offset offset) const { return indices_[static_cast<std::size_t>(offset)]; }

    // The double's own.
    bool is_active(GA_Offset offset) const {
        return offset >= 0 && offset < offsetSize() && indexFromOffset(offset) >= 0;
    }
    GA_Offset append(GA_Size count);
    void remove(GA_Offset offset);
    void clear();

 private:
    std::vector<GA_Offset> offsets_;  // by index
    std::vector<GA_Index> indices_;   // by offset; -1 in a gap
};
