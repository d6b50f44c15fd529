// Of the double, not of the HDK: houdini/double/PROVENANCE.md.
#pragma once

#include <memory>
#include <vector>

#include "DEP/DEP_MicroNode.h"
#include "OP/OP_Director.h"
#include "OP/OP_GraphProxy.h"
#include "SOP/SOP_Node.h"

class SOP_NodeCache {
 public:
    virtual ~SOP_NodeCache() = default;
};

class SOP_NodeParms {
 public:
    virtual ~SOP_NodeParms() = default;
    virtual void buildFromOp(const OP_GraphProxy*, exint, fpreal, DEP_MicroNode*) {}
};

class SOP_NodeVerb {
 public:
    enum CookMode { COOK_INPLACE, COOK_DUPLICATE, COOK_GENERATOR, COOK_INSTANCE, COOK_GENERIC, COOK_PASSTHROUGH };
    class CookParms;

    // Makes the verb when the plugin is loaded.
    template <typename Verb>
    class Register {
     public:
        Register() : verb_(std::make_unique<Verb>()) {}
        const Verb* get() const { return verb_.get(); }

     private:
        std::unique_ptr<Verb> verb_;
    };

    virtual ~SOP_NodeVerb() = default;
    virtual SOP_NodeParms* allocParms() const = 0;
    virtual SOP_NodeCache* allocCache() const { return nullptr; }
    virtual UT_StringHolder name() const = 0;
    virtual CookMode cookMode(const SOP_NodeParms*) const { return COOK_GENERIC; }
    virtual void cook(const CookParms& cookparms) const = 0;
};

class SOP_NodeVerb::CookParms {
 public:
    CookParms(GU_DetailHandle& output, std::vector<GU_ConstDetailHandle> inputs, SOP_Node* node,
              const OP_Context& context, const SOP_NodeParms* parms, SOP_NodeCache* cache, UT_ErrorManager* error,
              DEP_MicroNode* dependency)
        : output_(output),
          inputs_(std::move(inputs)),
          node_(node),
          context_(context),
          parms_(parms),
          cache_(cache),
          error_(error),
          dependency_(dependency) {}

    GU_DetailHandle& gdh() const { return output_; }
    SOP_Node* getNode() const { return node_; }
    const OP_Context& getContext() const { return context_; }
    fpreal getCookTime() const { return context_.getTime(); }
    exint nInputs() const { return static_cast<exint>(inputs_.size()); }
    bool hasInput(exint index) const { return index < nInputs() && !at(index).isNull(); }
    const GU_Detail* inputGeo(exint index) const { return hasInput(index) ? at(index).gdp() : nullptr; }
    GU_ConstDetailHandle inputGeoHandle(exint index) const { return at(index); }
    template <typename T>
    const T& parms() const {
        return *static_cast<const T*>(parms_);
    }
    SOP_NodeCache* cache() const { return cache_; }
    UT_ErrorManager* error() const { return error_; }
    DEP_MicroNode* depnode() const { return dependency_; }

    void sopAddError(int code, const char* text = nullptr, const UT_SourceLocation* = nullptr) const {
        error_->add(UT_ERROR_ABORT, code, text);
    }
    void sopAddWarning(int code, const char* text = nullptr, const UT_SourceLocation* = nullptr) const {
        error_->add(UT_ERROR_WARNING, code, text);
    }
    void sopAddMessage(int code, const char* text = nullptr, const UT_SourceLocation* = nullptr) const {
        error_->add(UT_ERROR_MESSAGE, code, text);
    }

 private:
    const GU_ConstDetailHandle& at(exint index) const { return inputs_[static_cast<std::size_t>(index)]; }

    GU_DetailHandle& output_;
    std::vector<GU_ConstDetailHandle> inputs_;
    SOP_Node* node_;
    const OP_Context& context_;
    const SOP_NodeParms* parms_;
    SOP_NodeCache* cache_;
    UT_ErrorManager* error_;
    DEP_MicroNode* dependency_;
};
