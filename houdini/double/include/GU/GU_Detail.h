// Of the double, not of the HDK: houdini/double/PROVENANCE.md.
#pragma once

#include "GA/GA_Detail.h"
#include "GA/GA_Handle.h"

class GU_Detail : public GA_Detail {};
