// Enumerations that a C caller filled.
#pragma once

#include <cstring>

namespace fontana {

// The number in it. C lets it be any int, where C++ may not even look at one that is no enumerator's.
template <typename Enum>
int number_of(const Enum& value) {
    static_assert(sizeof(Enum) == sizeof(int));
    int number;
    std::memcpy(&number, &value, sizeof number);
    return number;
}

}  // namespace fontana
