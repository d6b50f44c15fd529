#include "SOP_Swirl.h"

#include <exception>
#include <string>
#include <vector>

#include <GA/GA_Handle.h>
#include <GA/GA_Iterator.h>
#include <GU/GU_Detail.h>
#include <OP/OP_AutoLockInputs.h>
#include <OP/OP_Operator.h>
#include <OP/OP_OperatorTable.h>
#include <PRM/PRM_Include.h>
#include <PRM/PRM_TemplateBuilder.h>
#include <UT/UT_DSOVersion.h>
#include <UT/UT_Interrupt.h>

#include "util/error.h"

// What Houdini calls when it has loaded the plugin.
void newSopOperator(OP_OperatorTable* table) {
    auto* entry = new OP_Operator("template::swirl::1.0", "Swirl", SOP_Swirl::construct, SOP_Swirl::panel(), 1, 1);
    entry->setIconName("SOP_swirl");
    table->addOperator(entry);
}

namespace {

const char* const theDsFile = R"THEDSFILE(
{
    name parameters
    parm {
        name    "device"
        label   "Device"
        type    string
        default { "auto" }
        menu    { "auto" "First GPU, else CPU" "cpu" "CPU" "opencl" "OpenCL" "cuda" "CUDA" }
    }
    parm {
        name    "angle"
        label   "Angle"
        type    float
        default { "90" }
        range   { -360 360 }
    }
    parm {
        name    "radius"
        label   "Radius"
        type    float
        default { "1" }
        range   { 0.01! 10 }
    }
    parm {
        name    "centre"
        label   "Centre"
        type    vector
        size    3
        default { "0" "0" "0" }
    }
    parm {
        name    "steps"
        label   "Steps"
        type    integer
        default { "32" }
        range   { 1! 256 }
    }
}
)THEDSFILE";

constexpr double k_radians_per_degree = 3.14159265358979323846 / 180.0;

// Calls visit(first offset, count, first index) for each run of offsets: those of a detail have gaps where points were
// deleted.
template <typename Visit>
void for_each_block(const GU_Detail& detail, const Visit& visit) {
    GA_Offset begin, end;
    std::size_t done = 0;
    for (GA_Iterator it(detail.getPointRange()); it.blockAdvance(begin, end);
         done += static_cast<std::size_t>(end - begin))
        visit(begin, end - begin, done);
}

}  // namespace

OP_Node* SOP_Swirl::construct(OP_Network* network, const char* name, OP_Operator* entry) {
    return new SOP_Swirl(network, name, entry);
}

PRM_Template* SOP_Swirl::panel() {
    static PRM_TemplateBuilder builder("SOP_Swirl.cpp"_sh, theDsFile);
    return builder.templates();
}

SOP_Swirl::SOP_Swirl(OP_Network* network, const char* name, OP_Operator* entry) : SOP_Node(network, name, entry) {
    mySopFlags.setManagesDataIDs(true);
}

// No exception may leave a cook: each becomes a message on the node.
OP_ERROR SOP_Swirl::cookMySop(OP_Context& context) {
    OP_AutoLockInputs inputs(this);
    if (inputs.lock(context) >= UT_ERROR_ABORT) return error();
    duplicateSource(0, context);
    try {
        move_points(context);
    } catch (const fontana::Error& trouble) {
        if (trouble.status() == FONTANA_DEVICE_LOST) device_.reset();  // the next cook starts it anew
        addError(SOP_MESSAGE, trouble.what());
    } catch (const std::exception& trouble) {
        addError(SOP_MESSAGE, trouble.what());
    }
    return error();
}

void SOP_Swirl::move_points(OP_Context& context) {
    UT_String backend;
    evalString(backend, "device", 0, context.getTime());
    if (!device_ || device_->backend_name() != backend.toStdString())
        device_ = std::make_unique<SwirlDevice>(backend.toStdString());

    std::vector<UT_Vector3F> position(static_cast<std::size_t>(gdp->getNumPoints()));
    const GA_RWHandleV3 points(gdp->getP());
    for_each_block(*gdp, [&](GA_Offset first, GA_Size count, std::size_t index) {
        points.getBlock(first, count, position.data() + index);
    });

    UT_AutoInterrupt progress("Swirl: moving points");
    const bool finished = device_->move(
        position.empty() ? nullptr : position.front().data(), position.size(), settings_at(context.getTime()),
        [&](double share) { return progress.wasInterrupted(static_cast<int>(100.0 * share)); });
    if (!finished) {
        addWarning(SOP_MESSAGE, "interrupted: the points are where they came in");
        return;
    }
    for_each_block(*gdp, [&](GA_Offset first, GA_Size count, std::size_t index) {
        points.setBlock(first, count, position.data() + index);
    });
    gdp->getP()->bumpDataId();
}

SwirlSettings SOP_Swirl::settings_at(fpreal time) const {
    SwirlSettings settings;
    settings.centre_x = static_cast<float>(evalFloat("centre", 0, time));
    settings.centre_z = static_cast<float>(evalFloat("centre", 2, time));
    settings.angle = static_cast<float>(k_radians_per_degree * evalFloat("angle", 0, time));
    settings.radius = static_cast<float>(evalFloat("radius", 0, time));
    settings.step_count = static_cast<int>(evalInt("steps", 0, time));
    // A panel's range does not bind an expression.
    if (!(settings.radius > 0.0f)) fontana::fail(FONTANA_BAD_INPUT, "Radius: expected more than 0");
    if (settings.step_count < 1) fontana::fail(FONTANA_BAD_INPUT, "Steps: expected 1 or more");
    return settings;
}
