// Of the double, not of the HDK: houdini/double/PROVENANCE.md.
#pragma once

#include "OP/OP_Error.h"

enum SOP_ErrorCodes { SOP_MESSAGE = 1, SOP_ERR_INVALID_SRC, SOP_ERR_BADGROUP };
