// Points between a detail and plain arrays, a page at a time. Offsets have gaps where points were deleted, so nothing
// here goes by index.
#pragma once

#include <GA/GA_Handle.h>
#include <GA/GA_Iterator.h>
#include <GOP/GOP_Manager.h>
#include <GU/GU_Detail.h>

#include <string>
#include <vector>

#include "frame_host.h"

namespace fontana::houdini {

// The point attribute (integer) that a source sets to 1 where a point is to be emitted at every frame.
constexpr const char* continuous_attribute = "continuous";

// The points of a group's pattern, all where it is empty. The range lives as long as this. Throws std::runtime_error
// where the group is not known.
class PointGroup {
 public:
    PointGroup(const GU_Detail& detail, const std::string& pattern);
    GA_Range range() const { return detail_.getPointRange(members_); }

 private:
    const GU_Detail& detail_;
    GOP_Manager groups_;  // owns what it parses
    const GA_PointGroup* members_ = nullptr;
};

// The points of `group` with v and mass where there are any. Throws as PointGroup does.
SourcePoints read_points(const GU_Detail& detail, const std::string& group, PointsWanted wanted);

// Copies `values` (one a point, in order of index) to the attribute of every point.
template <typename Handle, typename Value>
void write_by_page(const GU_Detail& detail, const Handle& handle, const Value* values) {
    GA_Offset start, end;
    for (GA_Iterator it(detail.getPointRange()); it.blockAdvance(start, end);) {
        handle.setBlock(start, end - start, values);
        values += end - start;
    }
    handle.bumpDataId();
}

}  // namespace fontana::houdini
