// PTX, translated to code of the host.
#pragma once

#include <string>

#include "device.h"

namespace stand_in {

// Runs translate.py and loads what it makes, for the life of the process. Null, and a line on stderr, where the PTX has
// something that the translation does not know.
const KernelCode* load_program(const std::string& ptx);

}  // namespace stand_in
