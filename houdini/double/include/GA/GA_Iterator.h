// Of the double, not of the HDK: houdini/double/PROVENANCE.md.
#pragma once

#include "GA/GA_ElementGroup.h"
#include "GA/GA_IndexMap.h"

class GA_Range {
 public:
    explicit GA_Range(const GA_IndexMap& map, const GA_ElementGroup* group = nullptr) : map_(&map), group_(group) {}

    // The double's own.
    const GA_IndexMap& map() const { return *map_; }
    const GA_ElementGroup* group() const { return group_; }

 private:
    const GA_IndexMap* map_;
    const GA_ElementGroup* group_;
};

class GA_Iterator {
 public:
    explicit GA_Iterator(const GA_Range& range) : range_(range) { skip_others(); }
    bool atEnd() const { return index_ >= range_.map().indexSize(); }
    GA_Offset operator*() const { return range_.map().offsetFromIndex(index_); }
    GA_Offset getOffset() const { return **this; }
    GA_Iterator& operator++() {
        ++index_;
        skip_others();
        return *this;
    }
    void advance() { ++*this; }
    // The next offsets in one piece of one page: from `start` to before `end`. False at the end.
    bool blockAdvance(GA_Offset& start, GA_Offset& end);

 private:
    void skip_others();

    GA_Range range_;
    GA_Index index_ = 0;
};

#define GA_FOR_ALL_PTOFF(gdp, ptoff) \
    for (GA_Iterator it_((gdp)->getPointRange()); !it_.atEnd() && ((ptoff) = *it_, true); ++it_)
