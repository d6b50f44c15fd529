// Prints the panels of a plugin that was built against the double of the HDK, as JSON: for the lint of the help pages
// and the tests of the scripts.
//
//   fontana_print_panels PLUGIN
//
// {"fontana::solver::1.0": [{"name": ..., "label": ..., "size": ..., "menu": [tokens], "instance_of": ...}, ...], ...}
#include <cstdio>
#include <exception>
#include <string>

#include <hdk_double/hdk_double.h>

namespace {

std::string quoted(const std::string& text) {
    std::string result = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') result += '\\';
        result += c;
    }
    return result + '"';
}

void print_row(const PRM_Template& row, const std::string& list, const char*& separator) {
    std::printf("%s{\"name\": %s, \"label\": %s, \"size\": %d, \"menu\": [", separator, quoted(row.name).c_str(),
                quoted(row.label).c_str(), row.size);
    separator = ",\n  ";
    for (std::size_t k = 0; k < row.menu.size(); ++k)
        std::printf("%s%s", k ? ", " : "", quoted(row.menu[k].first).c_str());
    std::printf("], \"instance_of\": %s}", quoted(list).c_str());
    for (const PRM_Template& child : row.children) print_row(child, row.name, separator);
}

void print_panels() {
    const char* between = "{";
    for (const auto& [name, entry] : hdk_double::operators().operators()) {
        std::printf("%s%s: [\n  ", between, quoted(name).c_str());
        const char* separator = "";
        for (const PRM_Template* row = entry->templates(); row->kind != PRM_Template::Kind::end; ++row)
            if (row->kind != PRM_Template::Kind::ornament) print_row(*row, "", separator);
        std::printf("]");
        between = ",\n";
    }
    std::printf("}\n");
}

}  // namespace

int main(int argument_count, char** arguments) {
    if (argument_count != 2) {
        std::fprintf(stderr, "usage: fontana_print_panels PLUGIN\n");
        return 2;
    }
    try {
        hdk_double::load_plugin(arguments[1]);
        print_panels();
    } catch (const std::exception& trouble) {
        std::fprintf(stderr, "error: %s\n", trouble.what());
        return 1;
    }
    return 0;
}
