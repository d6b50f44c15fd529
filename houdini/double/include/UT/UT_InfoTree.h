// Of the double, not of the HDK: houdini/double/PROVENANCE.md.
#pragma once

#include <list>
#include <string>
#include <utility>
#include <vector>

#include "UT/UT_StringHolder.h"

class UT_InfoTree {
 public:
    UT_InfoTree* addChildMap(const UT_StringHolder& name) {
        children_.emplace_back();
        children_.back().name_ = name.toStdString();
        return &children_.back();
    }
    template <typename First, typename Second>
    void addProperties(const First& first, const Second& second) {
        rows_.emplace_back(UT_StringHolder(first).toStdString(), UT_StringHolder(second).toStdString());
    }

    // The double's own: what tests read.
    const std::string& name() const { return name_; }
    const std::list<UT_InfoTree>& children() const { return children_; }
    const std::vector<std::pair<std::string, std::string>>& rows() const { return rows_; }

 private:
    std::string name_;
    std::list<UT_InfoTree> children_;
    std::vector<std::pair<std::string, std::string>> rows_;
};
