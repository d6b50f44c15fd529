// Nodes of the double: wiring, cooking, operators.
#include <algorithm>
#include <stdexcept>

#include "OP/OP_AutoLockInputs.h"
#include "OP/OP_Director.h"
#include "OP/OP_OperatorTable.h"
#include "SOP/SOP_NodeVerb.h"

CH_Manager* CHgetManager() {
    static CH_Manager manager;
    return &manager;
}

OP_Director* OPgetDirector() {
    static OP_Director director;
    return &director;
}

UT_ErrorSeverity UT_ErrorManager::getSeverity() const {
    UT_ErrorSeverity worst = UT_ERROR_NONE;
    for (const Entry& entry : entries_) worst = std::max(worst, entry.severity);
    return worst;
}

void UT_ErrorManager::add(UT_ErrorSeverity severity, int code, const char* text) {
    entries_.push_back({severity, code, text ? text : ""});
}

OP_Operator::OP_Operator(const char* name, const char* english, OP_Constructor constructor, PRM_Template* templates,
                         unsigned min_sources, unsigned max_sources, CH_LocalVariable*, unsigned,
                         const char** input_labels, int, const char*)
    : name_(name),
      english_(english),
      construct_(constructor),
      templates_(templates),
      min_sources_(min_sources),
      max_sources_(max_sources) {
    for (; input_labels && *input_labels; ++input_labels) input_labels_.emplace_back(*input_labels);
}

const char* OP_Operator::input_label(std::size_t index) const {
    return index < input_labels_.size() ? input_labels_[index].c_str() : "Input";
}

bool OP_OperatorTable::addOperator(OP_Operator* entry, std::ostream*) {
    return operators_.emplace(entry->name().toStdString(), std::unique_ptr<OP_Operator>(entry)).second;
}

OP_Operator* OP_OperatorTable::getOperator(const char* name) const {
    const auto found = operators_.find(name);
    return found == operators_.end() ? nullptr : found->second.get();
}

OP_Node::OP_Node(OP_Network*, const char* name, OP_Operator* entry)
    : OP_Parameters(entry ? entry->templates() : nullptr), name_(name), operator_(entry) {}
OP_Node::~OP_Node() = default;

OP_Node* OP_Node::getInput(OP_InputIdx index) const {
    const auto k = static_cast<std::size_t>(index);
    return k < inputs_.size() ? inputs_[k] : nullptr;
}

OP_ERROR OP_Node::setInput(OP_InputIdx index, OP_Node* input) {
    const auto k = static_cast<std::size_t>(index);
    if (operator_ && k >= operator_->max_sources()) return UT_ERROR_ABORT;
    if (k >= inputs_.size()) inputs_.resize(k + 1);
    inputs_[k] = input;
    locked_.resize(inputs_.size());
    is_dirty_ = true;
    return UT_ERROR_NONE;
}

const char* OP_Node::inputLabel(OP_InputIdx index) const {
    return operator_ ? operator_->input_label(static_cast<std::size_t>(index)) : "Input";
}

bool OP_Node::is_locked(OP_InputIdx index) const { return locked_.at(static_cast<std::size_t>(index)); }
void OP_Node::set_locked(OP_InputIdx index, bool locked) { locked_.at(static_cast<std::size_t>(index)) = locked; }
void OP_Node::forceRecook() { is_dirty_ = true; }
bool OP_Node::isCooking(bool) const { return cooks_under_way_ > 0; }

bool OP_Node::needs_cook(const OP_Context& context) const {
    if (is_dirty_ || (flags_.getTimeDep() && context.getTime() != cooked_time_)) return true;
    for (std::size_t k = 0; k < inputs_.size(); ++k)
        if (inputs_[k] && (inputs_[k]->needs_cook(context) || k >= input_cook_counts_.size() ||
                           inputs_[k]->cook_count_ != input_cook_counts_[k]))
            return true;
    return false;
}

OP_ERROR OP_Node::ensure_cooked(OP_Context& context) {
    if (!needs_cook(context)) return error();
    errors_.clear();
    is_dirty_ = reads_time_ = has_read_keys_ = false;
    flags_.setTimeDep(false);
    const auto wired = static_cast<unsigned>(
        std::count_if(inputs_.begin(), inputs_.end(), [](const OP_Node* input) { return input != nullptr; }));
    if (operator_ && wired < operator_->min_sources()) {
        errors_.add(UT_ERROR_ABORT, 0, "Not enough sources specified.");
        return error();
    }
    ++cooks_under_way_;
    try {
        cook_me(context);
    } catch (...) {
        --cooks_under_way_;
        throw;
    }
    --cooks_under_way_;
    if (reads_time_ || has_read_keys_) flags_.setTimeDep(true);
    cooked_time_ = context.getTime();
    ++cook_count_;
    input_cook_counts_.clear();
    for (const OP_Node* input : inputs_) input_cook_counts_.push_back(input ? input->cook_count_ : 0);
    return error();
}

OP_ERROR OP_AutoLockInputs::lock(OP_Context& context) {
    OP_ERROR worst = UT_ERROR_NONE;
    for (int k = 0; k < node_->nInputs(); ++k)
        if (node_->getInput(static_cast<OP_InputIdx>(k))) worst = std::max(worst, lockInput(k, context));
    return worst;
}

OP_ERROR OP_AutoLockInputs::lockInput(exint input, OP_Context& context) {
    OP_Node* source = node_->getInput(static_cast<OP_InputIdx>(input));
    if (!source) return UT_ERROR_ABORT;
    const OP_ERROR worst = source->ensure_cooked(context);
    if (source->flags().getTimeDep()) node_->note_time_dependent_input();
    node_->set_locked(static_cast<OP_InputIdx>(input), true);
    locked_.push_back(input);
    return worst;
}

void OP_AutoLockInputs::unlock() {
    for (const exint input : locked_) node_->set_locked(static_cast<OP_InputIdx>(input), false);
    locked_.clear();
}

void OP_AutoLockInputs::unlockInput(exint input) {
    node_->set_locked(static_cast<OP_InputIdx>(input), false);
    locked_.erase(std::remove(locked_.begin(), locked_.end(), input), locked_.end());
}

SOP_Node::SOP_Node(OP_Network* network, const char* name, OP_Operator* entry)
    : OP_Node(network, name, entry), gdp(new GU_Detail) {
    handle_.allocateAndSet(gdp);
}

SOP_Node::~SOP_Node() { delete cache_; }

GU_DetailHandle SOP_Node::getCookedGeoHandle(OP_Context& context) {
    ensure_cooked(context);
    return handle_;
}

// Houdini's answer is undefined for an input that is not locked; the double's is an exception.
const GU_Detail* SOP_Node::inputGeo(OP_InputIdx index) const {
    OP_Node* input = getInput(index);
    if (!input) return nullptr;
    if (!is_locked(index)) throw std::logic_error("double: the geometry of an input that is not locked");
    return input->castToSOPNode()->gdp;
}

const GU_Detail* SOP_Node::inputGeo(OP_InputIdx index, const OP_Context&) const { return inputGeo(index); }

OP_ERROR SOP_Node::duplicateSource(OP_InputIdx index, OP_Context&) {
    gdp->replaceWith(*inputGeo(index));
    return error();
}

OP_ERROR SOP_Node::cook_me(OP_Context& context) {
    cookMySop(context);
    if (!mySopFlags.getManagesDataIDs()) gdp->bumpAllDataIds();
    return error();
}

OP_ERROR SOP_Node::cookMyselfAsVerb(OP_Context& context) {
    OP_AutoLockInputs inputs(this);
    if (inputs.lock(context) >= UT_ERROR_ABORT) return error();
    const SOP_NodeVerb* verb = cookVerb();
    const std::unique_ptr<SOP_NodeParms> parms(verb->allocParms());
    DEP_MicroNode dependency;
    const OP_GraphProxy proxy(*this);
    parms->buildFromOp(&proxy, 0, context.getTime(), &dependency);
    std::vector<GU_ConstDetailHandle> handles;
    for (int k = 0; k < nInputs(); ++k) {
        OP_Node* input = getInput(static_cast<OP_InputIdx>(k));
        handles.push_back(input ? input->castToSOPNode()->handle_ : GU_ConstDetailHandle());
    }
    const SOP_NodeVerb::CookMode mode = verb->cookMode(parms.get());
    if (mode == SOP_NodeVerb::COOK_GENERATOR) gdp->clearAndDestroy();
    if (mode == SOP_NodeVerb::COOK_DUPLICATE || mode == SOP_NodeVerb::COOK_INPLACE) gdp->replaceWith(*inputGeo(0));
    if (!cache_) cache_ = verb->allocCache();
    verb->cook(SOP_NodeVerb::CookParms(handle_, std::move(handles), this, context, parms.get(), cache_,
                                       &error_manager(), &dependency));
    if (dependency.isTimeDependent()) note_time_dependent_input();
    return error();
}
