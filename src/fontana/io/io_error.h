// The sentence of a failed system call.
#pragma once

#include <string>

namespace fontana {

// Throws Error(FONTANA_IO_ERROR): "cannot <action> '<path>': <cause of errno_value>".
[[noreturn]] void fail_io(const std::string& action, const std::string& path, int errno_value);

}  // namespace fontana
