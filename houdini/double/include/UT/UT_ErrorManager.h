// Of the double, not of the HDK: houdini/double/PROVENANCE.md.
#pragma once

#include <string>
#include <vector>

#include "UT/UT_Error.h"

class UT_ErrorManager {
 public:
    struct Entry {
        UT_ErrorSeverity severity;
        int code;
        std::string text;
    };

    UT_ErrorSeverity getSeverity() const;

    // The double's own: what tests read.
    void clear() { entries_.clear(); }
    void add(UT_ErrorSeverity severity, int code, const char* text);
    const std::vector<Entry>& entries() const { return entries_; }

 private:
    std::vector<Entry> entries_;
};
