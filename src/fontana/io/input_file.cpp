#include "io/input_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <utility>

#include "io/io_error.h"
#include "util/error.h"

namespace fontana {
namespace {

template <typename Input>
void require_left(const Input& input, std::uint64_t count, std::uint64_t item_bytes, const std::string& what) {
    if (count == 0 || item_bytes == 0 || count <= input.left() / item_bytes) return;
    input.damaged("is cut short or damaged: " + what + " should have " + std::to_string(count) + " times " +
                  std::to_string(item_bytes) + " bytes, but " + std::to_string(input.left()) + " bytes are left");
}

}  // namespace

InputFile::InputFile(std::string path) : path_(std::move(path)) {
    // O_NONBLOCK: opening a pipe must not wait for its writer; the check below then refuses it.
    do descriptor_ = open(path_.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    while (descriptor_ == -1 && errno == EINTR);
    if (descriptor_ == -1) fail_io("read", path_, errno);
    struct stat status = {};
    if (fstat(descriptor_, &status) == -1 || !S_ISREG(status.st_mode)) {
        close(descriptor_);
        fail(FONTANA_IO_ERROR, "cannot read '" + path_ + "': it is not a regular file");
    }
    size_ = left_ = static_cast<std::uint64_t>(status.st_size);
}

InputFile::~InputFile() { close(descriptor_); }

void InputFile::require(std::uint64_t count, std::uint64_t item_bytes, const std::string& what) const {
    require_left(*this, count, item_bytes, what);
}

void InputFile::read(void* data, std::size_t bytes, const std::string& what) {
    require(bytes, 1, what);
    constexpr std::size_t largest_read = std::size_t{1} << 30;  // systems refuse or shorten 2 GiB and more
    auto* next = static_cast<char*>(data);
    for (std::size_t missing = bytes; missing > 0;) {
        const ssize_t got = ::read(descriptor_, next, std::min(missing, largest_read));
        if (got == -1 && errno == EINTR) continue;
        if (got == -1) fail_io("read", path_, errno);
        if (got == 0) damaged("became shorter while it was read");
        next += got;
        missing -= static_cast<std::size_t>(got);
    }
    left_ -= bytes;
}

void InputFile::skip(std::uint64_t bytes, const std::string& what) {
    require(bytes, 1, what);
    if (lseek(descriptor_, static_cast<off_t>(bytes), SEEK_CUR) == -1) fail_io("read", path_, errno);
    left_ -= bytes;
}

void InputFile::damaged(const std::string& trouble) const { fail(FONTANA_BAD_INPUT, "'" + path_ + "' " + trouble); }

void InputMemory::require(std::uint64_t count, std::uint64_t item_bytes, const std::string& what) const {
    require_left(*this, count, item_bytes, what);
}

void InputMemory::read(void* data, std::size_t bytes, const std::string& what) {
    require(bytes, 1, what);
    std::copy_n(next_, bytes, static_cast<char*>(data));
    next_ += bytes;
    left_ -= bytes;
}

void InputMemory::damaged(const std::string& trouble) const { fail(FONTANA_BAD_INPUT, path_ + " " + trouble); }

}  // namespace fontana
