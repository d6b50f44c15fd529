// Of the double, not of the HDK: houdini/double/PROVENANCE.md.
#pragma once

#include "SYS/SYS_Types.h"

template <typename T>
class UT_Vector2T {
 public:
    UT_Vector2T() = default;
    UT_Vector2T(T x, T y) : x_(x), y_(y) {}
    T x() const { return x_; }
    T y() const { return y_; }
    bool operator==(const UT_Vector2T& other) const { return x_ == other.x_ && y_ == other.y_; }
    bool operator!=(const UT_Vector2T& other) const { return !(*this == other); }

 private:
    T x_{}, y_{};
};
using UT_Vector2D = UT_Vector2T<fpreal64>;
