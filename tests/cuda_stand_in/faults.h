// Makes one call fail: the k-th of a chosen function, with a chosen error code. A test arms it in its own process
// through two exported functions; until then every call passes and is counted.
#pragma once

namespace stand_in {

// The code that this call of `function` must return, or 0.
int fault_of(const char* function);

}  // namespace stand_in
