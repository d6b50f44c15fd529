// Of the double, not of the HDK: houdini/double/PROVENANCE.md.
#pragma once

#include <list>

#include "GA/GA_Detail.h"

class GOP_GroupParse {
 public:
    class ParseInfo;
    class GroupCreator {
     public:
        explicit GroupCreator(const GEO_Detail* detail) : detail_(detail) {}
        const GEO_Detail* getDetail() const { return detail_; }

     private:
        const GEO_Detail* detail_;
    };
};

// Understands the names of point groups, separated by blanks.
class GOP_Manager {
 public:
    using ParseInfo = GOP_GroupParse::ParseInfo;
    using GroupCreator = GOP_GroupParse::GroupCreator;

    // Null where a name is unknown. Groups that were put together live as long as the manager.
    const GA_PointGroup* parsePointGroups(const char* pattern, const GroupCreator& creator, bool numbers_allowed = true,
                                          bool ordered = false, bool strict = false,
                                          GA_Index point_offset = GA_Index(0), ParseInfo* info = nullptr);

 private:
    std::list<GA_PointGroup> made_;
};
