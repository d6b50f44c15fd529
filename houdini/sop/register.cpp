// What Houdini calls when it loads the plugin.
#include <OP/OP_Operator.h>
#include <OP/OP_OperatorTable.h>
#include <UT/UT_DSOVersion.h>  // in one file of the plugin only

#include "SOP_FontanaSolver.h"
#include "source_node.h"

void newSopOperator(OP_OperatorTable* table) {
    const char* const submenu = "Simulation/Fontana";
    auto* source = new OP_Operator(SOP_FontanaSourceNode::type_name, "Fontana Source", SOP_FontanaSourceNode::construct,
                                   SOP_FontanaSourceNode::build_templates(), 1, 1, nullptr, 0, nullptr, 1, submenu);
    source->setIconName("fontana_source");
    table->addOperator(source);
    auto* solver = new OP_Operator(SOP_FontanaSolver::type_name, "Fontana Solver", SOP_FontanaSolver::construct,
                                   SOP_FontanaSolver::build_templates(), 1, 2, nullptr, 0, nullptr, 1, submenu);
    solver->setIconName("fontana_solver");
    table->addOperator(solver);
}
