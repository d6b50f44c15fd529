// The report of a frame.
#pragma once

#include "bindings.h"

namespace fontana_python {

// A copy that owns its text: the library's dt_limit is a pointer.
struct FrameReport {
    fontana_frame_report numbers;
    std::string limit;
};

}  // namespace fontana_python
