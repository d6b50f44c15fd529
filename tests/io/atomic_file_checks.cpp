// AtomicFile and hash64.
#include "io/atomic_file.h"

#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "checks.h"

using fontana::AtomicFile;
using fontana::Hash64;
using fontana::hash64;

namespace {

// The definition of hash64, byte by byte.
std::uint64_t plain_hash(const Bytes& bytes) {
    std::uint64_t state = 0xcbf29ce484222325u;
    auto mix = [&](std::uint64_t word) {
        state = (state ^ word) * 0x100000001b3u;
        state ^= state >> 32;
    };
    for (std::size_t first = 0; first < bytes.size(); first += 8) {
        std::uint64_t word = 0;
        for (std::size_t k = 0; k < 8 && first + k < bytes.size(); ++k) {
            word |= std::uint64_t{bytes[first + k]} << (8 * k);
        }
        mix(word);
    }
    mix(bytes.size());
    return state;
}

Bytes sample_bytes(std::size_t count) {
    Bytes bytes;
    for (std::size_t i = 0; i < count; ++i) bytes.push_back(static_cast<unsigned char>(i * 37 + 11));
    return bytes;
}

void check_publishing(const std::string& folder) {
    const std::string path = folder + "/content";
    const Bytes content = sample_bytes(1000);
    {
        AtomicFile file(path);
        file.write(content.data(), 400);
        file.write(content.data() + 400, 600);
        CHECK(!exists(path));
        file.publish();
        CHECK(file.bytes() == 1000);
        CHECK(file.hash() == hash64(content.data(), content.size()));
    }
    CHECK(read_bytes(path) == content);
    CHECK(files_in(folder) == 1);
}

void check_abandoning(const std::string& folder) {
    const std::string path = folder + "/content";
    const Bytes before = read_bytes(path);
    {
        AtomicFile file(path);
        file.write("other", 5);
    }
    {
        AtomicFile file(path);
        file.write("other", 5);
        file.finish();
    }
    CHECK(read_bytes(path) == before);
    CHECK(files_in(folder) == 1);
}

// Two writers of one name do not share a temporary file; the last to publish holds the name.
void check_two_writers(const std::string& folder) {
    const std::string path = folder + "/content";
    AtomicFile first(path), second(path);
    first.write("first", 5);
    second.write("second", 6);
    second.publish();
    first.publish();
    CHECK(read_bytes(path) == Bytes({'f', 'i', 'r', 's', 't'}));
    CHECK(files_in(folder) == 1);
}

void check_refusals(const std::string& folder) {
    const std::string missing = folder + "/nowhere/content";
    CHECK(
        contains(sentence_of(FONTANA_IO_ERROR, [&] { AtomicFile file(missing); }), "'" + missing + "': No such file"));

    const std::string occupied = folder + "/a_folder";
    CHECK(mkdir(occupied.c_str(), 0700) == 0);
    CHECK(contains(sentence_of(FONTANA_IO_ERROR, [&] { AtomicFile(occupied).publish(); }), occupied));
    CHECK(rmdir(occupied.c_str()) == 0);
    CHECK(files_in(folder) == 1);
}

void check_symbolic_link(const std::string& folder) {
    const std::string link = folder + "/link";
    CHECK(symlink("content", link.c_str()) == 0);
    const Bytes before = read_bytes(folder + "/content");
    AtomicFile file(link);
    file.write("new", 3);
    file.publish();
    CHECK(read_bytes(folder + "/content") == before);
    CHECK(read_bytes(link) == Bytes({'n', 'e', 'w'}));
    CHECK(unlink(link.c_str()) == 0);
}

// A real refusal by the system in mid-write, after a short write: the limit on the size of files.
void check_full(const std::string& folder) {
    const std::string path = folder + "/content";
    const Bytes before = read_bytes(path), large = sample_bytes(100000);
    signal(SIGXFSZ, SIG_IGN);
    rlimit unlimited = {};
    CHECK(getrlimit(RLIMIT_FSIZE, &unlimited) == 0);
    const rlimit small = {4096, unlimited.rlim_max};
    CHECK(setrlimit(RLIMIT_FSIZE, &small) == 0);
    const std::string sentence = sentence_of(FONTANA_IO_ERROR, [&] {
        AtomicFile file(path);
        file.write(large.data(), large.size());
    });
    CHECK(setrlimit(RLIMIT_FSIZE, &unlimited) == 0);
    CHECK(contains(sentence, "cannot write '" + path + "'"));
    CHECK(contains(sentence, "ulimit -f"));
    CHECK(read_bytes(path) == before);
    CHECK(files_in(folder) == 1);
}

}  // namespace

void check_hash64() {
    CHECK(hash64(nullptr, 0) == plain_hash({}));
    for (std::size_t count : {1u, 7u, 8u, 9u, 16u, 40u, 61u}) {
        Bytes bytes = sample_bytes(count);
        const std::uint64_t hash = hash64(bytes.data(), count);
        CHECK(hash == plain_hash(bytes));
        for (std::size_t cut = 0; cut <= count; ++cut) {
            Hash64 pieces;
            pieces.update(bytes.data(), cut);
            pieces.update(bytes.data() + cut, (count - cut) / 2);
            pieces.update(bytes.data() + cut + (count - cut) / 2, (count - cut + 1) / 2);
            CHECK(pieces.value() == hash);
        }
        for (unsigned char& byte : bytes) {
            for (unsigned difference = 1; difference < 256; ++difference) {
                byte = static_cast<unsigned char>(byte ^ difference);
                CHECK(hash64(bytes.data(), count) != hash);
                byte = static_cast<unsigned char>(byte ^ difference);
            }
        }
    }
    const Bytes zeros(16), more_zeros(17);
    CHECK(hash64(zeros.data(), 16) != hash64(more_zeros.data(), 17));
    Bytes two_signs(16);
    two_signs[7] = two_signs[15] = 0x80;
    CHECK(hash64(zeros.data(), 16) != hash64(two_signs.data(), 16));
}

void check_atomic_file(const std::string& folder) {
    check_publishing(folder);
    check_abandoning(folder);
    check_two_writers(folder);
    check_refusals(folder);
    check_symbolic_link(folder);
    check_full(folder);
}
