// Of the double, not of the HDK: houdini/double/PROVENANCE.md.
#pragma once

#include <list>

#include "GA/GA_Detail.h"

// Understands the names of point groups, separated by blanks.
class GOP_Manager {
 public:
    class GroupCreator {
     public:
        explicit GroupCreator(const GA_Detail* detail) : detail_(detail) {}
        const GA_Detail* detail() const { return detail_; }

     private:
        const GA_Detail* detail_;
    };
    // Null where a name is unknown. Groups that were put together live as long as the manager.
    const GA_PointGroup* parsePointGroups(const char* pattern, const GroupCreator& creator, bool numbers_allowed = true,
                                          bool ordered = false, bool strict = false);

 private:
    std::list<GA_PointGroup> made_;
};
