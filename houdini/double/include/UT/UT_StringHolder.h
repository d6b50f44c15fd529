// Of the double, not of the HDK: houdini/double/PROVENANCE.md.
#pragma once

#include <string>
#include <utility>

#include "SYS/SYS_Types.h"

// The real classes share and borrow memory; this one copies.
class UT_StringHolder {
 public:
    UT_StringHolder() = default;
    UT_StringHolder(const char* text) : text_(text ? text : "") {}
    UT_StringHolder(std::string text) : text_(std::move(text)) {}

    const char* c_str() const { return text_.c_str(); }
    const char* buffer() const { return text_.c_str(); }
    operator const char*() const { return text_.c_str(); }
    std::string toStdString() const { return text_; }
    bool operator==(const UT_StringHolder& other) const { return text_ == other.text_; }
    bool operator!=(const UT_StringHolder& other) const { return text_ != other.text_; }
    bool operator<(const UT_StringHolder& other) const { return text_ < other.text_; }

 private:
    std::string text_;
};
using UT_StringRef = UT_StringHolder;
using UT_String = UT_StringHolder;

namespace UT {
namespace Literal {
inline UT_StringHolder operator""_sh(const char* text, std::size_t length) { return std::string(text, length); }
}  // namespace Literal
}  // namespace UT
using namespace UT::Literal;
