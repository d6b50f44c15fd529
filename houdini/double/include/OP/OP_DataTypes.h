// Of the double, not of the HDK: houdini/double/PROVENANCE.md.
#pragma once

#include "SYS/SYS_Version.h"

#if SYS_VERSION_MAJOR_INT >= 21
using OP_InputIdx = int;
using OP_OutputIdx = int;
#endif
