#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "io/atomic_file.h"
#include "io/bgeo.h"
#include "io/bgeo_format.h"
#include "util/error.h"

namespace fontana {
namespace {

using bgeo::word_bytes;

class HeaderBytes {
 public:
    void text(const char* characters, std::size_t length) {
        bytes_.insert(bytes_.end(), characters, characters + length);
    }
    void word(std::uint32_t value) { number(bgeo::big_endian(value)); }
    void half(std::uint16_t value) { number(bgeo::big_endian(value)); }
    const std::vector<char>& bytes() const { return bytes_; }

 private:
    template <typename T>
    void number(T value) {
        char raw[sizeof value];
        std::memcpy(raw, &value, sizeof value);
        text(raw, sizeof value);
    }

    std::vector<char> bytes_;
};

HeaderBytes header(std::uint32_t particle_count) {
    HeaderBytes out;
    out.text(bgeo::magic, sizeof bgeo::magic);
    out.word(bgeo::version);
    out.word(particle_count);
    for (int i = 0; i < 3; ++i) out.word(0);  // primitives, point groups, primitive groups
    out.word(static_cast<std::uint32_t>(bgeo::attributes.size()));
    for (int i = 0; i < 3; ++i) out.word(0);  // vertex, primitive, detail attributes
    for (const bgeo::Attribute& attribute : bgeo::attributes) {
        const std::size_t length = std::strlen(attribute.name);
        out.half(static_cast<std::uint16_t>(length));
        out.text(attribute.name, length);
        out.half(attribute.components);
        out.word(static_cast<std::uint32_t>(attribute.type));
        for (int k = 0; k < attribute.components; ++k) out.word(0);  // 0 is the default of integers and floats alike
    }
    return out;
}

// Where an attribute comes from and where its words lie in a point's record.
struct Column {
    const void* data;
    std::size_t words;
    std::size_t offset;
};

std::array<const void*, bgeo::attributes.size()> arrays_of(const BgeoView& particles) {
    return {particles.velocity, particles.id,     particles.density,
            particles.pressure, particles.pscale, particles.mass};  // the order of bgeo::attributes
}

std::vector<Column> columns_of(const BgeoView& particles) {
    std::vector<Column> columns = {{particles.position, 3, 0}};
    std::size_t offset = bgeo::position_words;
    for (std::size_t i = 0; i < bgeo::attributes.size(); ++i) {
        columns.push_back({arrays_of(particles)[i], bgeo::attributes[i].components, offset});
        offset += bgeo::attributes[i].components;
    }
    return columns;
}

void write_points(AtomicFile& file, const std::vector<Column>& columns, std::size_t particle_count) {
    const std::size_t record_words = columns.back().offset + columns.back().words;
    const std::size_t block_records = bgeo::block_bytes / (record_words * word_bytes);
    std::vector<unsigned char> block(std::min(block_records, particle_count) * record_words * word_bytes);
    const unsigned char one[] = {0x3f, 0x80, 0x00, 0x00};  // 1.0f, P's homogeneous coordinate
    for (std::size_t i = 0; i * record_words * word_bytes < block.size(); ++i) {
        std::memcpy(&block[(i * record_words + 3) * word_bytes], one, sizeof one);
    }
    for (std::size_t first = 0; first < particle_count; first += block_records) {
        const std::size_t count = std::min(block_records, particle_count - first);
        for (const Column& column : columns) {
            const auto* from = static_cast<const unsigned char*>(column.data) + first * column.words * word_bytes;
            bgeo::copy_swapped(&block[column.offset * word_bytes], record_words, from, column.words, column.words,
                               count);
        }
        file.write(block.data(), count * record_words * word_bytes);
    }
}

}  // namespace

std::uint64_t write_bgeo(const std::string& path, const BgeoView& particles) {
    if (particles.particle_count > std::numeric_limits<std::int32_t>::max()) {
        fail(FONTANA_BAD_INPUT, "cannot write '" + path + "': " + std::to_string(particles.particle_count) +
                                    " particles are more than the 2147483647 of a .bgeo file");
    }
    const std::vector<Column> columns = columns_of(particles);
    const bool complete =
        std::all_of(columns.begin(), columns.end(), [](const Column& c) { return c.data != nullptr; });
    if (particles.particle_count > 0 && !complete) {
        fail(FONTANA_BAD_INPUT, "cannot write '" + path + "': an attribute's array is missing");
    }
    AtomicFile file(path);
    const HeaderBytes head = header(static_cast<std::uint32_t>(particles.particle_count));
    file.write(head.bytes().data(), head.bytes().size());
    write_points(file, columns, particles.particle_count);
    file.write(bgeo::end_mark, sizeof bgeo::end_mark);
    file.publish();
    return file.hash();
}

}  // namespace fontana
