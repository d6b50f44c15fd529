// The last touch to a sentence before a host sees it.
#pragma once

#include <string>

namespace fontana {

// Sentences quote what callers and files said, which may be anything. The result is one line of valid UTF-8: control
// characters become spaces, bytes that are no UTF-8 question marks, and the middle of an endless text is left out.
std::string one_line(const std::string& text);

}  // namespace fontana
