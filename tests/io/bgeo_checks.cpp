// The .bgeo writer and reader.
#include <unistd.h>

#include <cstdint>
#include <cstring>
#include <random>

#include "checks.h"
#include "io/bgeo.h"
#include "io/hash64.h"

using fontana::BgeoParticles;
using fontana::BgeoView;
using fontana::read_bgeo;
using fontana::write_bgeo;

SampleParticles::SampleParticles(std::size_t particle_count) {
    for (std::size_t i = 0; i < particle_count; ++i) {
        const float number = static_cast<float>(i);
        for (float axis : {1.0f, 2.0f, 3.0f}) {
            position.push_back(axis + 0.125f * number);
            velocity.push_back(axis - 0.25f * number);
        }
        id.push_back(static_cast<int>(i));
        density.push_back(1000.0f + number);
        pressure.push_back(-5.0f * number);
        pscale.push_back(0.01f);
        mass.push_back(0.001f * (number + 1.0f));
    }
}

namespace {

template <typename Particles>
BgeoView view_of(const Particles& p) {
    return {p.density.size(), p.position.data(), p.velocity.data(), p.id.data(),
            p.density.data(), p.pressure.data(), p.pscale.data(),   p.mass.data()};
}

template <typename T, typename U>
bool same_bits(const std::vector<T>& a, const std::vector<U>& b) {
    static_assert(sizeof(T) == sizeof(U));
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

template <typename A, typename B>
bool same_particles(const A& a, const B& b) {
    return same_bits(a.position, b.position) && same_bits(a.velocity, b.velocity) && same_bits(a.id, b.id) &&
           same_bits(a.density, b.density) && same_bits(a.pressure, b.pressure) && same_bits(a.pscale, b.pscale) &&
           same_bits(a.mass, b.mass);
}

// Any bits at all: NaNs of every kind, infinities, denormals.
BgeoParticles random_bits(std::size_t particle_count) {
    std::mt19937 random(1);
    BgeoParticles p;
    auto fill = [&](auto& array, std::size_t components) {
        array.resize(particle_count * components);
        for (auto& value : array) {
            const std::uint32_t word = static_cast<std::uint32_t>(random());
            std::memcpy(&value, &word, sizeof value);
        }
    };
    fill(p.position, 3);
    fill(p.velocity, 3);
    fill(p.id, 1);
    fill(p.density, 1);
    fill(p.pressure, 1);
    fill(p.pscale, 1);
    fill(p.mass, 1);
    return p;
}

void check_round_trip(const std::string& path) {
    for (std::size_t count : {0u, 1u, 2u, 21845u, 21846u, 50000u}) {  // 21845 records of 48 bytes fill a block
        const BgeoParticles written = random_bits(count);
        const std::uint64_t hash = write_bgeo(path, view_of(written));
        const Bytes bytes = read_bytes(path);
        CHECK(hash == fontana::hash64(bytes.data(), bytes.size()));
        CHECK(same_particles(read_bgeo(path), written));
    }
}

void append(Bytes& bytes, const std::string& text) { bytes.insert(bytes.end(), text.begin(), text.end()); }

void append(Bytes& bytes, std::initializer_list<unsigned> words) {
    for (unsigned word : words) {
        for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(static_cast<unsigned char>(word >> shift));
    }
}

void append_attribute(Bytes& bytes, const std::string& name, unsigned char components, unsigned type) {
    bytes.push_back(0);
    bytes.push_back(static_cast<unsigned char>(name.size()));
    append(bytes, name);
    bytes.push_back(0);
    bytes.push_back(components);
    append(bytes, {type});
    for (int i = 0; i < components; ++i) append(bytes, {0u});
}

// A whole file, byte by byte from the description of the format.
void check_layout(const std::string& path) {
    const float position[] = {1.0f, 2.0f, -2.0f}, velocity[] = {0.5f, 0.0f, 4.0f};
    const float density = 1000.0f, pressure = 8.0f, pscale = 0.25f, mass = 16.0f;
    const std::int32_t id = -2;
    write_bgeo(path, {1, position, velocity, &id, &density, &pressure, &pscale, &mass});
    Bytes expected;
    append(expected, "BgeoV");
    append(expected, {5, 1, 0, 0, 0, 6, 0, 0, 0});
    append_attribute(expected, "v", 3, 5);
    append_attribute(expected, "id", 1, 1);
    for (const char* name : {"density", "pressure", "pscale", "mass"}) append_attribute(expected, name, 1, 0);
    append(expected, {0x3f800000, 0x40000000, 0xc0000000, 0x3f800000});  // P and w = 1
    append(expected, {0x3f000000, 0x00000000, 0x40800000});              // v
    append(expected, {0xfffffffe, 0x447a0000, 0x41000000, 0x3e800000, 0x41800000});
    expected.push_back(0x00);
    expected.push_back(0xff);
    CHECK(read_bytes(path) == expected);
}

// Attributes in another order, one that Fontana does not know, and none of most.
void check_foreign_file(const std::string& path) {
    Bytes bytes;
    append(bytes, "BgeoV");
    append(bytes, {5, 2, 0, 0, 0, 3, 0, 0, 0});
    append_attribute(bytes, "density", 1, 0);
    append_attribute(bytes, "Cd", 3, 5);
    append_attribute(bytes, "id", 1, 1);
    for (unsigned i : {0u, 1u}) append(bytes, {10 + i, 20 + i, 30 + i, 0, 40 + i, 0, 0, 0, 50 + i});
    append(bytes, std::string("\x00\xff", 2));
    write_bytes(path, bytes);
    const BgeoParticles p = read_bgeo(path);
    CHECK(same_bits(p.position, std::vector<std::uint32_t>({10, 20, 30, 11, 21, 31})));
    CHECK(same_bits(p.density, std::vector<std::uint32_t>({40, 41})));
    CHECK(same_bits(p.id, std::vector<std::uint32_t>({50, 51})));
    CHECK(p.velocity.empty() && p.pressure.empty() && p.pscale.empty() && p.mass.empty());
}

std::string refusal(const std::string& path, const Bytes& bytes) {
    write_bytes(path, bytes);
    largest_allocation = 0;
    const std::string sentence = sentence_of(FONTANA_BAD_INPUT, [&] { read_bgeo(path); });
    CHECK(largest_allocation < 100000);
    CHECK(contains(sentence, path));
    return sentence;
}

Bytes with_word(Bytes bytes, std::size_t offset, unsigned word) {
    for (std::size_t i = 0; i < 4; ++i) bytes[offset + i] = static_cast<unsigned char>(word >> (24 - 8 * i));
    return bytes;
}

void check_hostile_headers(const std::string& path) {
    constexpr std::size_t version = 5, points = 9, point_attributes = 25, first_attribute = 41;
    const SampleParticles sample(3);
    write_bgeo(path, view_of(sample));
    const Bytes good = read_bytes(path);

    for (unsigned huge : {4u, 0x7fffffffu, 0x05555556u}) {  // the last times 48 is 32 more than 2^32
        CHECK(contains(refusal(path, with_word(good, points, huge)), "the points"));
    }
    CHECK(contains(refusal(path, with_word(good, points, 2)), "does not end"));
    for (unsigned huge : {7u, 100u}) refusal(path, with_word(good, point_attributes, huge));
    CHECK(contains(refusal(path, with_word(good, point_attributes, 0x7fffffffu)), "the list of attributes"));
    for (std::size_t count = points; count <= 37; count += 4) {
        for (unsigned negative : {0x80000000u, 0xffffffffu}) {
            CHECK(contains(refusal(path, with_word(good, count, negative)), "negative number of"));
        }
    }
    CHECK(contains(refusal(path, with_word(good, version, 6)), "version 6"));
    CHECK(contains(refusal(path, with_word(good, first_attribute, 0xffff7600u)), "the description of an attribute"));
    CHECK(contains(refusal(path, with_word(good, first_attribute + 3, 0xffff0000u)), "the description"));
    CHECK(contains(refusal(path, with_word(good, first_attribute + 5, 0u)), "attribute 'v' of type 0"));
    CHECK(contains(refusal(path, with_word(good, first_attribute + 5, 4u)), "string attribute, 'v'"));
    CHECK(contains(refusal(path, with_word(good, first_attribute + 5, 77u)), "unknown type 77"));

    Bytes twice;
    append(twice, "BgeoV");
    append(twice, {5, 0, 0, 0, 0, 2, 0, 0, 0});
    append_attribute(twice, "mass", 1, 0);
    append_attribute(twice, "mass", 1, 0);
    CHECK(contains(refusal(path, twice), "two attributes 'mass'"));
}

void check_damage(const std::string& path) {
    const SampleParticles sample(3);
    write_bgeo(path, view_of(sample));
    const Bytes good = read_bytes(path);
    for (std::size_t length = 0; length < good.size(); ++length) {
        refusal(path, Bytes(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(length)));
    }
    Bytes longer = good;
    longer.push_back(0);
    refusal(path, longer);
    // The format has no hash, so damage can go unseen; but it must neither crash nor allocate without end.
    for (std::size_t i = 0; i < good.size(); ++i) {
        for (unsigned difference : {0x01u, 0x80u, 0xffu}) {
            Bytes damaged = good;
            damaged[i] = static_cast<unsigned char>(damaged[i] ^ difference);
            write_bytes(path, damaged);
            largest_allocation = 0;
            try {
                read_bgeo(path);
            } catch (const fontana::Error&) {
            }
            CHECK(largest_allocation < 100000);
        }
    }
}

void check_refusals(const std::string& folder) {
    const std::string path = folder + "/refused.bgeo";
    CHECK(contains(refusal(path, {0x1f, 0x8b, 8, 0, 0, 0}), "gzip"));
    CHECK(contains(refusal(path, {0x7f, 'N', 'S', 'J', 0}), ".bhclassic"));
    CHECK(contains(refusal(path, {'P', 'G', 'E', 'O', 'M'}), "not a classic .bgeo"));
    CHECK(contains(sentence_of(FONTANA_IO_ERROR, [&] { read_bgeo(folder + "/absent"); }), "No such file"));
    CHECK(contains(sentence_of(FONTANA_IO_ERROR, [&] { read_bgeo(folder); }), "not a regular file"));

    CHECK(unlink(path.c_str()) == 0);
    const SampleParticles sample(2);
    BgeoView view = view_of(sample);
    view.mass = nullptr;
    CHECK(contains(sentence_of(FONTANA_BAD_INPUT, [&] { write_bgeo(path, view); }), "array is missing"));
    view = view_of(sample);
    view.particle_count = std::size_t{1} << 31;
    CHECK(contains(sentence_of(FONTANA_BAD_INPUT, [&] { write_bgeo(path, view); }), "2147483648"));
    CHECK(!exists(path));
}

}  // namespace

void write_sample_bgeo(const std::string& path, std::size_t particle_count) {
    write_bgeo(path, view_of(SampleParticles(particle_count)));
}

void check_bgeo(const std::string& folder) {
    const std::string path = folder + "/frame.0001.bgeo";
    check_round_trip(path);
    check_layout(path);
    check_foreign_file(path);
    check_hostile_headers(path);
    check_damage(path);
    check_refusals(folder);
}
