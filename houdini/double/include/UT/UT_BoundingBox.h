// Of the double, not of the HDK: houdini/double/PROVENANCE.md.
#pragma once

#include "UT/UT_Vector3.h"

class UT_BoundingBox {
 public:
    UT_BoundingBox() = default;
    UT_BoundingBox(const UT_Vector3& low, const UT_Vector3& high) : low_(low), high_(high) {}
    fpreal32 xmin() const { return low_.x(); }
    fpreal32 ymin() const { return low_.y(); }
    fpreal32 zmin() const { return low_.z(); }
    fpreal32 xmax() const { return high_.x(); }
    fpreal32 ymax() const { return high_.y(); }
    fpreal32 zmax() const { return high_.z(); }

 private:
    UT_Vector3 low_, high_;
};
