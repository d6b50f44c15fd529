// Of the double, not of the HDK: houdini/double/PROVENANCE.md.
#pragma once

#include "GA/GA_PrimitiveTypes.h"
#include "GU/GU_Detail.h"
