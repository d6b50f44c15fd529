#include "io/io_error.h"

#include <cerrno>
#include <system_error>

#include "util/error.h"

namespace fontana {
namespace {

// What to do, for the causes where the system's own words do not say it.
std::string advice(int errno_value) {
    switch (errno_value) {
        case ENOSPC:
            return "; the disk is full: free room there or choose another folder";
        case EDQUOT:
            return "; your disk quota is used up: free room there or choose another folder";
        case EFBIG:
            return "; the file is larger than the limit on file sizes (ulimit -f) or than the file system can hold";
        case EIO:
        case ESTALE:
            return "; the disk or the network storage failed: check it before you rely on files there";
        default:
            return "";
    }
}

}  // namespace

void fail_io(const std::string& action, const std::string& path, int errno_value) {
    fail(FONTANA_IO_ERROR,
         "cannot " + action + " '" + path + "': " + std::generic_category().message(errno_value) + advice(errno_value));
}

}  // namespace fontana
