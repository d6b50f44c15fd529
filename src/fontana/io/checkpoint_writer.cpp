#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <iterator>
#include <utility>

#include "io/atomic_file.h"
#include "io/checkpoint.h"
#include "io/checkpoint_format.h"
#include "io/io_error.h"
#include "util/error.h"

namespace fontana {
namespace {

// Some file systems, and Linux for other people's files, know no hard links.
bool means_no_hard_links(int errno_value) {
    return errno_value == EPERM || errno_value == EOPNOTSUPP || errno_value == ENOSYS || errno_value == EMLINK;
}

// A second name for the file `path`. False if the file system cannot do that.
bool make_link(const std::string& path, std::string& name) {
    for (int attempt = 0; attempt < temporary_name_attempts; ++attempt) {
        name = temporary_name(previous_checkpoint(path), attempt);
        if (link(path.c_str(), name.c_str()) == 0) return true;
        if (means_no_hard_links(errno)) return false;
        if (errno != EEXIST) break;
    }
    fail_io("keep the previous checkpoint of", path, errno);
}

// Makes the file `path` known as `path`.previous as well. The link is made under another name first, because a link
// cannot replace a file and a rename can; so both names show a complete file throughout. Without hard links the file is
// renamed, and `path` is missing until the caller puts the next one there.
void keep_as_previous(const std::string& path) {
    const std::string previous = previous_checkpoint(path);
    std::string link_name;
    const bool linked = make_link(path, link_name);
    const std::string& from = linked ? link_name : path;
    const int result = std::rename(from.c_str(), previous.c_str());
    const int cause = errno;
    // Also after success: rename does nothing if both names are one file already, as they are where a run was killed
    // right after this.
    if (linked) unlink(link_name.c_str());
    if (result == -1) fail_io("keep the previous checkpoint of", path, cause);
}

template <typename Section>
checkpoint::TableEntry table_entry(const Section& section) {
    checkpoint::TableEntry entry = {};
    std::copy(section.name.begin(), section.name.end(), entry.name);
    entry.bytes = section.bytes;
    entry.hash = hash64(section.data, section.bytes);
    return entry;
}

checkpoint::Header make_header(const std::string& tag, const std::vector<checkpoint::TableEntry>& table) {
    checkpoint::Header header = {};
    std::copy(std::begin(checkpoint::magic), std::end(checkpoint::magic), header.magic);
    header.format_version = checkpoint_format_version;
    header.endian_mark = checkpoint::endian_mark;
    header.section_count = static_cast<std::uint32_t>(table.size());
    header.tag_bytes = static_cast<std::uint32_t>(tag.size());
    header.file_bytes =
        sizeof header + tag.size() + table.size() * sizeof(checkpoint::TableEntry) + sizeof(checkpoint::Footer);
    for (const checkpoint::TableEntry& entry : table) header.file_bytes += entry.bytes;
    header.header_hash = hash_of_header(header, tag, table);
    return header;
}

// What AtomicFile is to a file, to memory; but its hash is of nothing, as checkpoint_format.h says.
class MemoryOutput {
 public:
    explicit MemoryOutput(std::vector<std::byte>& out) : out_(out) {}
    void write(const void* data, std::size_t bytes) {
        const auto* first = static_cast<const std::byte*>(data);
        out_.insert(out_.end(), first, first + bytes);
    }
    std::uint64_t hash() const { return Hash64().value(); }

 private:
    std::vector<std::byte>& out_;
};

}  // namespace

std::string previous_checkpoint(const std::string& path) { return path + ".previous"; }

CheckpointWriter::CheckpointWriter(std::string path, std::string tag) : path_(std::move(path)), tag_(std::move(tag)) {
    if (tag_.size() > checkpoint::largest_tag_bytes) {
        fail(FONTANA_BAD_INPUT, "the tag of checkpoint '" + path_ + "' has " + std::to_string(tag_.size()) +
                                    " bytes; at most " + std::to_string(checkpoint::largest_tag_bytes) + " are kept");
    }
}

void CheckpointWriter::section(const std::string& name, const void* data, std::size_t bytes) {
    const bool taken =
        std::any_of(sections_.begin(), sections_.end(), [&](const Section& s) { return s.name == name; });
    const bool usable = !name.empty() && name.size() < checkpoint::name_room && name.find('\0') == std::string::npos;
    if (taken || !usable || sections_.size() == checkpoint::largest_section_count) {
        fail(FONTANA_INTERNAL, "checkpoint section '" + name + "': the name is taken, empty or longer than " +
                                   std::to_string(checkpoint::name_room - 1) + " bytes, or there are too many");
    }
    sections_.push_back({name, data, bytes});
}

template <typename Output>
void CheckpointWriter::write_to(Output& output) const {
    using namespace checkpoint;
    std::vector<TableEntry> table;
    for (const Section& section : sections_) table.push_back(table_entry(section));
    const Header header = make_header(tag_, table);
    output.write(&header, sizeof header);
    output.write(tag_.data(), tag_.size());
    output.write(table.data(), table.size() * sizeof(TableEntry));
    for (const Section& section : sections_) output.write(section.data, section.bytes);
    const Footer footer = {header.file_bytes, output.hash()};
    output.write(&footer, sizeof footer);
}

void CheckpointWriter::append_to(std::vector<std::byte>& out) const {
    std::size_t bytes = out.size() + sections_.size() * sizeof(checkpoint::TableEntry) + 1024;
    for (const Section& section : sections_) bytes += section.bytes;
    out.reserve(bytes);
    MemoryOutput output(out);
    write_to(output);
}

void CheckpointWriter::publish() {
    AtomicFile file(path_);
    write_to(file);
    file.finish();
    if (is_valid_checkpoint(path_)) keep_as_previous(path_);
    file.publish();
}

}  // namespace fontana
