// Of the double, not of the HDK: houdini/double/PROVENANCE.md.
#pragma once

#include "PRM/PRM_Template.h"
