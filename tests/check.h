// What the tests in C++ say when something does not hold: the place and the expression, and they go on.
#pragma once

#include <atomic>
#include <cstdio>

inline std::atomic<int> failed_checks{0};

#define CHECK(expression)                                                                 \
    do {                                                                                  \
        if (!(expression)) {                                                              \
            std::fprintf(stderr, "%s:%d: failed: %s\n", __FILE__, __LINE__, #expression); \
            ++failed_checks;                                                              \
        }                                                                                 \
    } while (false)
