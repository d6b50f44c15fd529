// Checkpoints: named sections of bytes in one file that shows any damage.
//
//   header    "FONTANA\0", format version, endian mark, header hash, bytes of the file, number of sections, bytes of
//             the tag
//   tag       text of the caller's
//   table     per section: name, bytes, hash
//   payloads  of the sections, in the order of the table
//   footer    bytes of the file, hash of everything before the footer
//
// Numbers are as the machine has them in memory, the payloads too: a checkpoint continues a run on the kind of machine
// that wrote it. The endian mark refuses the others.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

namespace fontana {

constexpr std::uint32_t checkpoint_format_version = 2;

// Collects sections and publishes them as `path`, keeping what was there as `path`.previous.
class CheckpointWriter {
 public:
    // `tag` is text given back on load, at most 1 MiB.
    explicit CheckpointWriter(std::string path, std::string tag = "");

    // The data is not copied: it must stay as it is until publish() returns. Names are unique, 1 to 31 bytes long.
    void section(const std::string& name, const void* data, std::size_t bytes);
    template <typename T>
    void section(const std::string& name, const std::vector<T>& values) {
        section(name, values.data(), values.size() * sizeof(T));
    }
    template <typename T>
    void section(const std::string& name, std::vector<T>&& gone_before_publish) = delete;

    // From the end of the first publish on, at every instant a complete valid checkpoint has one of the two names, even
    // if this process is killed. A `path` that is damaged does not replace a good `path`.previous; to know that, the
    // old file is read once. Throws Error(FONTANA_IO_ERROR), also if the checkpoint is in place but perhaps not on
    // disk.
    void publish();
    // The same, appended to `out`: for parse() alone, since the footer has no hash of the content.
    void append_to(std::vector<std::byte>& out) const;

 private:
    template <typename Output>
    void write_to(Output& output) const;

    struct Section {
        std::string name;
        const void* data;
        std::size_t bytes;
    };
    std::string path_;
    std::string tag_;
    std::vector<Section> sections_;
};

class Checkpoint {
 public:
    // Verifies magic, version, lengths and hashes; every length is held against the file before memory of that size is
    // asked for. Throws Error: FONTANA_BAD_INPUT for damage or a newer format, FONTANA_IO_ERROR if unreadable.
    static Checkpoint load(const std::string& path);

    // Of what append_to() made; `name` stands for the path in sentences. Throws Error(FONTANA_BAD_INPUT) for damage.
    static Checkpoint parse(const void* data, std::size_t bytes, const std::string& name);

    // The same, but takes `path`.previous if `path` cannot be used. `*note` is then a sentence for the user that says
    // so and why, else empty.
    static Checkpoint load_newest(const std::string& path, std::string* note);

    const std::string& path() const { return path_; }
    const std::string& tag() const { return tag_; }
    bool has(const std::string& name) const { return sections_.count(name) != 0; }
    // Throws Error(FONTANA_BAD_INPUT) if there is none of that name.
    const std::vector<std::byte>& section(const std::string& name) const;
    // Copies a section of exactly so many bytes; throws Error(FONTANA_BAD_INPUT) if it has another length.
    void copy_section(const std::string& name, void* out, std::size_t bytes) const;

 private:
    template <typename Input>
    static Checkpoint read(Input& input);

    std::string path_;
    std::string tag_;
    std::unordered_map<std::string, std::vector<std::byte>> sections_;
};

// Whether `path` can be loaded, found out in 1 MiB of memory. A file that is missing or unreadable cannot.
bool is_valid_checkpoint(const std::string& path);

// The name of the older generation.
std::string previous_checkpoint(const std::string& path);

}  // namespace fontana
