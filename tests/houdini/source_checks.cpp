// The source: what it makes of points and of a mesh, and how the solver takes it.
#include <GA/GA_Handle.h>
#include <GEO/GEO_PrimVDB.h>

#include <algorithm>
#include <cmath>

#include "checks.h"
#include "scene.h"

using hdk_double::add_box;

namespace {

struct SourceScene {
    template <typename Build>
    explicit SourceScene(const Build& build, bool changes_with_time = false)
        : input(network.create_geometry("input", build, changes_with_time)),
          source(network.create("fontana::source::1.0", "source")) {
        source.setInput(0, &input);
        set_float(source, "particle_spacing", 0.05);
    }
    const GU_Detail& cook(double frame = 1) { return hdk_double::cook(source, frame); }

    hdk_double::Network network;
    SOP_Node& input;
    SOP_Node& source;
};

void box(GU_Detail& detail, fpreal) { add_box(detail, UT_Vector3(0, 0, 0), UT_Vector3(0.2f, 0.3f, 0.4f)); }

void a_closed_mesh_is_filled() {
    SourceScene scene(box);
    const GU_Detail& filled = scene.cook();
    CHECK(filled.getNumPoints() == 4 * 6 * 8 && filled.getNumPrimitives() == 0);
    for (const UT_Vector3& p : hdk_double::positions(filled))
        CHECK(p.x() > 0 && p.x() < 0.2f && p.y() > 0 && p.y() < 0.3f && p.z() > 0 && p.z() < 0.4f);
    set_float(scene.source, "particle_spacing", 0.1);
    CHECK(scene.cook().getNumPoints() == 2 * 3 * 4);
}

void overlapping_parts_count_once() {
    SourceScene scene([](GU_Detail& detail, fpreal) {
        add_box(detail, UT_Vector3(0, 0, 0), UT_Vector3(0.2f, 0.2f, 0.2f));
        add_box(detail, UT_Vector3(0.1f, 0, 0), UT_Vector3(0.3f, 0.2f, 0.2f));
    });
    CHECK(scene.cook().getNumPoints() == 6 * 4 * 4);
}

void an_open_mesh_is_refused() {
    SourceScene scene([](GU_Detail& detail, fpreal) {
        const GA_Offset first = detail.appendPointBlock(3);
        GA_Offset vertex;
        detail.appendPrimitivesAndVertices(GA_PRIMPOLY, 1, 3, vertex, true);
        for (int k = 0; k < 3; ++k) {
            detail.setPos3(first + k, UT_Vector3(k == 1, 0, k == 2));
            detail.getTopology().wireVertexPoint(vertex + k, first + k);
        }
    });
    CHECK(scene.cook().getNumPoints() == 0);
    CHECK(scene.source.error() == UT_ERROR_ABORT && contains(sentences(scene.source), "the mesh is open"));
}

// A level set of a ball, and a fog that fills a slab through it.
void vdbs_are_filled() {
    const UT_BoundingBox box(UT_Vector3(-0.5f, -0.5f, -0.5f), UT_Vector3(0.5f, 0.5f, 0.5f));
    const auto ball = [](const UT_Vector3& p) {
        return std::sqrt(static_cast<double>(p.x() * p.x() + p.y() * p.y() + p.z() * p.z())) - 0.4;
    };
    const auto slab = [](const UT_Vector3& p) { return std::abs(p.y()) < 0.1f ? 1.0 : 0.0; };
    SourceScene scene([&](GU_Detail& detail, fpreal) {
        detail.append(std::make_unique<GEO_PrimVDB>(detail, box, true, ball));
        detail.append(std::make_unique<GEO_PrimVDB>(detail, box, false, slab));
    });
    GA_Size expected = 0;
    for (int k = 0; k < 20 * 20 * 20; ++k) {
        const auto at = [](int index) { return 0.05f * (static_cast<float>(index - 10) + 0.5f); };
        const UT_Vector3 p(at(k % 20), at(k / 20 % 20), at(k / 400));
        expected += ball(p) < 0.0 || slab(p) > 0.0;
    }
    CHECK(expected > 2000 && scene.cook().getNumPoints() == expected);
}

void a_spacing_that_is_too_fine_is_refused() {
    SourceScene scene(
        [](GU_Detail& detail, fpreal) { add_box(detail, UT_Vector3(0, 0, 0), UT_Vector3(1000.0f, 1000.0f, 1000.0f)); });
    scene.cook();
    CHECK(contains(sentences(scene.source), "too fine"));
    set_float(scene.source, "particle_spacing", 0.0);
    scene.cook();
    CHECK(contains(sentences(scene.source), "expected metres above 0"));
}

void points_are_carried() {
    SourceScene scene([](GU_Detail& detail, fpreal) {
        add_block(detail, 3, 0.0f);
        detail.addFloatTuple(GA_ATTRIB_POINT, "v", 3, GA_Defaults(1.0));
        detail.addFloatTuple(GA_ATTRIB_POINT, "mass", 1, GA_Defaults(0.125));
        detail.addFloatTuple(GA_ATTRIB_POINT, "viscosity", 1, GA_Defaults(4.0));
        detail.addIntTuple(GA_ATTRIB_POINT, "phase", 1, GA_Defaults(2));
    });
    set_float(scene.source, "velocity", 0.5, 1);
    const GU_Detail& detail = scene.cook();
    const GA_Offset last = detail.pointOffset(26);
    CHECK(GA_ROHandleV3(&detail, GA_ATTRIB_POINT, "v").get(last) == UT_Vector3(1.0f, 1.5f, 1.0f));
    CHECK(GA_ROHandleF(&detail, GA_ATTRIB_POINT, "mass").get(last) == 0.125f);
    CHECK(GA_ROHandleF(&detail, GA_ATTRIB_POINT, "viscosity").get(last) == 4.0f);
    CHECK(GA_ROHandleI(&detail, GA_ATTRIB_POINT, "phase").get(last) == 2);
    set_int(scene.source, "set_mass", 1);
    set_float(scene.source, "mass", 0.25);
    CHECK(GA_ROHandleF(&scene.cook(), GA_ATTRIB_POINT, "mass").get(last) == 0.25f);
}

SOP_Node& solver_on(SourceScene& scene) {
    SOP_Node& solver = scene.network.create("fontana::solver::1.0", "solver");
    solver.setInput(0, &scene.source);
    set_int(solver, "use_gpu", 0);
    set_float(solver, "fluid_particle_spacing", 0.05);
    return solver;
}

void one_emission() {
    SourceScene scene(box);
    SOP_Node& solver = solver_on(scene);
    CHECK(hdk_double::cook(solver, 6).getNumPoints() == 4 * 6 * 8);
}

void continuous_emission() {
    SourceScene scene(box);
    set_int(scene.source, "emission", 1);
    set_float(scene.source, "velocity", 3.0, 0);
    SOP_Node& solver = solver_on(scene);
    std::vector<GA_Size> counts;
    std::vector<std::uint64_t> hashes;
    for (int frame = 1; frame <= 6; ++frame) {
        const GU_Detail& detail = hdk_double::cook(solver, frame);
        counts.push_back(detail.getNumPoints());
        hashes.push_back(hash_of(detail));
    }
    CHECK(counts.front() == 4 * 6 * 8 && counts.back() > counts.front() && counts.back() < 6 * counts.front());
    CHECK(std::is_sorted(counts.begin(), counts.end()));
    const GU_Detail& detail = hdk_double::cook(solver, 6);
    const GA_ROHandleF age(&detail, GA_ATTRIB_POINT, "age");
    CHECK(std::abs(age.get(detail.pointOffset(0)) - 5.0f / 24.0f) < 1e-6f);
    CHECK(age.get(detail.pointOffset(counts.back() - 1)) == 0.0f);
    for (const int frame : {2, 5, 3, 6})
        CHECK(hash_of(hdk_double::cook(solver, frame)) == hashes[static_cast<std::size_t>(frame - 1)]);
}

// A source that moves: a jump cooks the input at each frame on the way.
void a_jump_follows_a_moving_source() {
    const auto moving_box = [](GU_Detail& detail, fpreal time) {
        const auto x = static_cast<float>(time);
        add_box(detail, UT_Vector3(x, 0, 0), UT_Vector3(x + 0.1f, 0.1f, 0.1f));
    };
    std::vector<std::uint64_t> hashes;
    for (const bool jumps : {false, true}) {
        SourceScene scene(moving_box, true);
        set_int(scene.source, "emission", 1);
        SOP_Node& solver = solver_on(scene);
        for (int frame = jumps ? 9 : 1; frame <= 9; ++frame) hdk_double::cook(solver, frame);
        hashes.push_back(hash_of(hdk_double::cook(solver, 9)));
        CHECK(hdk_double::cook(solver, 9).getNumPoints() > 16);
    }
    CHECK(hashes[0] == hashes[1]);
}

void an_edit_of_a_moving_source_starts_over() {
    float size = 0.1f;
    SourceScene scene(
        [&size](GU_Detail& detail, fpreal time) {
            const auto x = static_cast<float>(time);
            add_box(detail, UT_Vector3(x, 0, 0), UT_Vector3(x + size, size, size));
        },
        true);
    set_int(scene.source, "emission", 1);
    SOP_Node& solver = solver_on(scene);
    const std::uint64_t small = hash_of(hdk_double::cook(solver, 6));
    size = 0.2f;
    scene.input.forceRecook();
    const GU_Detail& large = hdk_double::cook(solver, 6);
    CHECK(large.getNumPoints() >= 4 * 4 * 4);  // those of the start frame are large too
    size = 0.1f;
    scene.input.forceRecook();
    CHECK(hash_of(hdk_double::cook(solver, 6)) == small);
}

}  // namespace

void check_source() {
    a_closed_mesh_is_filled();
    overlapping_parts_count_once();
    an_open_mesh_is_refused();
    vdbs_are_filled();
    a_spacing_that_is_too_fine_is_refused();
    points_are_carried();
    one_emission();
    continuous_emission();
    a_jump_follows_a_moving_source();
    an_edit_of_a_moving_source_starts_over();
}
