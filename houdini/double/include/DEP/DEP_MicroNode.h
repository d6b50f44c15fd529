// Of the double, not of the HDK: houdini/double/PROVENANCE.md.
#pragma once

class DEP_MicroNode {
 public:
    void setTimeDependent(bool yes) { is_time_dependent_ = yes; }
    bool isTimeDependent() const { return is_time_dependent_; }

 private:
    bool is_time_dependent_ = false;
};
