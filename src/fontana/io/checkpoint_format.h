// The records of a checkpoint file; checkpoint.h describes the whole.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include "io/hash64.h"

namespace fontana::checkpoint {

constexpr char magic[8] = {'F', 'O', 'N', 'T', 'A', 'N', 'A', '\0'};
constexpr std::uint32_t endian_mark = 0x01020304;
constexpr std::size_t largest_tag_bytes = std::size_t{1} << 20;
constexpr std::size_t largest_section_count = 1000;
constexpr std::size_t name_room = 32;  // with the closing zero

// No member is padded: every byte of the file is written on purpose and covered by a check.
struct Header {
    char magic[8];
    std::uint32_t format_version;
    std::uint32_t endian_mark;
    std::uint64_t header_hash;  // of header (this member as 0), tag and table
    std::uint64_t file_bytes;
    std::uint32_t section_count;
    std::uint32_t tag_bytes;
};
static_assert(sizeof(Header) == 40 && std::has_unique_object_representations_v<Header>);

struct TableEntry {
    char name[name_room];  // zeros after the name
    std::uint64_t bytes;
    std::uint64_t hash;
};
static_assert(sizeof(TableEntry) == 48 && std::has_unique_object_representations_v<TableEntry>);

struct Footer {
    std::uint64_t file_bytes;
    // Of everything before the footer. In memory of nothing: a host keeps a state each frame, and the hashes of header
    // and sections cover every byte already.
    std::uint64_t content_hash;
};
static_assert(sizeof(Footer) == 16 && std::has_unique_object_representations_v<Footer>);

inline std::uint64_t hash_of_header(Header header, const std::string& tag, const std::vector<TableEntry>& table) {
    header.header_hash = 0;
    Hash64 hash;
    hash.update(&header, sizeof header);
    hash.update(tag.data(), tag.size());
    hash.update(table.data(), table.size() * sizeof(TableEntry));
    return hash.value();
}

}  // namespace fontana::checkpoint
