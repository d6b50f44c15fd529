// Of the double, not of the HDK: houdini/double/PROVENANCE.md.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "CH/CH_Manager.h"
#include "PRM/PRM_Template.h"
#include "UT/UT_StringHolder.h"

class OP_Parameters {
 public:
    explicit OP_Parameters(const PRM_Template* templates) : templates_(templates) {}
    virtual ~OP_Parameters() = default;
    OP_Parameters(const OP_Parameters&) = delete;
    OP_Parameters& operator=(const OP_Parameters&) = delete;

    fpreal evalFloat(const UT_StringRef& name, int component, fpreal time) const;
    exint evalInt(const UT_StringRef& name, int component, fpreal time) const;
    void evalString(UT_String& value, const UT_StringRef& name, int component, fpreal time) const;
    fpreal evalFloatInst(const UT_StringRef& name, const int* instance, int component, fpreal time) const;
    exint evalIntInst(const UT_StringRef& name, const int* instance, int component, fpreal time) const;
    bool isParmTimeDependent(const UT_StringRef& name, int component = -1) const;

    void setFloat(const UT_StringRef& name, int component, fpreal time, fpreal value);
    void setInt(const UT_StringRef& name, int component, fpreal time, exint value);
    void setString(const UT_StringRef& value, CH_StringMeaning, const UT_StringRef& name, int component, fpreal time);

    // The double's own. A parameter is keyed by straight lines between keys, texts and toggles by steps.
    const PRM_Template* templates() const { return templates_; }
    void set_key(const std::string& name, int component, fpreal time, double value);
    void clear_keys(const std::string& name);
    // The template of a parameter or of a parameter of an instance; throws if there is none.
    const PRM_Template& template_of(const std::string& name) const;

 protected:
    virtual void parameter_changed() = 0;
    // Whether a keyed parameter was asked for since it was last cleared.
    mutable bool has_read_keys_ = false;

 private:
    struct Value {
        std::vector<std::string> constant;           // by component
        std::vector<std::map<fpreal, double>> keys;  // by component, by time
    };
    const Value& value_of(const std::string& name) const;
    double number(const std::string& name, int component, fpreal time) const;

    const PRM_Template* templates_;
    mutable std::map<std::string, Value> values_;
};
