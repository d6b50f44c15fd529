// Of the double, not of the HDK: houdini/double/PROVENANCE.md.
#pragma once

#include "OP/OP_Node.h"

using OP_Constructor = OP_Node* (*)(OP_Network*, const char*, OP_Operator*);
enum { OP_FLAG_NETWORK = 0x1, OP_FLAG_GENERATOR = 0x2, OP_FLAG_UNORDERED = 0x4, OP_FLAG_OUTPUT = 0x40 };

class OP_Operator {
 public:
    OP_Operator(const char* name, const char* english, OP_Constructor constructor, PRM_Template* templates,
                unsigned min_sources, unsigned max_sources = 9999, CH_LocalVariable* variables = nullptr,
                unsigned flags = 0, const char** input_labels = nullptr, int max_outputs = 1,
                const char* tab_submenu_path = nullptr);
    virtual ~OP_Operator() = default;

    void setIconName(const char* icon) { icon_ = icon; }

    // The double's own.
    const UT_StringHolder& name() const { return name_; }
    const UT_StringHolder& english() const { return english_; }
    const UT_StringHolder& icon() const { return icon_; }
    OP_Node* construct(OP_Network* network, const char* name) { return construct_(network, name, this); }
    const PRM_Template* templates() const { return templates_; }
    unsigned min_sources() const { return min_sources_; }
    unsigned max_sources() const { return max_sources_; }
    const char* input_label(std::size_t index) const;

 private:
    UT_StringHolder name_, english_, icon_;
    OP_Constructor construct_;
    PRM_Template* templates_;
    unsigned min_sources_, max_sources_;
    std::vector<UT_StringHolder> input_labels_;
};
