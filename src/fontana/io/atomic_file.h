// A file that appears under its name only when it is complete and on disk.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "io/hash64.h"

namespace fontana {

// Writes to `path`.tmp.<host>.<pid>.<n> in the folder of `path` and renames it into place, so that whoever opens `path`
// finds the old content or the new, never a part, whenever this process or the machine stops. The plain calls of POSIX
// and not std::ofstream: that one neither syncs nor says why a write failed, and its destructor hides a full disk.
//
// A symbolic link at `path` is replaced itself; what it points to stays. The folder must exist.
// Every function throws Error(FONTANA_IO_ERROR) with the path and the cause.
class AtomicFile {
 public:
    explicit AtomicFile(std::string path);
    ~AtomicFile();  // removes the temporary file unless it was published
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    void write(const void* data, std::size_t bytes);

    // Syncs the content to disk and closes it; nothing can be written after. For a caller that has to act between this
    // and publish(); otherwise publish() does it.
    void finish();
    void publish();

    const std::string& path() const { return path_; }
    std::uint64_t bytes() const { return bytes_; }
    std::uint64_t hash() const { return hash_.value(); }  // of everything written so far

 private:
    std::string path_;
    std::string temporary_path_;  // empty once it exists no more
    int descriptor_ = -1;         // -1 once closed
    std::uint64_t bytes_ = 0;
    Hash64 hash_;
};

// A free name beside `path` for a file or link that lives until it is renamed: `path`.tmp.<host>.<pid>.<attempt>.
std::string temporary_name(const std::string& path, int attempt);
// How many attempts to make at a name that is not taken.
constexpr int temporary_name_attempts = 1000;

// Brings renames in the folder of `path` to disk.
void sync_folder_of(const std::string& path);

}  // namespace fontana
