// Of the double, not of the HDK: houdini/double/PROVENANCE.md.
#pragma once

#include "DEP/DEP_MicroNode.h"
#include "OP/OP_Parameters.h"
#include "UT/UT_Vector2.h"
#include "UT/UT_Vector3.h"

// Reads the parameters of a node for a *.proto.h.
class OP_GraphProxy {
 public:
    explicit OP_GraphProxy(const OP_Parameters& parameters) : parameters_(&parameters) {}
    void evalOpParm(int64& value, exint node, const char* name, fpreal time, DEP_MicroNode* dependency) const;
    void evalOpParm(bool& value, exint node, const char* name, fpreal time, DEP_MicroNode* dependency) const;
    void evalOpParm(fpreal64& value, exint node, const char* name, fpreal time, DEP_MicroNode* dependency) const;
    void evalOpParm(UT_Vector2D& value, exint node, const char* name, fpreal time, DEP_MicroNode* dependency) const;
    void evalOpParm(UT_Vector3D& value, exint node, const char* name, fpreal time, DEP_MicroNode* dependency) const;
    void evalOpParm(UT_StringHolder& value, exint node, const char* name, fpreal time, DEP_MicroNode* dependency) const;

 private:
    const OP_Parameters* parameters_;
};
