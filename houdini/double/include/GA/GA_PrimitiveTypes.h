// Of the double, not of the HDK: houdini/double/PROVENANCE.md.
#pragma once

#include "GA/GA_PrimitiveTypeId.h"

// Those that the double has; between them stand the curves, surfaces, quadrics and volumes of the page.
enum { GA_PRIMNONE = 0, GA_PRIMPOLY = 1, GA_PRIMVDB = 23 };
