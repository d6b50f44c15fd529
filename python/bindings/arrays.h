// Arrays of numbers that cross to and from numpy.
#pragma once

#include "bindings.h"

namespace fontana_python {

using FloatArray = nb::ndarray<const float, nb::c_contig, nb::device::cpu>;

template <typename T>
using NumpyArray = nb::ndarray<nb::numpy, T>;

// Not yet filled; one component a row makes it of one dimension.
template <typename T>
NumpyArray<T> make_array(std::size_t rows, std::size_t components) {
    T* data = new T[rows * components];
    nb::capsule owner(data, [](void* p) noexcept { delete[] static_cast<T*>(p); });
    const std::size_t shape[2] = {rows, components};
    return NumpyArray<T>(data, components == 1 ? 1 : 2, shape, owner);
}

}  // namespace fontana_python
