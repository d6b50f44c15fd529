#include "backends/gpu/failed_build.h"

#include <sstream>

#include "util/error.h"

namespace fontana {
namespace {

constexpr int k_shown_log_lines = 4;

// Errors are one line; the compiler's first complaints are the ones that matter.
std::string first_lines(const std::string& log) {
    std::istringstream lines(log);
    std::string shown, line;
    for (int count = 0; count < k_shown_log_lines && std::getline(lines, line); ++count)
        shown += (shown.empty() ? "" : " | ") + line;
    return shown;
}

}  // namespace

void fail_to_build(const std::string& device, const std::string& log, const KernelCache& cache,
                   const std::string& key) {
    const std::string path = cache.save_log(key, log);
    fail(FONTANA_DEVICE_UNAVAILABLE,
         "the kernels do not compile for " + device +
             (path.empty() ? "; its compiler says: " : "; the whole log is in " + path + " and begins: ") +
             first_lines(log));
}

}  // namespace fontana
