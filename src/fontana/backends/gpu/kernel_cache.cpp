#include "backends/gpu/kernel_cache.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cinttypes>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "io/hash64.h"
#include "util/error.h"

namespace fontana {
namespace {

constexpr std::size_t k_largest_entry = 256u << 20;  // bytes

// What a file of the cache begins with. The checksum matters: a driver handed damaged machine code may crash.
struct EntryHeader {
    char magic[8];
    std::uint64_t bytes;
    std::uint64_t checksum;
};
constexpr char k_entry_magic[8] = {'F', 'O', 'N', 'T', 'K', 'R', 'N', '1'};

class Descriptor {
 public:
    explicit Descriptor(int value) : value_(value) {}
    ~Descriptor() {
        if (value_ >= 0) close(value_);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    int get() const { return value_; }
    bool is_open() const { return value_ >= 0; }

 private:
    int value_;
};

std::string environment(const char* name) {
    const char* value = std::getenv(name);
    return value ? value : "";
}

bool is_switched_off() {
    const std::string value = environment("FONTANA_KERNEL_CACHE");
    if (value.empty() || value == "on") return false;
    if (value == "off") return true;
    fail(FONTANA_BAD_INPUT, "the environment variable FONTANA_KERNEL_CACHE is '" + value + "': expected on or off");
}

// "" without a home. The XDG rules have relative paths ignored.
std::string cache_base() {
    const std::string chosen = environment("XDG_CACHE_HOME");
    if (!chosen.empty() && chosen.front() == '/') return chosen;
    const std::string home = environment("HOME");
    return home.empty() || home.front() != '/' ? "" : home + "/.cache";
}

// Why the folder must not be used, or "".
std::string why_unsafe(int folder) {
    struct stat status;
    if (fstat(folder, &status) != 0) return "its owner is not known";
    if (status.st_uid != geteuid()) return "it belongs to another user";
    if ((status.st_mode & (S_IWGRP | S_IWOTH)) != 0) return "others may write to it";
    return "";
}

void warn_unused(const std::string& path, const std::string& reason) {
    std::fprintf(stderr,
                 "fontana: the kernel cache %s is not used, because %s; remove it, or chmod 700 it, or set "
                 "FONTANA_KERNEL_CACHE=off\n",
                 path.c_str(), reason.c_str());
}

std::vector<unsigned char> read_entry(int file) {
    struct stat status;
    EntryHeader header;
    if (fstat(file, &status) != 0 || !S_ISREG(status.st_mode) || status.st_uid != geteuid()) return {};
    if (read(file, &header, sizeof header) != static_cast<ssize_t>(sizeof header)) return {};
    if (std::memcmp(header.magic, k_entry_magic, sizeof k_entry_magic) != 0 || header.bytes > k_largest_entry)
        return {};
    std::vector<unsigned char> bytes(header.bytes);
    std::size_t done = 0;
    while (done < bytes.size()) {
        const ssize_t count = read(file, bytes.data() + done, bytes.size() - done);
        if (count <= 0) return {};
        done += static_cast<std::size_t>(count);
    }
    if (hash64(bytes.data(), bytes.size()) != header.checksum) return {};
    return bytes;
}

bool write_all(int file, const std::vector<unsigned char>& bytes) {
    std::size_t done = 0;
    while (done < bytes.size()) {
        const ssize_t count = write(file, bytes.data() + done, bytes.size() - done);
        if (count <= 0) return false;
        done += static_cast<std::size_t>(count);
    }
    return true;
}

std::string save_temporary_log(const std::string& log) {
    std::error_code error;
    std::string path = (std::filesystem::temp_directory_path(error) / "fontana-build-log-XXXXXX").string();
    const Descriptor file(error ? -1 : mkstemp(path.data()));
    if (!file.is_open()) return "";
    return write_all(file.get(), {log.begin(), log.end()}) ? path : "";
}

}  // namespace

KernelCache::KernelCache() {
    if (is_switched_off() || cache_base().empty()) return;
    const std::string parent = cache_base() + "/fontana";
    std::error_code error;
    std::filesystem::create_directories(cache_base(), error);
    path_ = parent + "/kernels";
    mkdir(parent.c_str(), 0700);
    mkdir(path_.c_str(), 0700);
    folder_ = open(path_.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    if (folder_ < 0) {
        if (std::filesystem::is_symlink(path_, error)) warn_unused(path_, "it is a symbolic link");
        return;
    }
    const std::string reason = why_unsafe(folder_);
    if (reason.empty()) return;
    warn_unused(path_, reason);
    close(folder_);
    folder_ = -1;
}

KernelCache::~KernelCache() {
    if (folder_ >= 0) close(folder_);
}

// Two hashes, of the text after different first bytes: over many users and years 64 bits alone might give two programs
// one name. A cache of one's own programs needs no defence against forged keys, which a cryptographic hash would give.
std::string KernelCache::key_of(const std::string& text) {
    std::string key;
    for (const char* first_byte : {"a", "b"}) {
        Hash64 hash;
        hash.update(first_byte, 1);
        hash.update(text.data(), text.size());
        char digits[17];
        std::snprintf(digits, sizeof digits, "%016" PRIx64, hash.value());
        key += digits;
    }
    return key;
}

std::vector<unsigned char> KernelCache::load(const std::string& key) const {
    if (!is_open()) return {};
    const Descriptor file(openat(folder_, (key + ".bin").c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC));
    return file.is_open() ? read_entry(file.get()) : std::vector<unsigned char>();
}

void KernelCache::store(const std::string& key, const std::vector<unsigned char>& bytes) const {
    EntryHeader header;
    std::memcpy(header.magic, k_entry_magic, sizeof k_entry_magic);
    header.bytes = bytes.size();
    header.checksum = hash64(bytes.data(), bytes.size());
    std::vector<unsigned char> content(sizeof header + bytes.size());
    std::memcpy(content.data(), &header, sizeof header);
    if (!bytes.empty()) std::memcpy(content.data() + sizeof header, bytes.data(), bytes.size());
    write_file(key + ".bin", content);
}

std::string KernelCache::save_log(const std::string& key, const std::string& log) const {
    const std::string name = key + ".log";
    return write_file(name, {log.begin(), log.end()}) ? path_ + "/" + name : save_temporary_log(log);
}

// Whole or not at all: another run may be reading or writing the same name.
bool KernelCache::write_file(const std::string& name, const std::vector<unsigned char>& bytes) const {
    if (!is_open()) return false;
    const std::string draft = name + "." + std::to_string(getpid()) + ".draft";
    const Descriptor file(openat(folder_, draft.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_NOFOLLOW | O_CLOEXEC, 0600));
    if (!file.is_open()) return false;
    if (write_all(file.get(), bytes) && renameat(folder_, draft.c_str(), folder_, name.c_str()) == 0) return true;
    unlinkat(folder_, draft.c_str(), 0);
    return false;
}

}  // namespace fontana
