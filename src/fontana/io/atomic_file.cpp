#include "io/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <utility>

#include "io/io_error.h"

namespace fontana {
namespace {

std::string host_name() {
    char name[64] = {};  // long enough to tell machines apart; a cut name is fine
    if (gethostname(name, sizeof name - 1) != 0 || name[0] == '\0') return "localhost";
    std::string host = name;
    std::replace(host.begin(), host.end(), '/', '_');
    return host;
}

std::string folder_of(const std::string& path) {
    const std::size_t slash = path.rfind('/');
    if (slash == std::string::npos) return ".";
    return slash == 0 ? "/" : path.substr(0, slash);
}

// Repeats a call that a signal interrupted before it had done anything.
template <typename Call>
auto uninterrupted(Call call) {
    auto result = call();
    while (result == -1 && errno == EINTR) result = call();
    return result;
}

int sync_content(int descriptor) {
#if defined(__APPLE__)
    // fsync stops at the drive's cache there; not every file system has the full one.
    if (fcntl(descriptor, F_FULLFSYNC) == 0) return 0;
    return uninterrupted([&] { return fsync(descriptor); });
#else
    return uninterrupted([&] { return fdatasync(descriptor); });
#endif
}

}  // namespace

std::string temporary_name(const std::string& path, int attempt) {
    return path + ".tmp." + host_name() + "." + std::to_string(getpid()) + "." + std::to_string(attempt);
}

void sync_folder_of(const std::string& path) {
    const std::string folder = folder_of(path);
    const int descriptor = uninterrupted([&] { return open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC); });
    if (descriptor == -1) {
        if (errno == EACCES) return;  // a folder to write into but not to list: its owner gave up this guarantee
        fail_io("open the folder of", path, errno);
    }
    const int result = uninterrupted([&] { return fsync(descriptor); });
    const int cause = errno;
    close(descriptor);
    // Some network file systems do not sync folders and say so by these two.
    if (result == -1 && cause != EINVAL && cause != ENOTSUP) fail_io("sync the folder of", path, cause);
}

AtomicFile::AtomicFile(std::string path) : path_(std::move(path)) {
    // A name can be taken: by another thread, or left over by a killed process that had the same number.
    for (int attempt = 0; attempt < temporary_name_attempts && descriptor_ == -1; ++attempt) {
        temporary_path_ = temporary_name(path_, attempt);
        descriptor_ =
            uninterrupted([&] { return open(temporary_path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666); });
        if (descriptor_ == -1 && errno != EEXIST) break;
    }
    if (descriptor_ == -1) fail_io("create a file in the folder of", path_, errno);
}

AtomicFile::~AtomicFile() {
    if (descriptor_ != -1) close(descriptor_);
    if (!temporary_path_.empty()) unlink(temporary_path_.c_str());
}

void AtomicFile::write(const void* data, std::size_t bytes) {
    constexpr std::size_t largest_write = std::size_t{1} << 30;  // systems refuse or shorten 2 GiB and more
    const auto* next = static_cast<const char*>(data);
    for (std::size_t left = bytes; left > 0;) {
        const ssize_t written =
            uninterrupted([&] { return ::write(descriptor_, next, std::min(left, largest_write)); });
        if (written == -1) fail_io("write", path_, errno);
        if (written == 0) fail_io("write", path_, EIO);  // no progress and no reason: trying on could last for ever
        next += written;
        left -= static_cast<std::size_t>(written);
    }
    hash_.update(data, bytes);
    bytes_ += bytes;
}

void AtomicFile::finish() {
    if (descriptor_ == -1) return;
    if (sync_content(descriptor_) == -1) fail_io("bring to disk", path_, errno);
    // The descriptor is gone whatever close says. Network storage may report a failed write only here; an interrupted
    // close reports nothing about the content, which is on disk already.
    const int result = close(std::exchange(descriptor_, -1));
    if (result == -1 && errno != EINTR) fail_io("finish writing", path_, errno);
}

void AtomicFile::publish() {
    finish();
    if (std::rename(temporary_path_.c_str(), path_.c_str()) == -1) fail_io("put into place", path_, errno);
    temporary_path_.clear();
    sync_folder_of(path_);
}

}  // namespace fontana
