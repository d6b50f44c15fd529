#include "solver_host.h"

#include <GU/GU_Detail.h>
#include <OP/OP_AutoLockInputs.h>
#include <OP/OP_Director.h>
#include <SOP/SOP_Node.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "frame_keys.h"
#include "panel.h"
#include "points.h"

namespace fontana::houdini {
namespace {

const char* const collider_parms[] = {
    "collider_enable",     "collider_type",   "collider_flip",      "collider_centre",     "collider_radius",
    "collider_use_cutoff", "collider_cutoff", "collider_thickness", "collider_elasticity", "collider_friction"};

std::vector<std::int64_t> data_ids(const GU_Detail& detail) {
    std::vector<std::int64_t> ids = {detail.getNumPoints()};
    for (const char* name : {"P", "v", "mass", continuous_attribute}) {
        const GA_Attribute* attribute = detail.findPointAttribute(name);
        ids.push_back(attribute ? attribute->getDataId() : GA_INVALID_DATAID - 1);
    }
    return ids;
}

bool are_known(const std::vector<std::int64_t>& ids) {
    return std::find(ids.begin(), ids.end(), GA_INVALID_DATAID) == ids.end();
}

}  // namespace

std::int64_t frame_at(double time) { return std::llround(OP_Context(time).getFloatFrame()); }

double time_at(std::int64_t frame) {
    OP_Context context(0.0);
    context.setFrame(static_cast<double>(frame));
    return context.getTime();
}

SolverHost::SolverHost(SOP_Node& node, const OP_Context& context, SteadyInput& steady)
    : node_(node), context_(context), steady_(steady), boss_("Fontana: simulating") {
    UT_String group;
    node_.evalString(group, "source_group", 0, context.getTime());
    group_ = group.toStdString();
    look_at_input();
}

template <typename Read>
void SolverHost::with_input(std::int64_t frame, const Read& read) {
    if (!node_.getInput(0)) return;
    OP_Context context(context_);
    context.setFrame(static_cast<double>(frame));
    OP_AutoLockInputs inputs(&node_);
    if (inputs.lockInput(0, context) >= UT_ERROR_ABORT) {
        if (boss_.wasInterrupted()) throw Interrupted();
        throw std::runtime_error("the first input does not cook at frame " + std::to_string(frame));
    }
    if (const GU_Detail* detail = node_.inputGeo(0, context)) read(*detail);
}

// At the frame of the cook. Only after the input has cooked is it known whether it changes with time.
void SolverHost::look_at_input() {
    is_steady_ = true;
    bool is_there = false;
    with_input(frame_at(context_.getTime()), [&](const GU_Detail& detail) {
        is_there = true;
        is_steady_ = !node_.getInput(0)->flags().getTimeDep();
        const std::vector<std::int64_t> ids = data_ids(detail);
        if (!is_steady_ || (ids == steady_.data_ids && group_ == steady_.group && are_known(ids))) return;
        steady_ = {ids, group_, read_points(detail, group_, PointsWanted::all),
                   read_points(detail, group_, PointsWanted::continuous), 0};
    });
    if (!is_there) steady_ = {};
    // 0 would mean that the points change.
    if (is_steady_ && steady_.key == 0)
        steady_.key = std::max<std::uint64_t>(1, key_of(steady_.all) ^ (key_of(steady_.continuous) << 1));
}

SourcePoints SolverHost::points(std::int64_t frame, PointsWanted wanted) {
    if (is_steady_) return wanted == PointsWanted::all ? steady_.all : steady_.continuous;
    SourcePoints points;
    with_input(frame, [&](const GU_Detail& detail) { points = read_points(detail, group_, wanted); });
    return points;
}

bool SolverHost::is_interrupted(double fraction) { return boss_.wasInterrupted(static_cast<int>(100.0 * fraction)); }

bool SolverHost::is_keyed(std::size_t row) const {
    const PanelRow& r = panel_rows()[row];
    const std::string name = r.parameter.name;
    if (name == "time.frame_rate" && node_.isParmTimeDependent("use_scene_rate")) return true;
    if (name == "solver.backend" && node_.isParmTimeDependent("use_gpu")) return true;
    return node_.isParmTimeDependent(r.name.c_str());
}

Setting SolverHost::read_setting(std::size_t row, double time) const {
    const PanelRow& r = panel_rows()[row];
    const fontana_parameter& p = r.parameter;
    Setting setting;
    setting.name = p.name;
    setting.is_keyed = is_keyed(row);
    if (p.type == FONTANA_CHOICE) {
        const exint index = node_.evalInt(r.name.c_str(), 0, time);
        const exint last = static_cast<exint>(r.choices.size()) - 1;
        setting.text = r.choices[static_cast<std::size_t>(std::clamp<exint>(index, 0, last))];
    } else {
        setting.count = p.type == FONTANA_VECTOR ? 3 : 1;
        for (std::size_t k = 0; k < setting.count; ++k)
            setting.numbers[k] = p.type == FONTANA_INT || p.type == FONTANA_BOOL
                                     ? static_cast<double>(node_.evalInt(r.name.c_str(), 0, time))
                                     : node_.evalFloat(r.name.c_str(), static_cast<int>(k), time);
    }
    if (setting.name == "solver.backend" && !node_.evalInt("use_gpu", 0, time)) setting.text = "cpu";
    if (setting.name == "time.frame_rate" && node_.evalInt("use_scene_rate", 0, time))
        setting.numbers[0] = OPgetDirector()->getChannelManager()->getSamplesPerSec();
    return setting;
}

bool SolverHost::is_collider_keyed(int instance) const {
    if (node_.isParmTimeDependent("colliders")) return true;  // their number is keyed
    return std::any_of(std::begin(collider_parms), std::end(collider_parms), [&](const char* name) {
        return node_.isParmTimeDependent((name + std::to_string(instance)).c_str());
    });
}

ColliderSetting SolverHost::read_collider(int instance, std::int64_t frame) const {
    const double time = time_at(frame), before = time_at(frame - 1);
    const auto number = [&](const char* name, int component, double t) {
        return node_.evalFloatInst(name, &instance, component, t);
    };
    const auto whole = [&](const char* name) { return static_cast<int>(node_.evalIntInst(name, &instance, 0, time)); };
    ColliderSetting collider;
    fontana_collider& s = collider.surface;
    const int type = std::clamp<int>(whole("collider_type#"), FONTANA_PLANE_X, FONTANA_CYLINDER_OUTSIDE);
    fontana_collider_defaults(static_cast<fontana_collider_type>(type), &s);
    s.enabled = whole("collider_enable#");
    s.flip = whole("collider_flip#");
    for (int k = 0; k < 3; ++k) {
        s.centre[k] = number("collider_centre#", k, time);
        collider.centre_before[static_cast<std::size_t>(k)] = number("collider_centre#", k, before);
    }
    s.radius = number("collider_radius#", 0, time);
    if (whole("collider_use_cutoff#")) s.cutoff = number("collider_cutoff#", 0, time);
    const double thickness = number("collider_thickness#", 0, time);
    s.thickness = thickness == 0.0 ? std::numeric_limits<double>::infinity() : thickness;
    s.elasticity = number("collider_elasticity#", 0, time);
    s.friction = number("collider_friction#", 0, time);
    collider.is_keyed = is_collider_keyed(instance);
    return collider;
}

FrameSettings SolverHost::read_settings(std::int64_t frame, bool keyed_only) const {
    const double time = time_at(frame);
    FrameSettings result;
    for (std::size_t row = 0; row < panel_rows().size(); ++row)
        if (!keyed_only || is_keyed(row)) result.settings.push_back(read_setting(row, time));
    const exint collider_count = node_.evalInt("colliders", 0, time);
    for (int instance = 1; instance <= collider_count; ++instance)
        if (!keyed_only || is_collider_keyed(instance)) result.colliders.push_back(read_collider(instance, frame));
    return result;
}

}  // namespace fontana::houdini
