// A file read from its beginning to its end by a reader that trusts nothing it finds there.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

namespace fontana {

// Knows how many bytes are left, so that a count in the file can be held against them before anything of its size is
// allocated. Throws Error(FONTANA_IO_ERROR) if the file cannot be read, Error(FONTANA_BAD_INPUT) if it is damaged.
class InputFile {
 public:
    explicit InputFile(std::string path);
    ~InputFile();
    InputFile(const InputFile&) = delete;
    InputFile& operator=(const InputFile&) = delete;

    const std::string& path() const { return path_; }
    std::uint64_t size() const { return size_; }
    std::uint64_t left() const { return left_; }

    // Fails unless `count` items of `item_bytes` are left. Divides, so that no product can overflow.
    void require(std::uint64_t count, std::uint64_t item_bytes, const std::string& what) const;
    void read(void* data, std::size_t bytes, const std::string& what);
    void skip(std::uint64_t bytes, const std::string& what);

    // Throws Error(FONTANA_BAD_INPUT): "'<path>' <trouble>".
    [[noreturn]] void damaged(const std::string& trouble) const;

 private:
    std::string path_;
    int descriptor_ = -1;
    std::uint64_t size_ = 0;
    std::uint64_t left_ = 0;
};

// The same of bytes in memory; `name` stands for the path in sentences.
class InputMemory {
 public:
    InputMemory(const void* data, std::size_t bytes, std::string name)
        : path_(std::move(name)), next_(static_cast<const char*>(data)), size_(bytes), left_(bytes) {}

    const std::string& path() const { return path_; }
    std::uint64_t size() const { return size_; }
    std::uint64_t left() const { return left_; }
    void require(std::uint64_t count, std::uint64_t item_bytes, const std::string& what) const;
    void read(void* data, std::size_t bytes, const std::string& what);
    [[noreturn]] void damaged(const std::string& trouble) const;

 private:
    std::string path_;
    const char* next_;
    std::uint64_t size_, left_;
};

}  // namespace fontana
