// Compiled device programs on disk, so that only the first run of a device waits for its compiler.
//
// What is loaded here is code: the folder must belong to the user and be writable by no one else, or it is not used.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace fontana {

class KernelCache {
 public:
    // Opens $XDG_CACHE_HOME/fontana/kernels, or ~/.cache/fontana/kernels, made if need be. The cache is off where
    // FONTANA_KERNEL_CACHE=off, where there is no home, and (said on stderr) where the folder is not safe.
    KernelCache();
    ~KernelCache();
    KernelCache(const KernelCache&) = delete;
    KernelCache& operator=(const KernelCache&) = delete;

    bool is_open() const { return folder_ >= 0; }

    // A name for what is made from `text`; other text, other name.
    static std::string key_of(const std::string& text);

    // The bytes stored under `key`; none where there is no such entry, or a damaged one.
    std::vector<unsigned char> load(const std::string& key) const;
    // Nothing is stored where the cache is off or the disk is full: the next run compiles again.
    void store(const std::string& key, const std::vector<unsigned char>& bytes) const;

    // Keeps a compiler's log for a person to read, in the temporary folder where the cache is off. Returns its path, or
    // "" where it cannot be written.
    std::string save_log(const std::string& key, const std::string& log) const;

 private:
    bool write_file(const std::string& name, const std::vector<unsigned char>& bytes) const;

    std::string path_;
    int folder_ = -1;  // a descriptor: what was checked is what is used, whatever happens to the path
};

}  // namespace fontana
