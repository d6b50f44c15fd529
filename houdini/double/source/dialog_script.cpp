#include "dialog_script.h"

#include <algorithm>
#include <cctype>
#include <set>
#include <stdexcept>

namespace hdk_double {
namespace {

class Reader {
 public:
    explicit Reader(const std::string& text) : text_(text) {}

    // The next word, quoted text or brace; "" at the end.
    std::string next() {
        skip_blanks();
        if (at_ == text_.size()) return "";
        const char c = text_[at_];
        if (c == '{' || c == '}') return std::string(1, text_[at_++]);
        if (c == '"') return quoted();
        const std::size_t start = at_;
        while (at_ < text_.size() && !std::isspace(static_cast<unsigned char>(text_[at_])) && text_[at_] != '{' &&
               text_[at_] != '}')
            ++at_;
        return text_.substr(start, at_ - start);
    }
    bool is_next(char c) {
        skip_blanks();
        return at_ < text_.size() && text_[at_] == c;
    }
    void expect(const std::string& word) {
        const std::string found = next();
        if (found != word) fail("expected '" + word + "', found '" + found + "'");
    }
    [[noreturn]] void fail(const std::string& trouble) const {
        std::size_t line = 1;
        for (std::size_t k = 0; k < at_; ++k) line += text_[k] == '\n';
        throw std::runtime_error("dialog script, line " + std::to_string(line) + ": " + trouble);
    }

 private:
    void skip_blanks() {
        while (at_ < text_.size()) {
            if (text_.compare(at_, 2, "//") == 0)
                at_ = std::min(text_.find('\n', at_), text_.size());
            else if (std::isspace(static_cast<unsigned char>(text_[at_])))
                ++at_;
            else
                return;
        }
    }
    std::string quoted() {
        std::string result;
        for (++at_; at_ < text_.size() && text_[at_] != '"'; ++at_) {
            if (text_[at_] == '\\') ++at_;
            result += text_[at_];
        }
        ++at_;
        return result;
    }

    const std::string& text_;
    std::size_t at_ = 0;
};

std::vector<std::string> words_in_braces(Reader& reader) {
    std::vector<std::string> words;
    reader.expect("{");
    while (!reader.is_next('}')) words.push_back(reader.next());
    reader.expect("}");
    return words;
}

PRM_Template::Kind kind_of(const std::string& type, const Reader& reader) {
    using Kind = PRM_Template::Kind;
    if (type == "float" || type == "vector" || type == "vector2" || type == "log" || type == "direction")
        return Kind::number;
    if (type == "integer" || type == "intlog") return Kind::whole;
    if (type == "toggle") return Kind::toggle;
    if (type == "ordinal") return Kind::ordinal;
    if (type == "string" || type == "file" || type == "geometry") return Kind::text;
    if (type == "button") return Kind::button;
    if (type == "label" || type == "separator" || type == "heading") return Kind::ornament;
    reader.fail("no type '" + type + "'");
}

void read_range(PRM_Template& parm, const std::vector<std::string>& bounds, const Reader& reader) {
    if (bounds.size() != 2) reader.fail("a range has two bounds");
    parm.has_range = true;
    parm.minimum = std::stod(bounds[0]);
    parm.maximum = std::stod(bounds[1]);
    parm.is_minimum_strict = bounds[0].back() == '!';
    parm.is_maximum_strict = bounds[1].back() == '!';
}

// One entry of a parm, group or multiparm that says something about itself.
void read_property(Reader& reader, const std::string& word, PRM_Template& parm) {
    static const std::set<std::string> flags = {"joinnext", "nolabel", "invisible", "baseparm", "endblock"};
    if (flags.count(word)) return;
    if (word == "name")
        parm.name = reader.next();
    else if (word == "label")
        parm.label = reader.next();
    else if (word == "type")
        parm.kind = kind_of(reader.next(), reader);
    else if (word == "size")
        parm.size = std::stoi(reader.next());
    else if (word == "default" && reader.is_next('{'))
        parm.defaults = words_in_braces(reader);
    else if (word == "default")
        parm.defaults = {reader.next()};
    else if (word == "range")
        read_range(parm, words_in_braces(reader), reader);
    else if (word == "help")
        parm.help = reader.next();
    else if (word == "disablewhen")
        parm.disable_when = reader.next();
    else if (word == "menu") {
        const std::vector<std::string> words = words_in_braces(reader);
        for (std::size_t k = 0; k + 1 < words.size(); k += 2) parm.menu.emplace_back(words[k], words[k + 1]);
    } else if (word == "parmtag")
        words_in_braces(reader);
    else if (word == "export" || word == "hidewhen" || word == "cppname")
        reader.next();
    else
        reader.fail("no entry '" + word + "'");
}

PRM_Template read_parm(Reader& reader, const std::string& folder) {
    PRM_Template parm;
    parm.kind = PRM_Template::Kind::number;
    parm.folder = folder;
    reader.expect("{");
    while (!reader.is_next('}')) read_property(reader, reader.next(), parm);
    reader.expect("}");
    parm.defaults.resize(static_cast<std::size_t>(parm.size), parm.kind == PRM_Template::Kind::text ? "" : "0");
    if (parm.name.empty()) reader.fail("a parameter without a name");
    return parm;
}

PRM_Template read_multiparm(Reader& reader, const std::string& folder) {
    PRM_Template multi;
    reader.expect("{");
    while (!reader.is_next('}')) {
        const std::string word = reader.next();
        if (word == "parm")
            multi.children.push_back(read_parm(reader, folder));
        else
            read_property(reader, word, multi);
    }
    reader.expect("}");
    multi.kind = PRM_Template::Kind::multi;
    multi.folder = folder;
    multi.defaults.resize(1, "0");
    return multi;
}

void read_folder(Reader& reader, std::vector<PRM_Template>& out) {
    PRM_Template folder;
    reader.expect("{");
    while (!reader.is_next('}')) {
        const std::string word = reader.next();
        if (word == "parm")
            out.push_back(read_parm(reader, folder.label));
        else if (word == "multiparm")
            out.push_back(read_multiparm(reader, folder.label));
        else
            read_property(reader, word, folder);
    }
    reader.expect("}");
}

void read_parms(Reader& reader, const std::string& folder, std::vector<PRM_Template>& out) {
    while (!reader.is_next('}')) {
        const std::string word = reader.next();
        if (word == "name")
            reader.next();
        else if (word == "parm")
            out.push_back(read_parm(reader, folder));
        else if (word == "group" || word == "groupcollapsible" || word == "groupsimple")
            read_folder(reader, out);
        else if (word == "multiparm")
            out.push_back(read_multiparm(reader, folder));
        else
            reader.fail("no entry '" + word + "'");
    }
}

void require_unique_names(const std::vector<PRM_Template>& parms) {
    std::set<std::string> names;
    for (const PRM_Template& parm : parms)
        if (!names.insert(parm.name).second)
            throw std::runtime_error("dialog script: two parameters are named '" + parm.name + "'");
}

}  // namespace

std::vector<PRM_Template> parse_dialog_script(const std::string& text) {
    Reader reader(text);
    std::vector<PRM_Template> parms;
    reader.expect("{");
    read_parms(reader, "", parms);
    reader.expect("}");
    require_unique_names(parms);
    return parms;
}

}  // namespace hdk_double
