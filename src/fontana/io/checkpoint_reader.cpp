#include <algorithm>
#include <array>
#include <type_traits>
#include <utility>

#include "io/checkpoint.h"
#include "io/checkpoint_format.h"
#include "io/input_file.h"
#include "util/error.h"

namespace fontana {
namespace {

using checkpoint::Footer;
using checkpoint::Header;
using checkpoint::TableEntry;

template <typename Input>
void check_identity(const Input& file, const Header& header) {
    if (!std::equal(std::begin(checkpoint::magic), std::end(checkpoint::magic), header.magic)) {
        file.damaged("is not a Fontana checkpoint: it does not start with 'FONTANA'");
    }
    if (header.endian_mark != checkpoint::endian_mark) {
        file.damaged("was written by a machine of the other byte order, or is damaged");
    }
    if (header.format_version > checkpoint_format_version) {
        file.damaged("has checkpoint format " + std::to_string(header.format_version) +
                     ", but this Fontana reads up to format " + std::to_string(checkpoint_format_version) +
                     ": use the newer Fontana that wrote it");
    }
    if (header.format_version == 1)
        file.damaged("has checkpoint format 1, and this Fontana reads format " +
                     std::to_string(checkpoint_format_version) + ": use the older Fontana that wrote it, or run anew");
    if (header.format_version == 0) file.damaged("is damaged: there is no checkpoint format 0");
}

// Reads a checkpoint from front to back and checks every byte of it. Input is an InputFile or an InputMemory.
template <typename Input>
class Scanner {
 public:
    explicit Scanner(Input& input) : file_(input) {}

    void read_header() {
        read(&header_, sizeof header_, "the header");
        check_identity(file_, header_);
        if (header_.file_bytes != file_.size()) {
            file_.damaged("is cut short or damaged: it has " + std::to_string(file_.size()) +
                          " bytes, but its header says " + std::to_string(header_.file_bytes));
        }
        file_.require(header_.tag_bytes, 1, "the tag");
        tag_.resize(header_.tag_bytes);
        read(tag_.data(), tag_.size(), "the tag");
        file_.require(header_.section_count, sizeof(TableEntry), "the table of sections");
        table_.resize(header_.section_count);
        read(table_.data(), table_.size() * sizeof(TableEntry), "the table of sections");
        if (hash_of_header(header_, tag_, table_) != header_.header_hash) {
            file_.damaged("is damaged: its header does not have the hash that was written");
        }
    }

    // Calls use(entry, read), where read(data, bytes) delivers the payload in pieces.
    template <typename Use>
    void read_payload(const TableEntry& entry, Use use) {
        const std::string what = "section '" + name_of(entry) + "'";
        file_.require(entry.bytes, 1, what);
        Hash64 hash;
        use([&](void* data, std::size_t bytes) {
            read(data, bytes, what);
            hash.update(data, bytes);
        });
        if (hash.value() != entry.hash)
            file_.damaged("is damaged: " + what + " does not have the hash that was written");
    }

    void read_footer() {
        const std::uint64_t content_hash = content_hash_.value();
        Footer footer = {};
        read(&footer, sizeof footer, "the footer");
        if (footer.file_bytes != header_.file_bytes || footer.content_hash != content_hash || file_.left() != 0) {
            file_.damaged("is damaged: its end does not match its content");
        }
    }

    // Not terminated by zero only in a file made to deceive.
    std::string name_of(const TableEntry& entry) const {
        const auto end = std::find(std::begin(entry.name), std::end(entry.name), '\0');
        if (end == std::end(entry.name)) file_.damaged("is damaged: a section's name has no end");
        return std::string(std::begin(entry.name), end);
    }

    const Input& file() const { return file_; }
    const std::string& tag() const { return tag_; }
    const std::vector<TableEntry>& table() const { return table_; }

 private:
    void read(void* data, std::size_t bytes, const std::string& what) {
        file_.read(data, bytes, what);
        if constexpr (std::is_same_v<Input, InputFile>) content_hash_.update(data, bytes);
    }

    Input& file_;
    Header header_ = {};
    std::string tag_;
    std::vector<TableEntry> table_;
    Hash64 content_hash_;
};

}  // namespace

bool is_valid_checkpoint(const std::string& path) try {
    InputFile file(path);
    Scanner<InputFile> scanner(file);
    scanner.read_header();
    std::vector<std::byte> block(std::min<std::uint64_t>(scanner.file().size(), 1u << 20));
    for (const TableEntry& entry : scanner.table()) {
        scanner.read_payload(entry, [&](auto read) {
            for (std::uint64_t left = entry.bytes; left > 0;) {
                const std::size_t piece = std::min<std::uint64_t>(left, block.size());
                read(block.data(), piece);
                left -= piece;
            }
        });
    }
    scanner.read_footer();
    return true;
} catch (const Error&) {
    return false;
}

template <typename Input>
Checkpoint Checkpoint::read(Input& input) {
    Scanner<Input> scanner(input);
    scanner.read_header();
    Checkpoint checkpoint;
    checkpoint.path_ = scanner.file().path();
    checkpoint.tag_ = scanner.tag();
    for (const TableEntry& entry : scanner.table()) {
        const auto [place, is_first] = checkpoint.sections_.try_emplace(scanner.name_of(entry));
        if (!is_first) scanner.file().damaged("is damaged: it has two sections '" + place->first + "'");
        std::vector<std::byte>& payload = place->second;
        scanner.read_payload(entry, [&](auto read) {
            payload.resize(entry.bytes);
            read(payload.data(), payload.size());
        });
    }
    scanner.read_footer();
    return checkpoint;
}

Checkpoint Checkpoint::load(const std::string& path) {
    InputFile file(path);
    return read(file);
}

Checkpoint Checkpoint::parse(const void* data, std::size_t bytes, const std::string& name) {
    InputMemory memory(data, bytes, name);
    return read(memory);
}

Checkpoint Checkpoint::load_newest(const std::string& path, std::string* note) {
    note->clear();
    try {
        return load(path);
    } catch (const Error& newest_error) {
        try {
            Checkpoint older = load(previous_checkpoint(path));
            *note = std::string(newest_error.what()) + "; continuing from the older checkpoint '" +
                    previous_checkpoint(path) + "'";
            return older;
        } catch (const Error& older_error) {
            fail(newest_error.status(),
                 std::string(newest_error.what()) + "; nor can the older one be used: " + older_error.what());
        }
    }
}

const std::vector<std::byte>& Checkpoint::section(const std::string& name) const {
    const auto found = sections_.find(name);
    if (found == sections_.end()) fail(FONTANA_BAD_INPUT, "checkpoint '" + path_ + "' has no section '" + name + "'");
    return found->second;
}

void Checkpoint::copy_section(const std::string& name, void* out, std::size_t bytes) const {
    const std::vector<std::byte>& payload = section(name);
    if (payload.size() != bytes) {
        fail(FONTANA_BAD_INPUT, "section '" + name + "' of checkpoint '" + path_ + "' has " +
                                    std::to_string(payload.size()) + " bytes where " + std::to_string(bytes) +
                                    " were expected");
    }
    std::copy(payload.begin(), payload.end(), static_cast<std::byte*>(out));
}

}  // namespace fontana
