// houdini_test PLUGIN GROUP: loads the plugin into the double, and runs one group of checks.
#include <cstdio>
#include <exception>
#include <string>

#include "checks.h"
#include "scene.h"

int main(int argc, char** argv) try {
    const struct {
        const char* name;
        void (*run)();
    } groups[] = {{"timeline", check_timeline},     {"edits", check_edits},    {"faults", check_faults},
                  {"attributes", check_attributes}, {"panel", check_panel},    {"source", check_source},
                  {"session", check_session},       {"threads", check_threads}};
    if (argc != 3) return std::fputs("houdini_test PLUGIN GROUP\n", stderr), 2;
    hdk_double::load_plugin(argv[1]);
    for (const auto& group : groups) {
        if (std::string(group.name) != argv[2]) continue;
        group.run();
        return failed_checks != 0;
    }
    return std::fprintf(stderr, "no group %s\n", argv[2]), 2;
} catch (const std::exception& error) {
    std::fprintf(stderr, "houdini_test: %s\n", error.what());
    return 1;
}
