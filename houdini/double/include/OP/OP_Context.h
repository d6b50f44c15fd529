// Of the double, not of the HDK: houdini/double/PROVENANCE.md.
#pragma once

#include "CH/CH_Manager.h"

class OP_Context {
 public:
    explicit OP_Context(fpreal time = 0.0) : time_(time) {}
    fpreal getTime() const { return time_; }
    void setTime(fpreal time) { time_ = time; }
    fpreal getFloatFrame() const { return CHgetManager()->getSample(time_); }
    void setFrame(fpreal frame) { time_ = CHgetManager()->time_of_sample(frame); }

 private:
    fpreal time_;
};
