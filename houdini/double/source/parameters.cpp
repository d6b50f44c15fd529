// Panels and their values.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "OP/OP_GraphProxy.h"
#include "OP/OP_Parameters.h"
#include "PRM/PRM_TemplateBuilder.h"
#include "dialog_script.h"

using Kind = PRM_Template::Kind;

PRM_TemplateBuilder::PRM_TemplateBuilder(const UT_StringHolder&, const char* dialog_script, const char**, int)
    : templates_(hdk_double::parse_dialog_script(dialog_script)) {
    templates_.emplace_back();
}

PRM_Template* PRM_TemplateBuilder::findTemplate(const UT_StringRef& name) {
    for (PRM_Template& parm : templates_)
        if (parm.name == name.toStdString()) return &parm;
    throw std::logic_error("double: no template '" + name.toStdString() + "'");
}

namespace {

std::string instance_name(const UT_StringRef& name, const int* instance) {
    std::string result = name.toStdString();
    const std::size_t mark = result.find('#');
    if (mark != std::string::npos) result.replace(mark, 1, std::to_string(*instance));
    return result;
}

// "collider_type12" is an instance of "collider_type#".
bool is_instance_of(const std::string& name, const std::string& pattern) {
    const std::size_t mark = pattern.find('#');
    if (mark == std::string::npos || name.size() <= mark || name.compare(0, mark, pattern, 0, mark) != 0) return false;
    return std::all_of(name.begin() + static_cast<std::ptrdiff_t>(mark), name.end(),
                       [](unsigned char c) { return std::isdigit(c); });
}

int index_in_menu(const PRM_Template& parm, const std::string& token) {
    for (std::size_t k = 0; k < parm.menu.size(); ++k)
        if (parm.menu[k].first == token) return static_cast<int>(k);
    return -1;
}

double number_of(const PRM_Template& parm, const std::string& text) {
    if (parm.kind == Kind::ordinal && index_in_menu(parm, text) >= 0) return index_in_menu(parm, text);
    if (text == "on" || text == "true") return 1.0;
    return text.empty() || text == "off" || text == "false" ? 0.0 : std::stod(text);
}

double between_keys(const std::map<fpreal, double>& keys, fpreal time, bool is_stepped) {
    const auto next = keys.upper_bound(time);
    if (next == keys.begin()) return next->second;
    const auto last = std::prev(next);
    if (next == keys.end() || is_stepped) return last->second;
    return last->second + (next->second - last->second) * (time - last->first) / (next->first - last->first);
}

std::string text_of(double value) {
    char text[40];
    std::snprintf(text, sizeof text, "%.17g", value);
    return text;
}

}  // namespace

const PRM_Template& OP_Parameters::template_of(const std::string& name) const {
    for (const PRM_Template* parm = templates_; parm && parm->kind != Kind::end; ++parm) {
        if (parm->name == name) return *parm;
        for (const PRM_Template& child : parm->children)
            if (is_instance_of(name, child.name)) return child;
    }
    throw std::logic_error("double: no parameter '" + name + "'");
}

const OP_Parameters::Value& OP_Parameters::value_of(const std::string& name) const {
    const auto found = values_.find(name);
    if (found != values_.end()) return found->second;
    const PRM_Template& parm = template_of(name);
    Value value{parm.defaults, std::vector<std::map<fpreal, double>>(parm.defaults.size())};
    return values_.emplace(name, std::move(value)).first->second;
}

double OP_Parameters::number(const std::string& name, int component, fpreal time) const {
    const PRM_Template& parm = template_of(name);
    const Value& value = value_of(name);
    const auto& keys = value.keys.at(static_cast<std::size_t>(component));
    if (keys.empty()) return number_of(parm, value.constant[static_cast<std::size_t>(component)]);
    has_read_keys_ = true;
    return between_keys(keys, time, parm.kind == Kind::ordinal || parm.kind == Kind::toggle);
}

fpreal OP_Parameters::evalFloat(const UT_StringRef& name, int component, fpreal time) const {
    return number(name.toStdString(), component, time);
}

exint OP_Parameters::evalInt(const UT_StringRef& name, int component, fpreal time) const {
    return static_cast<exint>(std::llround(number(name.toStdString(), component, time)));
}

void OP_Parameters::evalString(UT_String& value, const UT_StringRef& name, int component, fpreal time) const {
    const PRM_Template& parm = template_of(name.toStdString());
    if (parm.kind == Kind::ordinal) {
        const auto index = static_cast<std::size_t>(evalInt(name, component, time));
        value = index < parm.menu.size() ? parm.menu[index].first : std::to_string(index);
    } else {
        value = value_of(name.toStdString()).constant.at(static_cast<std::size_t>(component));
    }
}

fpreal OP_Parameters::evalFloatInst(const UT_StringRef& name, const int* instance, int component, fpreal time) const {
    return evalFloat(instance_name(name, instance), component, time);
}

exint OP_Parameters::evalIntInst(const UT_StringRef& name, const int* instance, int component, fpreal time) const {
    return evalInt(instance_name(name, instance), component, time);
}

bool OP_Parameters::isParmTimeDependent(const UT_StringRef& name, int component) const {
    const Value& value = value_of(name.toStdString());
    for (std::size_t k = 0; k < value.keys.size(); ++k)
        if ((component < 0 || static_cast<std::size_t>(component) == k) && !value.keys[k].empty()) return true;
    return false;
}

void OP_Parameters::setFloat(const UT_StringRef& name, int component, fpreal, fpreal value) {
    value_of(name.toStdString());
    values_[name.toStdString()].constant.at(static_cast<std::size_t>(component)) = text_of(value);
    parameter_changed();
}

void OP_Parameters::setInt(const UT_StringRef& name, int component, fpreal time, exint value) {
    setFloat(name, component, time, static_cast<fpreal>(value));
}

void OP_Parameters::setString(const UT_StringRef& value, CH_StringMeaning, const UT_StringRef& name, int component,
                              fpreal) {
    value_of(name.toStdString());
    values_[name.toStdString()].constant.at(static_cast<std::size_t>(component)) = value.toStdString();
    parameter_changed();
}

void OP_Parameters::set_key(const std::string& name, int component, fpreal time, double value) {
    value_of(name);
    values_[name].keys.at(static_cast<std::size_t>(component))[time] = value;
    parameter_changed();
}

void OP_Parameters::clear_keys(const std::string& name) {
    value_of(name);
    for (auto& keys : values_[name].keys) keys.clear();
    parameter_changed();
}

// Each eval of a keyed parameter marks what depends on it.
template <typename Read>
static void read_and_mark(const OP_Parameters& node, const char* name, DEP_MicroNode* dependency, const Read& read) {
    read();
    if (dependency && node.isParmTimeDependent(name)) dependency->setTimeDependent(true);
}

void OP_GraphProxy::evalOpParm(int64& value, exint, const char* name, fpreal time, DEP_MicroNode* node) const {
    read_and_mark(*parameters_, name, node, [&] { value = parameters_->evalInt(name, 0, time); });
}
void OP_GraphProxy::evalOpParm(bool& value, exint, const char* name, fpreal time, DEP_MicroNode* node) const {
    read_and_mark(*parameters_, name, node, [&] { value = parameters_->evalInt(name, 0, time) != 0; });
}
void OP_GraphProxy::evalOpParm(fpreal64& value, exint, const char* name, fpreal time, DEP_MicroNode* node) const {
    read_and_mark(*parameters_, name, node, [&] { value = parameters_->evalFloat(name, 0, time); });
}
void OP_GraphProxy::evalOpParm(UT_Vector2D& value, exint, const char* name, fpreal time, DEP_MicroNode* node) const {
    read_and_mark(*parameters_, name, node, [&] {
        value = UT_Vector2D(parameters_->evalFloat(name, 0, time), parameters_->evalFloat(name, 1, time));
    });
}
void OP_GraphProxy::evalOpParm(UT_Vector3D& value, exint, const char* name, fpreal time, DEP_MicroNode* node) const {
    read_and_mark(*parameters_, name, node, [&] {
        value = UT_Vector3D(parameters_->evalFloat(name, 0, time), parameters_->evalFloat(name, 1, time),
                            parameters_->evalFloat(name, 2, time));
    });
}
void OP_GraphProxy::evalOpParm(UT_StringHolder& value, exint, const char* name, fpreal time,
                               DEP_MicroNode* node) const {
    read_and_mark(*parameters_, name, node, [&] { parameters_->evalString(value, name, 0, time); });
}
