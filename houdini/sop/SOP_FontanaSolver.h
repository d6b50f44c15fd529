// fontana::solver: the live simulation as a node. It has no cookVerb(), so it stays out of compiled blocks: a verb sees
// its inputs at one time only, and its cache is not the node's there.
#pragma once

#include <OP/OP_Node.h>
#include <SOP/SOP_Node.h>
#include <SYS/SYS_Version.h>

#include <mutex>

#include "session.h"
#include "solver_host.h"

#if SYS_VERSION_MAJOR_INT < 21
using OP_InputIdx = unsigned;
#else
#include <OP/OP_DataTypes.h>
#endif

class PRM_Name;
class PRM_Parm;
class PRM_SpareData;
class PRM_Template;

class SOP_FontanaSolver final : public SOP_Node {
 public:
    static const char* const type_name;
    static OP_Node* construct(OP_Network* network, const char* name, OP_Operator* entry);
    static PRM_Template* build_templates();

    void fillInfoTreeNodeSpecific(UT_InfoTree& tree, const OP_NodeInfoTreeParms& parms) override;
    const char* inputLabel(OP_InputIdx index) const override;

 protected:
    SOP_FontanaSolver(OP_Network* network, const char* name, OP_Operator* entry);
    // Ends a cook that another thread may be in, and waits for it.
    ~SOP_FontanaSolver() override;
    OP_ERROR cookMySop(OP_Context& context) override;

 private:
    static int on_reset(void* node, int index, fpreal64 time, const PRM_Template* parm);
    static void list_devices(void* node, PRM_Name* names, int room, const PRM_SpareData*, const PRM_Parm*);

    void reset();
    void pass_through(OP_Context& context);
    void simulate(OP_Context& context);
    void write_output();
    void make_points(GA_Size count);

    fontana::houdini::Session session_;
    fontana::houdini::SteadyInput steady_input_;
    std::mutex cooking_;       // Houdini may ask for the node from more than one thread
    bool has_output_ = false;  // gdp holds particles of an earlier cook and nothing else
    std::int64_t shown_frame_ = 0;
    double shown_radius_ = 0.0;  // pscale in gdp
};
