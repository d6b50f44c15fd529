// The node: points in, points out, carried round an axis on a GPU.
#pragma once

#include <memory>

#include <SOP/SOP_Node.h>

#include "swirl_device.h"

class SOP_Swirl : public SOP_Node {
 public:
    static OP_Node* construct(OP_Network* network, const char* name, OP_Operator* entry);
    static PRM_Template* panel();

 protected:
    SOP_Swirl(OP_Network* network, const char* name, OP_Operator* entry);
    OP_ERROR cookMySop(OP_Context& context) override;

 private:
    void move_points(OP_Context& context);
    SwirlSettings settings_at(fpreal time) const;

    // The state: from cook to cook, one a node. Houdini saves none of it with the scene, and need not.
    std::unique_ptr<SwirlDevice> device_;
};
