// What the checks of io_test share.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "check.h"
#include "util/error.h"

// The most bytes asked for in one allocation since it was set to 0: a reader that trusts a count shows up here.
inline std::size_t largest_allocation = 0;

using Bytes = std::vector<unsigned char>;

// With plain stdio, so that the checks do not lean on what they check.
Bytes read_bytes(const std::string& path);
void write_bytes(const std::string& path, const Bytes& bytes);
bool exists(const std::string& path);
std::size_t files_in(const std::string& folder);

// The sentence with which `call` fails with `status`; "" (and a failed check) if it does anything else.
template <typename Call>
std::string sentence_of(fontana::Status status, Call call) {
    try {
        call();
    } catch (const fontana::Error& error) {
        CHECK(error.status() == status);
        return error.what();
    }
    CHECK(!"an error was expected");
    return "";
}

inline bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

// Each uses files below `folder`, which exists and is empty.
void check_hash64();
void check_atomic_file(const std::string& folder);
void check_bgeo(const std::string& folder);
void check_checkpoint(const std::string& folder);

// The particles that io_test writes; tests that read them with other programs make the same by the same formulas.
struct SampleParticles {
    explicit SampleParticles(std::size_t particle_count);
    std::vector<float> position, velocity;
    std::vector<int> id;
    std::vector<float> density, pressure, pscale, mass;
};
void write_sample_bgeo(const std::string& path, std::size_t particle_count);
// Writes a checkpoint tagged "generation <number>".
void write_sample_checkpoint(const std::string& path, int number);
