// What a test or a benchmark does in place of Houdini: load the plugin, wire nodes, move the playbar, press Esc.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "OP/OP_OperatorTable.h"
#include "SOP/SOP_Node.h"

namespace hdk_double {

// Opens the plugin as Houdini does, asks what it was built for and lets it register its operators; throws
// std::runtime_error if it cannot.
void load_plugin(const std::string& path);
OP_OperatorTable& operators();

// Nodes side by side; they go with it.
class Network {
 public:
    SOP_Node& create(const std::string& type, const std::string& name);
    // A node whose geometry `build` makes, anew for each time where `changes_with_time`.
    SOP_Node& create_geometry(const std::string& name, std::function<void(GU_Detail&, fpreal time)> build,
                              bool changes_with_time = false);
    // Refused (false) while the node cooks, as Houdini's own network does.
    bool destroy(SOP_Node& node);

 private:
    std::map<std::string, std::unique_ptr<SOP_Node>> nodes_;
};

// Time in seconds of a frame, and the node's geometry there.
fpreal time_of(fpreal frame);
const GU_Detail& cook(SOP_Node& node, fpreal frame);

void press(SOP_Node& node, const std::string& button);
// The menu of a parameter as it is now: tokens and labels.
std::vector<std::pair<std::string, std::string>> menu_of(SOP_Node& node, const std::string& parameter);
UT_InfoTree info_of(SOP_Node& node, fpreal frame);

// The user presses Esc when the plugin asks for the `polls`-th time from now on, on whatever thread; -1: never.
void interrupt_after(int polls);

// Points as they are in the detail, in order of index.
std::vector<UT_Vector3> positions(const GU_Detail& detail);
// Appends a box of six closed polygons.
void add_box(GU_Detail& detail, const UT_Vector3& low, const UT_Vector3& high);

}  // namespace hdk_double
