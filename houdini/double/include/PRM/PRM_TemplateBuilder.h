// Of the double, not of the HDK: houdini/double/PROVENANCE.md.
#pragma once

#include "PRM/PRM_Template.h"
#include "UT/UT_StringHolder.h"

class PRM_TemplateBuilder {
 public:
    PRM_TemplateBuilder(const UT_StringHolder& name, const char* dialog_script, const char** cpp_options = nullptr,
                        int extra_parms = 0);

    PRM_Template* templates() const { return const_cast<PRM_Template*>(templates_.data()); }
    int templateLength() const { return static_cast<int>(templates_.size()); }
    // True the first time it is asked.
    bool justBuilt() { return std::exchange(just_built_, false); }
    PRM_Template* findTemplate(const UT_StringRef& name);
    void setCallback(const UT_StringRef& name, PRM_Callback callback) { findTemplate(name)->callback = callback; }
    void setChoiceListPtr(const UT_StringRef& name, PRM_ChoiceList* list) { findTemplate(name)->choices = list; }

 private:
    std::vector<PRM_Template> templates_;
    bool just_built_ = true;
};
