#include "program.h"

#include <dlfcn.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>

namespace stand_in {
namespace {

// Writes the PTX beside the cache of what was compiled. Returns the file's path, or "".
std::string write_ptx(const std::string& ptx) {
    std::string path = (std::filesystem::temp_directory_path() / "fontana-stand-in-XXXXXX").string();
    const int file = mkstemp(path.data());
    if (file < 0) return "";
    const bool is_whole = write(file, ptx.data(), ptx.size()) == static_cast<ssize_t>(ptx.size());
    close(file);
    return is_whole ? path : "";
}

std::string translate(const std::string& ptx_path) {
    const std::string command = STAND_IN_PYTHON " " STAND_IN_FOLDER "/translate.py " + ptx_path + " " STAND_IN_CACHE;
    FILE* output = popen(command.c_str(), "r");
    if (!output) return "";
    char line[4096] = {};
    const bool has_line = std::fgets(line, sizeof line, output) != nullptr;
    if (pclose(output) != 0 || !has_line) return "";
    std::string path = line;
    path.resize(path.find('\n'));
    return path;
}

}  // namespace

const KernelCode* load_program(const std::string& ptx) {
    static std::map<std::string, const KernelCode*> programs;
    const KernelCode*& program = programs[ptx];
    if (program) return program;
    const std::string ptx_path = write_ptx(ptx);
    const std::string library = translate(ptx_path);
    std::remove(ptx_path.c_str());
    if (library.empty()) return nullptr;
    void* handle = dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!handle) std::fprintf(stderr, "stand-in driver: %s\n", dlerror());
    if (handle) program = static_cast<const KernelCode*>(dlsym(handle, "stand_in_kernels"));
    return program;
}

}  // namespace stand_in
