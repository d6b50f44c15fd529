// Of the double, not of the HDK: houdini/double/PROVENANCE.md.
#pragma once

#include <vector>

#include "OP/OP_Node.h"

class OP_AutoLockInputs {
 public:
    explicit OP_AutoLockInputs(OP_Node* node = nullptr) : node_(node) {}
    ~OP_AutoLockInputs() { unlock(); }
    OP_AutoLockInputs(const OP_AutoLockInputs&) = delete;
    OP_AutoLockInputs& operator=(const OP_AutoLockInputs&) = delete;

    OP_ERROR lock(OP_Context& context);
    OP_ERROR lockInput(exint input, OP_Context& context);
    void unlock();
    void unlockInput(exint input);

 private:
    OP_Node* node_;
    std::vector<exint> locked_;
};
