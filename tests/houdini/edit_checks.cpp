// What an edit does: the frame afterwards is that of a scene that had always been so, and an undo brings the old bytes.
#include <GA/GA_Handle.h>

#include <functional>

#include "checks.h"
#include "fontana.h"
#include "scene.h"

namespace {

constexpr int frame = 7;
using Change = std::function<void(BlockScene&)>;

std::uint64_t fresh(const Change& change, bool changes_with_time = false) {
    BlockScene scene(5, changes_with_time);
    change(scene);
    return hash_at(scene, frame);
}

void nothing(BlockScene&) {}

void check_change(const char* what, const Change& change, const Change& undo) {
    BlockScene scene;
    const std::uint64_t before = hash_at(scene, frame);
    CHECK(before == fresh(nothing));
    change(scene);
    const std::uint64_t after = hash_at(scene, frame);
    if (after == before) std::fprintf(stderr, "%s has no effect\n", what);
    CHECK(after != before);
    CHECK(after == fresh(change));
    undo(scene);
    CHECK(hash_at(scene, frame) == before);
}

Change sets(const char* name, double value, int component = 0) {
    return [=](BlockScene& scene) { set_float(*scene.solver, name, value, component); };
}

Change keys(const char* name, double at_1, double at_10, int component = 0) {
    return [=](BlockScene& scene) {
        scene.solver->set_key(name, component, hdk_double::time_of(1), at_1);
        scene.solver->set_key(name, component, hdk_double::time_of(10), at_10);
    };
}

Change unkeys(const char* name) {
    return [=](BlockScene& scene) { scene.solver->clear_keys(name); };
}

Change lifts(float lift) {
    return [=](BlockScene& scene) {
        scene.lift = lift;
        scene.edit();
    };
}

void parameters() {
    check_change("viscosity", sets("fluid_viscosity", 20.0), sets("fluid_viscosity", 2.0));
    check_change("gravity", sets("forces_gravity", -30.0, 1), sets("forces_gravity", -9.81, 1));
    check_change("a first key", keys("fluid_viscosity", 2.0, 30.0), unkeys("fluid_viscosity"));
}

void keys_of_a_keyed_parameter() {
    const Change weak = keys("forces_gravity", -9.81, -30.0, 1), strong = keys("forces_gravity", -9.81, -90.0, 1);
    BlockScene scene;
    weak(scene);
    const std::uint64_t before = hash_at(scene, frame);
    CHECK(before == fresh(weak));
    strong(scene);
    const std::uint64_t after = hash_at(scene, frame);
    CHECK(after == fresh(strong) && after != before);
    weak(scene);
    CHECK(hash_at(scene, frame) == before);
    hash_at(scene, 12);
    CHECK(hash_at(scene, frame) == before);
}

void colliders() {
    check_change("removing a collider", sets("colliders", 0.0), sets("colliders", 1.0));
    check_change("switching a collider off", sets("collider_enable1", 0.0), sets("collider_enable1", 1.0));
    check_change("raising the floor", sets("collider_centre1", 0.1, 1), sets("collider_centre1", floor_height, 1));
    check_change("a moving floor", keys("collider_centre1", 0.0, 0.3, 1), unkeys("collider_centre1"));
    check_change(
        "a floor that comes by a key",
        [](BlockScene& scene) {
            scene.solver->set_key("colliders", 0, hdk_double::time_of(1), 0.0);
            scene.solver->set_key("colliders", 0, hdk_double::time_of(9), 1.0);
        },
        unkeys("colliders"));
    check_change(
        "a ball",
        [](BlockScene& scene) {
            add_collider(*scene.solver, FONTANA_SPHERE_OUTSIDE);
            set_float(*scene.solver, "collider_radius2", 0.12);
        },
        sets("colliders", 1.0));
}

void a_moving_collider_is_the_same_after_a_jump() {
    const Change moving = keys("collider_centre1", 0.0, 0.3, 1);
    BlockScene scene;
    moving(scene);
    for (int k = 1; k < frame; ++k) hash_at(scene, k);
    CHECK(hash_at(scene, frame) == fresh(moving));
}

void upstream() {
    check_change("lifting the block", lifts(0.2f), lifts(0.0f));
    BlockScene scene(5, true);
    const std::uint64_t before = hash_at(scene, frame);
    CHECK(before == fresh(nothing));
    lifts(0.2f)(scene);
    hash_at(scene, 1);  // an input that changes with time is compared where it is looked at
    CHECK(hash_at(scene, frame) == fresh(lifts(0.2f)));
}

void an_unrelated_recook_upstream_is_no_edit() {
    BlockScene scene;
    hash_at(scene, frame);
    const UT_InfoTree before = hdk_double::info_of(*scene.solver, frame);
    scene.edit();  // makes the same points, under other data ids
    hash_at(scene, frame);
    CHECK(hdk_double::info_of(*scene.solver, frame).children().front().rows() == before.children().front().rows());
}

// Whole frames of Houdini's rate: half of that rate is half of the time.
void the_rate_of_the_scene() {
    const Change use = sets("use_scene_rate", 1.0);
    const std::uint64_t at_24 = fresh(use);
    CHgetManager()->set_rate(240.0);
    const std::uint64_t at_240 = fresh(use);
    CHECK(at_240 == fresh(nothing));
    CHgetManager()->set_rate(24.0);
    CHECK(at_24 != at_240);
}

}  // namespace

void check_edits() {
    parameters();
    keys_of_a_keyed_parameter();
    colliders();
    a_moving_collider_is_the_same_after_a_jump();
    upstream();
    an_unrelated_recook_upstream_is_no_edit();
    the_rate_of_the_scene();
}
