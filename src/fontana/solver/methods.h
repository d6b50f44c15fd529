// The pressure methods by name. A new one is a file, a line here and two in method.cpp, a word in parameters.def, and
// its limits in time_step.cpp where they are not those of another.
#pragma once

#include <memory>

#include "solver/method.h"

namespace fontana {

std::unique_ptr<Method> make_mueller(Backend& backend);
std::unique_ptr<Method> make_wcsph(Backend& backend);
std::unique_ptr<Method> make_pcisph(Backend& backend);
std::unique_ptr<Method> make_dfsph(Backend& backend);

}  // namespace fontana
