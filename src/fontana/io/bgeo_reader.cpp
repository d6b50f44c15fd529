#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "io/bgeo.h"
#include "io/bgeo_format.h"
#include "io/input_file.h"

namespace fontana {
namespace {

using bgeo::word_bytes;

std::uint32_t read_word(InputFile& file, const char* what) {
    std::uint32_t word;
    file.read(&word, sizeof word, what);
    return bgeo::big_endian(word);
}

std::uint16_t read_half(InputFile& file, const char* what) {
    std::uint16_t half;
    file.read(&half, sizeof half, what);
    return bgeo::big_endian(half);
}

std::uint32_t read_count(InputFile& file, const std::string& what) {
    const std::uint32_t count = read_word(file, "the header");
    if (count > 0x7fffffffu) file.damaged("is damaged: it gives a negative number of " + what);
    return count;
}

void check_magic(InputFile& file) {
    char magic[sizeof bgeo::magic] = {};
    file.read(magic, std::min<std::uint64_t>(sizeof magic, file.left()), "the magic number");
    const std::string start(magic, sizeof magic);
    if (start == std::string(bgeo::magic, sizeof bgeo::magic)) return;
    if (start.compare(0, 2, "\x1f\x8b") == 0) file.damaged("is compressed with gzip: unpack it first");
    if (start.compare(0, 4, "\x7fNSJ") == 0 || start.compare(0, 1, "[") == 0) {
        file.damaged("is in Houdini's present geometry format: save it as classic geometry (.bhclassic) and rename it");
    }
    file.damaged("is not a classic .bgeo file: it does not start with 'BgeoV'");
}

struct Header {
    std::uint32_t points, point_attributes;
    bool only_points;  // nothing comes after them but the end mark
};

Header read_header(InputFile& file) {
    check_magic(file);
    const std::uint32_t version = read_word(file, "the header");
    if (version != bgeo::version) {
        file.damaged("has version " + std::to_string(version) + " of the .bgeo format, but only version " +
                     std::to_string(bgeo::version) + " is read");
    }
    Header header = {};
    header.points = read_count(file, "points");
    header.only_points = true;
    for (const char* what : {"primitives", "point groups", "primitive groups"}) {
        header.only_points &= read_count(file, what) == 0;
    }
    header.point_attributes = read_count(file, "point attributes");
    for (const char* what : {"vertex attributes", "primitive attributes", "detail attributes"}) {
        header.only_points &= read_count(file, what) == 0;
    }
    return header;
}

// Where the words of the attributes lie in a point's record; nothing where the file has no such attribute.
struct RecordLayout {
    std::array<std::optional<std::size_t>, bgeo::attributes.size()> offsets;
    std::size_t words = bgeo::position_words;
};

void check_type(const InputFile& file, const std::string& name, std::uint32_t type) {
    switch (static_cast<bgeo::Type>(type)) {
        case bgeo::Type::floating:
        case bgeo::Type::integer:
        case bgeo::Type::vector:
            return;
        case bgeo::Type::string:
        case bgeo::Type::indexed_string:
            file.damaged("has a string attribute, '" + name + "', of its points: delete that, it is not read");
    }
    file.damaged("is damaged: the attribute '" + name + "' has the unknown type " + std::to_string(type));
}

void read_attribute(InputFile& file, RecordLayout& layout) {
    const char* const what = "the description of an attribute";
    std::string name(read_half(file, what), '\0');
    file.read(name.data(), name.size(), what);
    const std::uint16_t components = read_half(file, what);
    const std::uint32_t type = read_word(file, what);
    check_type(file, name, type);
    file.skip(components * word_bytes, what);  // the defaults

    for (std::size_t i = 0; i < bgeo::attributes.size(); ++i) {
        const bgeo::Attribute& known = bgeo::attributes[i];
        if (name != known.name) continue;
        if (layout.offsets[i]) file.damaged("is damaged: it has two attributes '" + name + "'");
        if (components != known.components || type != static_cast<std::uint32_t>(known.type)) {
            file.damaged("has an attribute '" + name + "' of type " + std::to_string(type) + " with " +
                         std::to_string(components) + " components; expected are type " +
                         std::to_string(static_cast<std::int32_t>(known.type)) + " and " +
                         std::to_string(known.components));
        }
        layout.offsets[i] = layout.words;
    }
    layout.words += components;
}

RecordLayout read_layout(InputFile& file, std::uint32_t attribute_count) {
    constexpr std::uint64_t least_description_bytes = 8;  // of an attribute with no name and no components
    file.require(attribute_count, least_description_bytes, "the list of attributes");
    RecordLayout layout;
    for (std::uint32_t i = 0; i < attribute_count; ++i) read_attribute(file, layout);
    return layout;
}

struct Column {
    unsigned char* data;
    std::size_t words, offset;
};

template <typename T>
Column make_column(std::vector<T>& array, std::size_t particle_count, std::size_t words, std::size_t offset) {
    array.resize(particle_count * words);
    return {reinterpret_cast<unsigned char*>(array.data()), words, offset};
}

std::vector<Column> make_columns(BgeoParticles& particles, std::size_t particle_count, const RecordLayout& layout) {
    std::vector<Column> columns = {make_column(particles.position, particle_count, 3, 0)};
    auto add = [&](std::size_t attribute, auto& array) {
        if (!layout.offsets[attribute]) return;
        const std::size_t words = bgeo::attributes[attribute].components;
        columns.push_back(make_column(array, particle_count, words, *layout.offsets[attribute]));
    };
    add(0, particles.velocity);  // the order of bgeo::attributes
    add(1, particles.id);
    add(2, particles.density);
    add(3, particles.pressure);
    add(4, particles.pscale);
    add(5, particles.mass);
    return columns;
}

void read_points(InputFile& file, const std::vector<Column>& columns, std::size_t particle_count,
                 std::size_t record_words) {
    const std::size_t record_bytes = record_words * word_bytes;
    const std::size_t block_records = std::max<std::size_t>(1, bgeo::block_bytes / record_bytes);
    std::vector<unsigned char> block(std::min(block_records, particle_count) * record_bytes);
    for (std::size_t first = 0; first < particle_count; first += block_records) {
        const std::size_t count = std::min(block_records, particle_count - first);
        file.read(block.data(), count * record_bytes, "the points");
        for (const Column& column : columns) {
            bgeo::copy_swapped(column.data + first * column.words * word_bytes, column.words,
                               &block[column.offset * word_bytes], record_words, column.words, count);
        }
    }
}

void check_end(InputFile& file) {
    unsigned char mark[sizeof bgeo::end_mark] = {};
    file.read(mark, sizeof mark, "the end mark");
    if (std::memcmp(mark, bgeo::end_mark, sizeof mark) != 0 || file.left() != 0) {
        file.damaged("is damaged: it does not end where its header says");
    }
}

}  // namespace

BgeoParticles read_bgeo(const std::string& path) {
    InputFile file(path);
    const Header header = read_header(file);
    const RecordLayout layout = read_layout(file, header.point_attributes);
    // Holds the count against the file before arrays of that many particles are made.
    file.require(header.points, layout.words * word_bytes, "the points");
    BgeoParticles particles;
    const std::vector<Column> columns = make_columns(particles, header.points, layout);
    read_points(file, columns, header.points, layout.words);
    if (header.only_points) check_end(file);
    return particles;
}

}  // namespace fontana
