#include "hdk_double/hdk_double.h"

#include <dlfcn.h>

#include <array>
#include <atomic>
#include <stdexcept>

#include "GA/GA_PrimitiveTypes.h"
#include "UT/UT_Interrupt.h"

namespace hdk_double {
namespace {

std::atomic<int> polls_left{-1};

class GeometryNode final : public SOP_Node {
 public:
    using Build = std::function<void(GU_Detail&, fpreal)>;
    GeometryNode(const char* name, Build build, bool changes_with_time)
        : SOP_Node(nullptr, name, nullptr), build_(std::move(build)), changes_with_time_(changes_with_time) {}

 protected:
    OP_ERROR cookMySop(OP_Context& context) override {
        flags().setTimeDep(changes_with_time_);
        gdp->clearAndDestroy();
        build_(*gdp, context.getTime());
        return error();
    }

 private:
    Build build_;
    bool changes_with_time_;
};

}  // namespace

OP_OperatorTable& operators() {
    static OP_OperatorTable table;
    return table;
}

void load_plugin(const std::string& path) {
    void* library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!library) throw std::runtime_error(dlerror());
    const auto ask = reinterpret_cast<void (*)(const char**)>(dlsym(library, "HoudiniDSOVersion"));
    const char* built_for = "nothing";
    if (ask) ask(&built_for);
    if (std::string(built_for) != "double") throw std::runtime_error(path + " is built for " + built_for);
    const auto enter = reinterpret_cast<void (*)(OP_OperatorTable*)>(dlsym(library, "newSopOperator"));
    if (!enter) throw std::runtime_error(path + " has no newSopOperator");
    enter(&operators());
}

SOP_Node& Network::create(const std::string& type, const std::string& name) {
    OP_Operator* entry = operators().getOperator(type.c_str());
    if (!entry) throw std::runtime_error("no operator '" + type + "'");
    std::unique_ptr<SOP_Node>& place = nodes_[name];
    place.reset(entry->construct(nullptr, name.c_str())->castToSOPNode());
    return *place;
}

SOP_Node& Network::create_geometry(const std::string& name, std::function<void(GU_Detail&, fpreal)> build,
                                   bool changes_with_time) {
    std::unique_ptr<SOP_Node>& place = nodes_[name];
    place = std::make_unique<GeometryNode>(name.c_str(), std::move(build), changes_with_time);
    return *place;
}

bool Network::destroy(SOP_Node& node) {
    if (node.isCooking(true)) return false;
    for (auto& [name, other] : nodes_)
        for (int k = 0; k < other->nInputs(); ++k)
            if (other->getInput(static_cast<OP_InputIdx>(k)) == &node)
                other->setInput(static_cast<OP_InputIdx>(k), nullptr);
    nodes_.erase(node.getName().toStdString());
    return true;
}

fpreal time_of(fpreal frame) { return CHgetManager()->time_of_sample(frame); }

const GU_Detail& cook(SOP_Node& node, fpreal frame) {
    OP_Context context(time_of(frame));
    return *node.getCookedGeoHandle(context).gdp();
}

void press(SOP_Node& node, const std::string& button) {
    const PRM_Template& parm = node.template_of(button);
    PRM_Callback callback = parm.callback;
    if (callback.isNull()) throw std::runtime_error("the button '" + button + "' does nothing");
    callback(static_cast<OP_Node*>(&node), 0, 0.0, &parm);
}

std::vector<std::pair<std::string, std::string>> menu_of(SOP_Node& node, const std::string& parameter) {
    const PRM_Template& parm = node.template_of(parameter);
    if (!parm.choices) return parm.menu;
    std::array<PRM_Name, 100> names;
    parm.choices->getChoiceGenerator()(static_cast<OP_Node*>(&node), names.data(), static_cast<int>(names.size()),
                                       nullptr, nullptr);
    std::vector<std::pair<std::string, std::string>> menu;
    for (const PRM_Name& name : names) {
        if (!name.getToken()) break;
        menu.emplace_back(name.getToken(), name.getLabel());
    }
    return menu;
}

UT_InfoTree info_of(SOP_Node& node, fpreal frame) {
    UT_InfoTree tree;
    node.fillInfoTreeNodeSpecific(tree, OP_NodeInfoTreeParms(time_of(frame)));
    return tree;
}

void interrupt_after(int polls) { polls_left = polls; }

std::vector<UT_Vector3> positions(const GU_Detail& detail) {
    std::vector<UT_Vector3> result;
    for (GA_Iterator it(detail.getPointRange()); !it.atEnd(); ++it) result.push_back(detail.getPos3(*it));
    return result;
}

void add_box(GU_Detail& detail, const UT_Vector3& low, const UT_Vector3& high) {
    const GA_Offset first = detail.appendPointBlock(8);
    for (int k = 0; k < 8; ++k)
        detail.setPos3(first + k,
                       UT_Vector3(k & 1 ? high.x() : low.x(), k & 2 ? high.y() : low.y(), k & 4 ? high.z() : low.z()));
    const int faces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (const auto& face : faces) {
        GA_Offset vertex;
        detail.appendPrimitivesAndVertices(GA_PRIMPOLY, 1, 4, vertex, true);
        for (int k = 0; k < 4; ++k) detail.getTopology().wireVertexPoint(vertex + k, first + face[k]);
    }
}

}  // namespace hdk_double

UT_Interrupt* UTgetInterrupt() {
    static UT_Interrupt interrupt;
    return &interrupt;
}

int UT_Interrupt::opStart(const char*, int, int, int*) { return 1; }
void UT_Interrupt::opEnd(int) {}

int UT_Interrupt::opInterrupt(int) {
    int left = hdk_double::polls_left;
    while (left > 0 && !hdk_double::polls_left.compare_exchange_weak(left, left - 1)) {
    }
    return left == 0 || left == 1;
}

UT_AutoInterrupt::UT_AutoInterrupt(const char* operation_name, UT_Interrupt* boss) : boss_(boss) {
    boss_->opStart(operation_name, 0, 0, &id_);
}
UT_AutoInterrupt::~UT_AutoInterrupt() { boss_->opEnd(id_); }
