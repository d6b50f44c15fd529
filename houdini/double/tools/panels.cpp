// fontana_houdini_panels PLUGIN: the operators of a plugin and their parameters as JSON, for whoever checks help pages
// or writes about them. "#" stands for the number of a row in a multiparm.
#include <cstdio>
#include <exception>
#include <string>

#include "hdk_double/hdk_double.h"

namespace {

const char* word_of(PRM_Template::Kind kind) {
    switch (kind) {
        case PRM_Template::Kind::number:
            return "float";
        case PRM_Template::Kind::whole:
            return "integer";
        case PRM_Template::Kind::toggle:
            return "toggle";
        case PRM_Template::Kind::ordinal:
            return "menu";
        case PRM_Template::Kind::text:
            return "string";
        case PRM_Template::Kind::button:
            return "button";
        case PRM_Template::Kind::multi:
            return "multiparm";
        case PRM_Template::Kind::ornament:
            return "label";
        case PRM_Template::Kind::end:
            break;
    }
    return "";
}

std::string quoted(const std::string& text) {
    std::string result = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') result += '\\';
        result += c == '\n' ? ' ' : c;
    }
    return result + '"';
}

std::string list_of(const std::vector<std::string>& words) {
    std::string result;
    for (const std::string& word : words) result += (result.empty() ? "" : ", ") + quoted(word);
    return "[" + result + "]";
}

void print(const PRM_Template& parm, bool& is_first) {
    std::vector<std::string> menu;
    for (const auto& [token, label] : parm.menu) menu.push_back(token);
    std::printf(
        "%s\n    {\"name\": %s, \"label\": %s, \"folder\": %s, \"type\": \"%s\", \"size\": %d, \"default\": %s, "
        "\"menu\": %s, \"help\": %s}",
        is_first ? "" : ",", quoted(parm.name).c_str(), quoted(parm.label).c_str(), quoted(parm.folder).c_str(),
        word_of(parm.kind), parm.size, list_of(parm.defaults).c_str(), list_of(menu).c_str(),
        quoted(parm.help).c_str());
    is_first = false;
    for (const PRM_Template& child : parm.children) print(child, is_first);
}

}  // namespace

int main(int argc, char** argv) try {
    if (argc != 2) return std::fputs("fontana_houdini_panels PLUGIN\n", stderr), 2;
    hdk_double::load_plugin(argv[1]);
    const char* separator = "{\n";
    for (const auto& [name, entry] : hdk_double::operators().operators()) {
        std::printf("%s  %s: {\"label\": %s, \"icon\": %s, \"parameters\": [", separator, quoted(name).c_str(),
                    quoted(entry->english().toStdString()).c_str(), quoted(entry->icon().toStdString()).c_str());
        bool is_first = true;
        for (const PRM_Template* parm = entry->templates(); parm->kind != PRM_Template::Kind::end; ++parm)
            print(*parm, is_first);
        std::printf("\n  ]}");
        separator = ",\n";
    }
    std::printf("\n}\n");
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "fontana_houdini_panels: %s\n", error.what());
    return 1;
}
