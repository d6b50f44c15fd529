// Of the double, not of the HDK: houdini/double/PROVENANCE.md.
#pragma once

#include <array>
#include <limits>

#include "SYS/SYS_Types.h"

template <typename T>
class UT_Vector3T {
 public:
    using value_type = T;
    static constexpr int tuple_size = 3;

    // The real one leaves its members as they are; not-a-number shows where somebody counts on zeros.
    UT_Vector3T() { values_.fill(std::numeric_limits<T>::quiet_NaN()); }
    UT_Vector3T(T x, T y, T z) : values_{x, y, z} {}
    template <typename S>
    UT_Vector3T(const UT_Vector3T<S>& other)
        : values_{static_cast<T>(other(0)), static_cast<T>(other(1)), static_cast<T>(other(2))} {}

    T& x() { return values_[0]; }
    T& y() { return values_[1]; }
    T& z() { return values_[2]; }
    T x() const { return values_[0]; }
    T y() const { return values_[1]; }
    T z() const { return values_[2]; }
    T& operator()(unsigned i) { return values_[i]; }
    T operator()(unsigned i) const { return values_[i]; }
    T* data() { return values_.data(); }
    const T* data() const { return values_.data(); }

    UT_Vector3T& operator+=(const UT_Vector3T& other) {
        for (unsigned i = 0; i < 3; ++i) values_[i] += other.values_[i];
        return *this;
    }
    bool operator==(const UT_Vector3T& other) const { return values_ == other.values_; }
    bool operator!=(const UT_Vector3T& other) const { return values_ != other.values_; }

 private:
    std::array<T, 3> values_;
};
using UT_Vector3F = UT_Vector3T<fpreal32>;
using UT_Vector3D = UT_Vector3T<fpreal64>;
using UT_Vector3 = UT_Vector3F;
