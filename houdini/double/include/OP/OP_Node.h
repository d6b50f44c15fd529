// Of the double, not of the HDK: houdini/double/PROVENANCE.md.
#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "OP/OP_Context.h"
#include "OP/OP_DataTypes.h"
#include "OP/OP_Error.h"
#include "OP/OP_Parameters.h"
#include "SYS/SYS_Version.h"
#include "UT/UT_ErrorManager.h"
#include "UT/UT_InfoTree.h"

#if SYS_VERSION_MAJOR_INT < 21
using OP_InputIdx = unsigned;
#endif

class OP_Network;
class OP_Operator;
class SOP_Node;

class OP_NodeFlags {
 public:
    void setTimeDep(bool yes) { is_time_dependent_ = yes; }
    bool getTimeDep() const { return is_time_dependent_; }

 private:
    bool is_time_dependent_ = false;
};

class OP_NodeInfoTreeParms {
 public:
    explicit OP_NodeInfoTreeParms(fpreal time) : time_(time) {}
    fpreal getTime() const { return time_; }

 private:
    fpreal time_;
};

class OP_Node : public OP_Parameters {
 public:
    OP_Node(OP_Network* parent, const char* name, OP_Operator* entry);
    ~OP_Node() override;

    const UT_String& getName() const { return name_; }
    OP_Operator* getOperator() const { return operator_; }
    OP_NodeFlags& flags() { return flags_; }
    const OP_NodeFlags& flags() const { return flags_; }
    virtual SOP_Node* castToSOPNode() { return nullptr; }

    OP_Node* getInput(OP_InputIdx index) const;
    int nInputs() const { return static_cast<int>(inputs_.size()); }
    OP_ERROR setInput(OP_InputIdx index, OP_Node* input);
    virtual const char* inputLabel(OP_InputIdx index) const;

    void forceRecook();
    bool isCooking(bool include_multithreaded = false) const;
    UT_ErrorSeverity error() const { return errors_.getSeverity(); }
    virtual void fillInfoTreeNodeSpecific(UT_InfoTree&, const OP_NodeInfoTreeParms&) {}

    // The double's own.
    const std::vector<UT_ErrorManager::Entry>& messages() const { return errors_.entries(); }
    // Cooks if anything asks for it.
    OP_ERROR ensure_cooked(OP_Context& context);
    exint cook_count() const { return cook_count_; }
    bool is_locked(OP_InputIdx index) const;
    void set_locked(OP_InputIdx index, bool locked);
    // Of an input that a cook read, so that time dependence travels down.
    void note_time_dependent_input() { reads_time_ = true; }

 protected:
    virtual OP_ERROR cook_me(OP_Context& context) = 0;
    void parameter_changed() override { is_dirty_ = true; }
    UT_ErrorManager& error_manager() { return errors_; }

 private:
    bool needs_cook(const OP_Context& context) const;

    UT_StringHolder name_;
    OP_Operator* operator_;
    OP_NodeFlags flags_;
    std::vector<OP_Node*> inputs_;
    std::vector<exint> input_cook_counts_;
    std::vector<bool> locked_;
    UT_ErrorManager errors_;
    bool is_dirty_ = true, reads_time_ = false;
    fpreal cooked_time_ = 0.0;
    exint cook_count_ = 0;
    std::atomic<int> cooks_under_way_{0};
};
