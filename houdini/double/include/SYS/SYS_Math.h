// Of the double, not of the HDK: houdini/double/PROVENANCE.md.
#pragma once

#include <cmath>

#include "SYS/SYS_Types.h"

template <typename T>
T SYSsin(T angle) {
    return std::sin(angle);
}
template <typename T>
T SYScos(T angle) {
    return std::cos(angle);
}
template <typename T>
T SYSrint(T value) {
    return std::rint(value);
}
