// Of the double, not of the HDK: houdini/double/PROVENANCE.md.
#pragma once

#include "UT/UT_Error.h"
