#include "faults.h"

#include <mutex>
#include <string>

namespace stand_in {
namespace {

std::mutex mutex;
std::string armed_function;
long armed_call, call_count;
int armed_code;

}  // namespace

int fault_of(const char* function) {
    const std::lock_guard<std::mutex> lock(mutex);
    return function == armed_function && ++call_count == armed_call ? armed_code : 0;
}

}  // namespace stand_in

#define EXPORTED extern "C" __attribute__((visibility("default")))

// From now on call number `call` (1 is the next, 0 none) of `function` returns `code`, and its calls are counted.
EXPORTED void arm_fault(const char* function, long call, int code) {
    const std::lock_guard<std::mutex> lock(stand_in::mutex);
    stand_in::armed_function = function;
    stand_in::armed_call = call;
    stand_in::armed_code = code;
    stand_in::call_count = 0;
}

EXPORTED long count_calls() {
    const std::lock_guard<std::mutex> lock(stand_in::mutex);
    return stand_in::call_count;
}
