// Of the double, not of the HDK: houdini/double/PROVENANCE.md.
#pragma once

#include "GA/GA_Iterator.h"
