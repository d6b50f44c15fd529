// The checks of io, and small commands for the tests in Python:
//
//   io_test                               runs all checks; exit status 1 if one failed
//   io_test write-bgeo FILE COUNT         writes the sample particles
//   io_test sweep-target FOLDER NUMBER    two checkpoints (generations NUMBER and NUMBER + 1) and a .bgeo; prints each
//                                         when it is published; the exit status is the fontana_status
//   io_test verify FILE...                reads each: "good FILE [tag]" or "bad FILE: sentence"
#include <dirent.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <new>

#include "checks.h"
#include "io/bgeo.h"
#include "io/checkpoint.h"

void* operator new(std::size_t bytes) {
    if (bytes > largest_allocation) largest_allocation = bytes;
    if (void* memory = std::malloc(bytes > 0 ? bytes : 1)) return memory;
    throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

Bytes read_bytes(const std::string& path) {
    std::FILE* file = std::fopen(path.c_str(), "rb");
    Bytes bytes;
    CHECK(file != nullptr);
    if (file == nullptr) return bytes;
    for (int byte = std::fgetc(file); byte != EOF; byte = std::fgetc(file)) {
        bytes.push_back(static_cast<unsigned char>(byte));
    }
    std::fclose(file);
    return bytes;
}

void write_bytes(const std::string& path, const Bytes& bytes) {
    std::remove(path.c_str());  // ext4 writes a file to disk at once if it replaces the content of an old one: slow
    std::FILE* file = std::fopen(path.c_str(), "wb");
    CHECK(file != nullptr);
    if (file == nullptr) return;
    if (!bytes.empty()) CHECK(std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size());
    CHECK(std::fclose(file) == 0);
}

bool exists(const std::string& path) { return access(path.c_str(), F_OK) == 0; }

std::size_t files_in(const std::string& folder) {
    std::size_t count = 0;
    DIR* listing = opendir(folder.c_str());
    CHECK(listing != nullptr);
    if (listing == nullptr) return 0;
    while (const dirent* entry = readdir(listing)) count += entry->d_name[0] != '.';
    closedir(listing);
    return count;
}

namespace {

int run_checks() {
    const char* temporary = std::getenv("TMPDIR");
    std::string base = std::string(temporary != nullptr ? temporary : "/tmp") + "/fontana_io_test_XXXXXX";
    CHECK(mkdtemp(base.data()) != nullptr);
    auto folder = [&](const char* name) {
        const std::string path = base + "/" + name;
        CHECK(mkdir(path.c_str(), 0700) == 0);
        return path;
    };
    check_hash64();
    check_atomic_file(folder("atomic_file"));
    check_bgeo(folder("bgeo"));
    check_checkpoint(folder("checkpoint"));
    CHECK(std::system(("rm -r '" + base + "'").c_str()) == 0);
    std::printf("%s\n", failed_checks == 0 ? "all checks passed" : "some checks failed");
    return failed_checks == 0 ? 0 : 1;
}

void published(const char* what) {
    std::printf("published %s\n", what);
    std::fflush(stdout);
}

int sweep_target(const std::string& folder, int number) try {
    write_sample_checkpoint(folder + "/state.checkpoint", number);
    published("checkpoint");
    write_sample_checkpoint(folder + "/state.checkpoint", number + 1);
    published("checkpoint");
    write_sample_bgeo(folder + "/frame.0001.bgeo", 100);
    published("bgeo");
    return FONTANA_OK;
} catch (const fontana::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return error.status();
}

bool ends_with(const std::string& text, const std::string& end) {
    return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

bool verify(const std::string& path) try {
    if (ends_with(path, ".bgeo")) {
        std::printf("good %s %zu\n", path.c_str(), fontana::read_bgeo(path).particle_count());
    } else {
        std::printf("good %s %s\n", path.c_str(), fontana::Checkpoint::load(path).tag().c_str());
    }
    return true;
} catch (const fontana::Error& error) {
    std::printf("bad %s: %s\n", path.c_str(), error.what());
    return false;
}

}  // namespace

int main(int argument_count, char** arguments) {
    const std::string mode = argument_count > 1 ? arguments[1] : "";
    if (mode.empty()) return run_checks();
    if (mode == "write-bgeo" && argument_count == 4) {
        write_sample_bgeo(arguments[2], static_cast<std::size_t>(std::atol(arguments[3])));
        return 0;
    }
    if (mode == "sweep-target" && argument_count == 4) return sweep_target(arguments[2], std::atoi(arguments[3]));
    if (mode == "verify") {
        bool all_good = true;
        for (int i = 2; i < argument_count; ++i) all_good &= verify(arguments[i]);
        return all_good ? 0 : 1;
    }
    std::fprintf(stderr, "io_test: unknown arguments; the modes are at the top of io_test.cpp\n");
    return 2;
}
