// Bad input, Esc, full memory.
#include <GA/GA_Handle.h>

#include <cmath>

#include "checks.h"
#include "scene.h"

namespace {

std::string line_of(SOP_Node& node, const std::string& name) {
    const UT_InfoTree tree = hdk_double::info_of(node, 1);
    for (const UT_InfoTree& child : tree.children())
        for (const auto& [key, value] : child.rows())
            if (key == name) return value;
    return "";
}

void no_input() {
    BlockScene scene;
    scene.solver->setInput(0, nullptr);
    hdk_double::cook(*scene.solver, 3);
    CHECK(scene.solver->error() >= UT_ERROR_ABORT);
    scene.solver->setInput(0, scene.source);
    CHECK(hash_at(scene, 3) == played(3).back());
}

void an_empty_input_is_an_empty_frame() {
    BlockScene scene(0);
    CHECK(hdk_double::cook(*scene.solver, 5).getNumPoints() == 0);
    CHECK(scene.solver->error() == UT_ERROR_NONE);
    scene.side = 5;
    scene.edit();
    CHECK(hash_at(scene, 5) == played(5).back());
}

void a_position_that_is_no_number() {
    hdk_double::Network network;
    bool is_broken = true;
    SOP_Node& source = network.create_geometry("block", [&](GU_Detail& detail, fpreal) {
        add_block(detail, 5, 0.0f);
        if (is_broken) detail.setPos3(detail.pointOffset(7), UT_Vector3(0.0f, std::nanf(""), 0.0f));
    });
    BlockScene scene;
    scene.solver->setInput(0, &source);
    hdk_double::cook(*scene.solver, 3);
    CHECK(scene.solver->error() == UT_ERROR_ABORT);
    CHECK(contains(sentences(*scene.solver), "particle 7 is not a finite number"));
    is_broken = false;
    source.forceRecook();
    CHECK(hash_at(scene, 3) == played(3).back());
}

void a_value_out_of_bounds() {
    BlockScene scene;
    set_float(*scene.solver, "fluid_rest_density", -5.0);
    hdk_double::cook(*scene.solver, 2);
    CHECK(contains(sentences(*scene.solver), "fluid.rest_density"));
    set_float(*scene.solver, "fluid_rest_density", 1000.0);
    CHECK(hash_at(scene, 2) == played(2).back());
}

// Tiles are on the menu whatever the backend.
void a_scheme_that_the_backend_lacks() {
    BlockScene scene;
    set_int(*scene.solver, "solver_neighbors", 1);
    hdk_double::cook(*scene.solver, 2);
    CHECK(scene.solver->error() == UT_ERROR_ABORT);
    CHECK(contains(sentences(*scene.solver), "solver.neighbors=tiles is a choice of"));
    set_int(*scene.solver, "solver_neighbors", 0);
    CHECK(hash_at(scene, 2) == played(2).back());
}

// The points that are left, in a detail with gaps and in one without.
void deleted_points() {
    hdk_double::Network network;
    const auto build = [](GU_Detail& detail, bool with_gaps) {
        add_block(detail, 12, 0.0f);  // more than a page
        for (GA_Offset offset = 0; offset < 1500; offset += 7) detail.destroyPointOffset(offset);
        if (with_gaps) return;
        const std::vector<UT_Vector3> left = hdk_double::positions(detail);
        detail.clearAndDestroy();
        GA_Offset offset = detail.appendPointBlock(static_cast<GA_Size>(left.size()));
        for (const UT_Vector3& position : left) detail.setPos3(offset++, position);
    };
    std::uint64_t hashes[2];
    for (const bool with_gaps : {false, true}) {
        SOP_Node& source = network.create_geometry(with_gaps ? "gaps" : "compact",
                                                   [=](GU_Detail& detail, fpreal) { build(detail, with_gaps); });
        BlockScene scene;
        scene.solver->setInput(0, &source);
        const std::vector<UT_Vector3> start = hdk_double::positions(hdk_double::cook(*scene.solver, 1));
        CHECK(start.size() == 12 * 12 * 12 - 215 && start == hdk_double::positions(hdk_double::cook(source, 1)));
        hashes[with_gaps] = hash_at(scene, 3);
    }
    CHECK(hashes[0] == hashes[1]);
}

void an_interrupted_jump_goes_on() {
    BlockScene scene;
    hdk_double::interrupt_after(60);
    const GU_Detail& shown = hdk_double::cook(*scene.solver, 100000);
    hdk_double::interrupt_after(-1);
    CHECK(scene.solver->error() == UT_ERROR_WARNING);
    CHECK(contains(sentences(*scene.solver), "of 100000"));
    const int reached = std::atoi(line_of(*scene.solver, "Frame").c_str());
    CHECK(reached >= 3 && reached < 61);
    const std::vector<std::uint64_t> expected = played(reached + 3);
    CHECK(hash_of(shown) == expected[static_cast<std::size_t>(reached - 1)]);
    CHECK(hash_at(scene, reached + 3) == expected.back());
}

void an_interrupt_before_the_first_frame() {
    BlockScene scene;
    hdk_double::interrupt_after(1);
    hdk_double::cook(*scene.solver, 50);
    hdk_double::interrupt_after(-1);
    CHECK(scene.solver->error() == UT_ERROR_WARNING);
    CHECK(hash_at(scene, 4) == played(4).back());
}

// 4096 particles take some 250 kB a frame: of sixty frames a third fits.
void the_memory_limit() {
    const auto build = [](BlockScene& scene, int limit) {
        set_int(*scene.solver, "memory_limit", limit);
        set_int(*scene.solver, "time_substeps", 1);
        set_float(*scene.solver, "time_frame_rate", 4000.0);
        set_float(*scene.solver, "fluid_viscosity", 0.1);
    };
    BlockScene free(16), tight(16);
    build(free, 4096);
    build(tight, 5);
    const std::uint64_t at_31 = hash_at(free, 31), at_60 = hash_at(free, 60);
    CHECK(free.solver->error() == UT_ERROR_NONE);
    CHECK(hash_at(tight, 60) == at_60);
    CHECK(contains(sentences(*tight.solver), "the memory limit is reached: every frame in 4 is kept"));
    const std::string history = line_of(*tight.solver, "History");
    CHECK(std::atoi(history.c_str()) < 25 && (contains(history, "frames, 3.") || contains(history, "frames, 4.")));
    CHECK(hash_at(tight, 31) == at_31);
    CHECK(hash_at(tight, 60) == at_60);
}

}  // namespace

void check_faults() {
    no_input();
    an_empty_input_is_an_empty_frame();
    a_position_that_is_no_number();
    a_value_out_of_bounds();
    a_scheme_that_the_backend_lacks();
    deleted_points();
    an_interrupted_jump_goes_on();
    an_interrupt_before_the_first_frame();
    the_memory_limit();
}
