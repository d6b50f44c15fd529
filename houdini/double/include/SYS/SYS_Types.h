// Of the double, not of the HDK: houdini/double/PROVENANCE.md.
#pragma once

#include <cstddef>
#include <cstdint>

using int32 = std::int32_t;
using int64 = std::int64_t;
using exint = std::int64_t;
using fpreal32 = float;
using fpreal64 = double;
using fpreal = double;
