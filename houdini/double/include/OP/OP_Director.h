// Of the double, not of the HDK: houdini/double/PROVENANCE.md.
#pragma once

#include "CH/CH_Manager.h"
#include "OP/OP_Node.h"

class OP_Director {
 public:
    CH_Manager* getChannelManager() { return CHgetManager(); }
};
OP_Director* OPgetDirector();
