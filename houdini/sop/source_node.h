// fontana::source: points, or the inside of a closed mesh or VDB, as particles for the solver. A verb: it keeps
// nothing.
#pragma once

#include <SOP/SOP_Node.h>

class PRM_Template;

class SOP_FontanaSourceNode final : public SOP_Node {
 public:
    static const char* const type_name;
    static OP_Node* construct(OP_Network* network, const char* name, OP_Operator* entry);
    static PRM_Template* build_templates();
    static const char* dialog_script();

    const SOP_NodeVerb* cookVerb() const override;

 protected:
    SOP_FontanaSourceNode(OP_Network* network, const char* name, OP_Operator* entry);
    OP_ERROR cookMySop(OP_Context& context) override { return cookMyselfAsVerb(context); }
};
