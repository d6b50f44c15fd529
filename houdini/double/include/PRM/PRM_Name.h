// Of the double, not of the HDK: houdini/double/PROVENANCE.md.
#pragma once

#include "UT/UT_StringHolder.h"

class PRM_Name {
 public:
    PRM_Name(const char* token = nullptr, const char* label = nullptr)
        : is_end_(!token), token_(token), label_(label ? label : token) {}
    void setToken(const char* token) { *this = PRM_Name(token, label_.c_str()); }
    void setLabel(const char* label) { label_ = label; }
    void setTokenAndLabel(const char* token, const char* label) { *this = PRM_Name(token, label); }
    const char* getToken() const { return is_end_ ? nullptr : token_.c_str(); }
    const char* getLabel() const { return is_end_ ? nullptr : label_.c_str(); }

 private:
    bool is_end_;
    UT_StringHolder token_, label_;
};
