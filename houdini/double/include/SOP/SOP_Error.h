// Of the double, not of the HDK: houdini/double/PROVENANCE.md.
#pragma once

#include "OP/OP_Error.h"

enum SOP_ErrorCodes { SOP_ERR_INVALID_SRC = 0, SOP_ERR_FILEGEO, SOP_ERR_BADGROUP, SOP_ERR_BAD_POINTGROUP, SOP_MESSAGE };
