// Nodes on several threads. ThreadSanitizer runs this too.
#include <chrono>
#include <thread>

#include "checks.h"
#include "scene.h"

namespace {

void two_nodes_at_once() {
    const std::vector<std::uint64_t> expected = played(20);
    BlockScene first, second;
    std::uint64_t hashes[2] = {};
    std::thread thread([&] { hashes[0] = hash_at(first, 20); });
    hashes[1] = hash_at(second, 20);
    thread.join();
    CHECK(hashes[0] == expected.back() && hashes[1] == expected.back());
}

void wait_until_cooking(const SOP_Node& node) {
    while (!node.isCooking(true)) std::this_thread::yield();
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
}

void a_cooking_node_is_not_deleted() {
    BlockScene scene;
    std::thread thread([&] { hdk_double::cook(*scene.solver, 1000000); });
    wait_until_cooking(*scene.solver);
    CHECK(!scene.network.destroy(*scene.solver));
    hdk_double::interrupt_after(1);
    thread.join();
    hdk_double::interrupt_after(-1);
    CHECK(contains(sentences(*scene.solver), "interrupted"));
    CHECK(scene.network.destroy(*scene.solver));
}

void a_reset_ends_the_cook_under_way() {
    BlockScene scene;
    std::thread thread([&] { hdk_double::cook(*scene.solver, 1000000); });
    wait_until_cooking(*scene.solver);
    hdk_double::press(*scene.solver, "reset");
    thread.join();
    CHECK(contains(sentences(*scene.solver), "interrupted"));
    CHECK(hash_at(scene, 4) == played(4).back());
}

}  // namespace

void check_threads() {
    two_nodes_at_once();
    a_cooking_node_is_not_deleted();
    a_reset_ends_the_cook_under_way();
}
