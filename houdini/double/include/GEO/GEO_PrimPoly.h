// Of the double, not of the HDK: houdini/double/PROVENANCE.md.
#pragma once

#include "GU/GU_Detail.h"
