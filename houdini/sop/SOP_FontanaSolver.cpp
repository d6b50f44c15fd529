#include "SOP_FontanaSolver.h"

#include <GU/GU_Detail.h>
#include <OP/OP_AutoLockInputs.h>
#include <PRM/PRM_ChoiceList.h>
#include <PRM/PRM_TemplateBuilder.h>
#include <UT/UT_InfoTree.h>

#include <cstdio>

#include "panel.h"
#include "points.h"

using namespace fontana::houdini;

const char* const SOP_FontanaSolver::type_name = "fontana::solver::1.0";

OP_Node* SOP_FontanaSolver::construct(OP_Network* network, const char* name, OP_Operator* entry) {
    return new SOP_FontanaSolver(network, name, entry);
}

PRM_Template* SOP_FontanaSolver::build_templates() {
    static PRM_ChoiceList devices(PRM_CHOICELIST_SINGLE, &SOP_FontanaSolver::list_devices);
    static PRM_TemplateBuilder builder("SOP_FontanaSolver.cpp"_sh, solver_dialog_script().c_str());
    if (builder.justBuilt()) {
        builder.setCallback("reset", &SOP_FontanaSolver::on_reset);
        builder.setChoiceListPtr("solver_device", &devices);
    }
    return builder.templates();
}

SOP_FontanaSolver::SOP_FontanaSolver(OP_Network* network, const char* name, OP_Operator* entry)
    : SOP_Node(network, name, entry) {
    mySopFlags.setManagesDataIDs(true);
}

SOP_FontanaSolver::~SOP_FontanaSolver() {
    session_.request_stop();
    const std::lock_guard<std::mutex> lock(cooking_);
}

const char* SOP_FontanaSolver::inputLabel(OP_InputIdx index) const {
    return static_cast<int>(index) == 0 ? "Sources" : "Colliders and forces (not read yet)";
}

int SOP_FontanaSolver::on_reset(void* node, int, fpreal64, const PRM_Template*) {
    static_cast<SOP_FontanaSolver*>(static_cast<OP_Node*>(node))->reset();
    return 1;
}

void SOP_FontanaSolver::reset() {
    session_.request_stop();
    {
        const std::lock_guard<std::mutex> lock(cooking_);
        session_.reset();
    }
    forceRecook();  // without the lock: it may cook at once
}

OP_ERROR SOP_FontanaSolver::cookMySop(OP_Context& context) {
    const std::lock_guard<std::mutex> lock(cooking_);
    try {
        if (evalInt("activation", 0, context.getTime()))
            simulate(context);
        else
            pass_through(context);
    } catch (const Interrupted&) {
        addWarning(SOP_MESSAGE, "interrupted");
    } catch (const std::exception& error) {  // none may reach Houdini
        addError(SOP_MESSAGE, error.what());
    }
    return error();
}

void SOP_FontanaSolver::pass_through(OP_Context& context) {
    OP_AutoLockInputs inputs(this);
    has_output_ = false;
    if (inputs.lock(context) >= UT_ERROR_ABORT) return;
    if (getInput(0))
        duplicateSource(0, context);
    else
        gdp->clearAndDestroy();
}

void SOP_FontanaSolver::simulate(OP_Context& context) {
    const double time = context.getTime();
    session_.set_memory_limit(static_cast<std::size_t>(evalInt("memory_limit", 0, time)) << 20);
    SolverHost host(*this, context, steady_input_);
    flags().setTimeDep(true);
    const CookResult result = session_.cook(frame_at(time), evalInt("start_frame", 0, time), host);
    if (result.status == CookStatus::failed) {
        addError(SOP_MESSAGE, result.sentence.c_str());
        return;
    }
    if (!result.sentence.empty()) addWarning(SOP_MESSAGE, result.sentence.c_str());
    shown_frame_ = result.frame;
    write_output();
}

// The points of an earlier cook stay where their number did not shrink: the viewport need not build them anew.
void SOP_FontanaSolver::make_points(GA_Size count) {
    const GA_Size present = gdp->getNumPoints();
    if (!has_output_ || present > count) gdp->clearAndDestroy();
    const GA_Size missing = count - gdp->getNumPoints();
    if (missing > 0) gdp->appendPointBlock(missing);
    gdp->addFloatTuple(GA_ATTRIB_POINT, "v", 3)->setTypeInfo(GA_TYPE_VECTOR);
    gdp->addTuple(GA_STORE_INT64, GA_ATTRIB_POINT, "id", 1, GA_Defaults(-1));
    for (const char* name : {"density", "pressure", "pscale", "age"}) gdp->addFloatTuple(GA_ATTRIB_POINT, name, 1);
    if (has_output_ && present == count) return;
    gdp->bumpDataIdsForAddOrRemove(true, false, false);
    std::vector<int64> ids(static_cast<std::size_t>(count));
    for (std::size_t k = 0; k < ids.size(); ++k) ids[k] = static_cast<int64>(k);
    write_by_page(*gdp, GA_RWHandleID(gdp, GA_ATTRIB_POINT, "id"), ids.data());
    shown_radius_ = -1.0;
}

void SOP_FontanaSolver::write_output() {
    const std::size_t count = session_.particle_count();
    make_points(static_cast<GA_Size>(count));
    std::vector<UT_Vector3F> vectors(count);
    std::vector<float> numbers(count);
    const auto vector = [&](const char* name, const char* attribute) {
        session_.read(attribute, vectors.data(), count * sizeof(UT_Vector3F));
        write_by_page(*gdp, GA_RWHandleV3(gdp, GA_ATTRIB_POINT, name), vectors.data());
    };
    vector("P", "position");
    vector("v", "velocity");
    for (const char* name : {"density", "pressure"}) {
        session_.read(name, numbers.data(), count * sizeof(float));
        write_by_page(*gdp, GA_RWHandleF(gdp, GA_ATTRIB_POINT, name), numbers.data());
    }
    write_by_page(*gdp, GA_RWHandleF(gdp, GA_ATTRIB_POINT, "age"), session_.ages().data());
    const double radius = session_.particle_radius();
    if (radius != shown_radius_) {
        numbers.assign(count, static_cast<float>(radius));
        write_by_page(*gdp, GA_RWHandleF(gdp, GA_ATTRIB_POINT, "pscale"), numbers.data());
    }
    shown_radius_ = radius;
    has_output_ = true;
}

void SOP_FontanaSolver::list_devices(void* node, PRM_Name* names, int room, const PRM_SpareData*, const PRM_Parm*) {
    const auto* solver = static_cast<SOP_FontanaSolver*>(static_cast<OP_Node*>(node));
    const PanelRow* backends = nullptr;
    for (const PanelRow& row : panel_rows())
        if (row.name == "solver_backend") backends = &row;
    const auto chosen = static_cast<std::size_t>(solver->evalInt("solver_backend", 0, 0.0));
    const std::string backend = backends->choices.at(chosen);
    const fontana_device* devices = nullptr;
    std::size_t count = 0;
    fontana_list_devices(&devices, &count);
    int index = 0;
    for (std::size_t k = 0; k < count && index + 1 < room; ++k) {
        if (backend != devices[k].backend) continue;
        const std::string label = devices[k].available ? std::string(devices[k].name)
                                                       : std::string(devices[k].name) + " - " + devices[k].reason;
        names[index].setTokenAndLabel(std::to_string(index).c_str(), label.c_str());  // copies; a constructor would not
        ++index;
    }
    if (index == 0 && room > 1) names[index++].setTokenAndLabel("0", "The first that is there");
    names[index].setAsSentinel();
}

void SOP_FontanaSolver::fillInfoTreeNodeSpecific(UT_InfoTree& tree, const OP_NodeInfoTreeParms& parms) {
    SOP_Node::fillInfoTreeNodeSpecific(tree, parms);
    const std::unique_lock<std::mutex> lock(cooking_, std::try_to_lock);
    if (!lock.owns_lock()) return;  // the panel is drawn while a cook runs: it comes with the next
    const FrameRecord* record = session_.record(shown_frame_);
    if (!record) return;
    UT_InfoTree* info = tree.addChildMap("Fontana");
    const auto line = [&](const char* name, const char* format, auto... values) {
        char text[200];
        std::snprintf(text, sizeof text, format, values...);
        info->addProperties(name, static_cast<const char*>(text));
    };
    const fontana_frame_report& r = record->report;
    line("Frame", "%lld", static_cast<long long>(shown_frame_));
    line("Particles", "%zu", record->particle_count);
    line("Substeps", "%u", r.substeps);
    line("Time step", "%.3g to %.3g ms, limited by %s", 1e3 * r.dt_min, 1e3 * r.dt_max, record->dt_limit.c_str());
    line("Iterations", "%u, %u solves not converged", r.iterations, r.unconverged);
    line("Density error", "%.3g %% mean, %.3g %% largest", 100.0 * r.density_error_mean, 100.0 * r.density_error_max);
    line("Time of the frame", "%.1f ms", 1e3 * r.seconds);
    line("Device", "%s", session_.device_name().c_str());
    line("Device memory", "%.1f MiB", static_cast<double>(session_.device_bytes()) / 1048576.0);
    line("History", "%zu frames, %.1f MiB", session_.history().frame_count(),
         static_cast<double>(session_.history().bytes()) / 1048576.0);
}
