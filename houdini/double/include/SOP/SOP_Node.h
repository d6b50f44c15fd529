// Of the double, not of the HDK: houdini/double/PROVENANCE.md.
#pragma once

#include "GU/GU_DetailHandle.h"
#include "OP/OP_Node.h"
#include "SOP/SOP_Error.h"
#include "SYS/SYS_Visibility.h"

class OP_OperatorTable;
class SOP_NodeVerb;
class SOP_NodeCache;

// What Houdini looks for in a plugin.
extern "C" SYS_VISIBILITY_EXPORT void newSopOperator(OP_OperatorTable* table);

class SOP_NodeFlags {
 public:
    void setManagesDataIDs(bool yes) { manages_data_ids_ = yes; }
    bool getManagesDataIDs() const { return manages_data_ids_; }

 private:
    bool manages_data_ids_ = false;
};

class SOP_Node : public OP_Node {
 public:
    SOP_Node(OP_Network* network, const char* name, OP_Operator* entry);
    ~SOP_Node() override;

    SOP_Node* castToSOPNode() override { return this; }
    virtual const SOP_NodeVerb* cookVerb() const { return nullptr; }
    GU_DetailHandle getCookedGeoHandle(OP_Context& context);

    const GU_Detail* inputGeo(OP_InputIdx index, const OP_Context& context) const;
    const GU_Detail* inputGeo(OP_InputIdx index) const;

 protected:
    virtual OP_ERROR cookMySop(OP_Context& context) = 0;
    OP_ERROR cook_me(OP_Context& context) override;
    OP_ERROR cookMyselfAsVerb(OP_Context& context);
    OP_ERROR duplicateSource(OP_InputIdx index, OP_Context& context);

    void addError(int code, const char* text = nullptr) { error_manager().add(UT_ERROR_ABORT, code, text); }
    void addWarning(int code, const char* text = nullptr) { error_manager().add(UT_ERROR_WARNING, code, text); }
    void addMessage(int code, const char* text = nullptr) { error_manager().add(UT_ERROR_MESSAGE, code, text); }

    GU_Detail* gdp;
    SOP_NodeFlags mySopFlags;

 private:
    GU_DetailHandle handle_;
    SOP_NodeCache* cache_ = nullptr;
};
