// Checkpoints: what is read back, what is refused, and the two generations.
#include "io/checkpoint.h"

#include <unistd.h>

#include <cstdint>
#include <cstring>

#include "checks.h"
#include "io/checkpoint_format.h"

using fontana::Checkpoint;
using fontana::CheckpointWriter;
using fontana::is_valid_checkpoint;
using fontana::previous_checkpoint;
namespace format = fontana::checkpoint;

void write_sample_checkpoint(const std::string& path, int number) {
    const std::vector<float> position(900, static_cast<float>(number));
    const std::vector<int> id(100, number);
    CheckpointWriter writer(path, "generation " + std::to_string(number));
    writer.section("frame", &number, sizeof number);
    writer.section("position", position);
    writer.section("id", id);
    writer.section("nothing", nullptr, 0);
    writer.publish();
}

namespace {

int generation(const std::string& path) {
    int number = 0;
    Checkpoint::load(path).copy_section("frame", &number, sizeof number);
    return number;
}

void check_round_trip(const std::string& path) {
    write_sample_checkpoint(path, 7);
    CHECK(is_valid_checkpoint(path));
    const Checkpoint checkpoint = Checkpoint::load(path);
    CHECK(checkpoint.tag() == "generation 7");
    CHECK(generation(path) == 7);
    std::vector<float> position(900);
    checkpoint.copy_section("position", position.data(), position.size() * sizeof(float));
    CHECK(position == std::vector<float>(900, 7.0f));
    CHECK(checkpoint.section("nothing").empty());
    CHECK(checkpoint.has("nothing") && !checkpoint.has("velocity"));
    CHECK(contains(sentence_of(FONTANA_BAD_INPUT, [&] { checkpoint.section("velocity"); }), "no section 'velocity'"));
    CHECK(contains(sentence_of(FONTANA_BAD_INPUT, [&] { checkpoint.copy_section("id", position.data(), 1); }),
                   "has 400 bytes where 1 "));
}

std::string refusal(const std::string& path, const Bytes& bytes) {
    write_bytes(path, bytes);
    CHECK(!is_valid_checkpoint(path));
    largest_allocation = 0;
    const std::string sentence = sentence_of(FONTANA_BAD_INPUT, [&] { Checkpoint::load(path); });
    CHECK(largest_allocation < 100000);
    CHECK(contains(sentence, path));
    return sentence;
}

void check_damage(const std::string& path, const Bytes& good) {
    for (std::size_t i = 0; i < good.size(); ++i) {
        for (unsigned difference : {0x01u, 0x80u, 0xffu}) {
            Bytes damaged = good;
            damaged[i] = static_cast<unsigned char>(damaged[i] ^ difference);
            refusal(path, damaged);
        }
    }
    for (std::size_t i : {sizeof(format::Header), sizeof(format::Header) + 13}) {  // in the tag, in the table
        Bytes damaged = good;
        damaged[i] ^= 1;
        CHECK(contains(refusal(path, damaged), "its header does not have the hash"));
    }
    for (std::size_t length = 0; length < good.size(); ++length) {
        refusal(path, Bytes(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(length)));
    }
    Bytes longer = good;
    longer.push_back(0);
    refusal(path, longer);
}

// Changes header or table of a good file with `change(header, table)` and sets the header's hash right again, as damage
// never would.
template <typename Change>
Bytes forged(const Bytes& good, Change change) {
    format::Header header;
    std::memcpy(&header, good.data(), sizeof header);
    const std::size_t table_start = sizeof header + header.tag_bytes;
    const std::string tag(good.begin() + sizeof header, good.begin() + static_cast<std::ptrdiff_t>(table_start));
    std::vector<format::TableEntry> table(header.section_count);
    std::memcpy(table.data(), &good[table_start], table.size() * sizeof(format::TableEntry));
    change(header, table);
    header.header_hash = format::hash_of_header(header, tag, table);
    Bytes bytes = good;
    std::memcpy(bytes.data(), &header, sizeof header);
    std::memcpy(&bytes[table_start], table.data(), table.size() * sizeof(format::TableEntry));
    return bytes;
}

void check_forgeries(const std::string& path, const Bytes& good) {
    using Table = std::vector<format::TableEntry>;
    auto refused = [&](auto change) { return refusal(path, forged(good, change)); };
    CHECK(contains(refused([](auto& header, Table&) { header.format_version = 3; }), "format 3, but"));
    CHECK(contains(refused([](auto& header, Table&) { header.format_version = 3; }), "up to format 2"));
    CHECK(contains(refused([](auto& header, Table&) { header.format_version = 1; }), "the older Fontana"));
    CHECK(contains(refused([](auto& header, Table&) { header.format_version = 0; }), "no checkpoint format 0"));
    CHECK(contains(refused([](auto& header, Table&) { header.endian_mark = 0x04030201; }), "byte order"));
    CHECK(contains(refused([](auto& header, Table&) { header.section_count = 0xffffffff; }), "the table"));
    CHECK(contains(refused([](auto& header, Table&) { header.tag_bytes = 0xffffffff; }), "the tag"));
    CHECK(contains(refused([](auto& header, Table&) { header.section_count -= 1; }), "hash"));
    for (std::uint64_t huge : {std::uint64_t{1} << 62, ~std::uint64_t{0}}) {
        CHECK(contains(refused([&](auto&, Table& table) { table[1].bytes = huge; }), "'position' should have"));
    }
    CHECK(contains(refused([](auto&, Table& table) { table[1].bytes -= 4; }), "'position' does not have the hash"));
    CHECK(contains(refused([](auto&, Table& table) { table[3].bytes += 16; }), "'nothing' does not have the hash"));
    auto unending = [](auto&, Table& table) { std::memset(table[0].name, 'x', format::name_room); };
    CHECK(contains(refused(unending), "name has no end"));
    // A section that occurs twice is found by load alone: is_valid_checkpoint keeps no names.
    write_bytes(path, forged(good, [](auto&, Table& table) { std::memcpy(table[2].name, table[3].name, 32); }));
    CHECK(contains(sentence_of(FONTANA_BAD_INPUT, [&] { Checkpoint::load(path); }), "two sections 'nothing'"));
}

void damage(const std::string& path) {
    Bytes bytes = read_bytes(path);
    bytes[bytes.size() / 2] ^= 1;
    write_bytes(path, bytes);
}

void check_generations(const std::string& folder) {
    const std::string path = folder + "/generations", previous = previous_checkpoint(path);
    const std::size_t files_before = files_in(folder);
    write_sample_checkpoint(path, 1);
    CHECK(!exists(previous));
    for (int number = 2; number <= 4; ++number) {
        write_sample_checkpoint(path, number);
        CHECK(generation(path) == number);
        CHECK(generation(previous) == number - 1);
    }
    std::string note = "left over";
    CHECK(Checkpoint::load_newest(path, &note).tag() == "generation 4");
    CHECK(note.empty());

    damage(path);
    CHECK(Checkpoint::load_newest(path, &note).tag() == "generation 3");
    CHECK(contains(note, "damaged") && contains(note, "continuing from the older checkpoint '" + previous + "'"));
    write_sample_checkpoint(path, 5);  // the damaged one must not push out the good one
    CHECK(generation(path) == 5 && generation(previous) == 3);

    CHECK(unlink(path.c_str()) == 0);
    CHECK(Checkpoint::load_newest(path, &note).tag() == "generation 3");
    CHECK(contains(note, "No such file"));
    damage(previous);
    const std::string both = sentence_of(FONTANA_IO_ERROR, [&] { Checkpoint::load_newest(path, &note); });
    CHECK(contains(both, "No such file") && contains(both, "damaged") && note.empty());

    // Killed between making the older name and publishing: both names are links to one file.
    write_sample_checkpoint(path, 6);
    CHECK(unlink(previous.c_str()) == 0 && link(path.c_str(), previous.c_str()) == 0);
    write_sample_checkpoint(path, 7);
    CHECK(generation(path) == 7 && generation(previous) == 6);
    CHECK(files_in(folder) == files_before + 2);
}

void check_writer_refusals(const std::string& path) {
    CHECK(contains(sentence_of(FONTANA_BAD_INPUT, [&] { CheckpointWriter(path, std::string(1 << 21, 'x')); }), "tag"));
    CheckpointWriter writer(path);
    writer.section("once", nullptr, 0);
    for (const std::string& name : {std::string("once"), std::string(), std::string(32, 'x')}) {
        CHECK(contains(sentence_of(FONTANA_INTERNAL, [&] { writer.section(name, nullptr, 0); }), "'" + name + "'"));
    }
    const std::string absent = "/nowhere/at/all";
    CHECK(contains(sentence_of(FONTANA_IO_ERROR, [&] { CheckpointWriter(absent).publish(); }), absent));
}

}  // namespace

void check_checkpoint(const std::string& folder) {
    const std::string path = folder + "/state.checkpoint";
    check_round_trip(path);
    const Bytes good = read_bytes(path);
    check_damage(path, good);
    check_forgeries(path, good);
    check_generations(folder);
    check_writer_refusals(path);
}
