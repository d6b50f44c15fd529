// Of the double, not of the HDK: houdini/double/PROVENANCE.md.
#pragma once

#include "UT/UT_Vector3.h"

template <typename T>
class UT_BoundingBoxT {
 public:
    UT_BoundingBoxT() = default;
    UT_BoundingBoxT(const UT_Vector3T<T>& low, const UT_Vector3T<T>& high) : low_(low), high_(high) {}
    T xmin() const { return low_.x(); }
    T ymin() const { return low_.y(); }
    T zmin() const { return low_.z(); }
    T xmax() const { return high_.x(); }
    T ymax() const { return high_.y(); }
    T zmax() const { return high_.z(); }

 private:
    UT_Vector3T<T> low_, high_;
};
using UT_BoundingBox = UT_BoundingBoxT<float>;
