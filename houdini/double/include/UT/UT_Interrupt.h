// Of the double, not of the HDK: houdini/double/PROVENANCE.md.
#pragma once

#include "SYS/SYS_Types.h"

class UT_Interrupt {
 public:
    int opStart(const char* name = nullptr, int npoll = 0, int immediate_dialog = 0, int* opid = nullptr);
    int opInterrupt(int percent = -1);
    void opEnd(int opid = -1);
};
UT_Interrupt* UTgetInterrupt();

class UT_AutoInterrupt {
 public:
    explicit UT_AutoInterrupt(const char* operation_name, UT_Interrupt* boss = UTgetInterrupt());
    ~UT_AutoInterrupt();
    UT_AutoInterrupt(const UT_AutoInterrupt&) = delete;
    UT_AutoInterrupt& operator=(const UT_AutoInterrupt&) = delete;

    bool wasInterrupted() { return boss_->opInterrupt() != 0; }
    bool wasInterrupted(int percent) { return boss_->opInterrupt(percent) != 0; }

 private:
    UT_Interrupt* boss_;
    int id_ = -1;
};
