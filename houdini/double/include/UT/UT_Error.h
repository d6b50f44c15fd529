// Of the double, not of the HDK: houdini/double/PROVENANCE.md.
#pragma once

#include <string>
#include <vector>

enum UT_ErrorSeverity {
    UT_ERROR_NONE = 0,
    UT_ERROR_MESSAGE = 1,
    UT_ERROR_WARNING = 2,
    UT_ERROR_ABORT = 3,
    UT_ERROR_FATAL = 4
};
class UT_SourceLocation;

class UT_ErrorManager {
 public:
    struct Entry {
        UT_ErrorSeverity severity;
        int code;
        std::string text;
    };

    void clearAndDestroyErrors() { entries_.clear(); }
    UT_ErrorSeverity getSeverity() const;
    // The double's own: what tests read.
    void add(UT_ErrorSeverity severity, int code, const char* text);
    const std::vector<Entry>& entries() const { return entries_; }

 private:
    std::vector<Entry> entries_;
};
