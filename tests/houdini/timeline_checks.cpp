// A frame is the same bytes whichever way it is reached.
#include "checks.h"
#include "scene.h"

namespace {

constexpr int last_frame = 12;

void a_jump_gives_the_played_frame(const std::vector<std::uint64_t>& expected) {
    BlockScene scene;
    CHECK(hash_at(scene, last_frame) == expected.back());
    CHECK(hash_at(scene, 1) == expected.front());
}

void scrubbing_gives_the_played_frames(const std::vector<std::uint64_t>& expected) {
    BlockScene scene;
    for (const int frame : {4, 2, 9, 3, 12, 1, 7, 8, 12, 5})
        CHECK(hash_at(scene, frame) == expected[static_cast<std::size_t>(frame - 1)]);
}

void frames_differ(const std::vector<std::uint64_t>& expected) {
    for (std::size_t k = 1; k < expected.size(); ++k) CHECK(expected[k] != expected[k - 1]);
}

void the_start_frame_shows_the_sources() {
    BlockScene scene;
    set_int(*scene.solver, "start_frame", 5);
    const std::uint64_t start = hash_at(scene, 5);
    CHECK(hash_at(scene, 2) == start);
    GU_Detail block;
    add_block(block, scene.side, 0.0f);
    CHECK(hdk_double::positions(hdk_double::cook(*scene.solver, 5)) == hdk_double::positions(block));
    CHECK(hash_at(scene, 6) != start);
}

void a_reset_gives_the_same_frame(const std::vector<std::uint64_t>& expected) {
    BlockScene scene;
    hash_at(scene, 6);
    hdk_double::press(*scene.solver, "reset");
    CHECK(hash_at(scene, 6) == expected[5]);
}

}  // namespace

void check_timeline() {
    const std::vector<std::uint64_t> expected = played(last_frame);
    frames_differ(expected);
    a_jump_gives_the_played_frame(expected);
    scrubbing_gives_the_played_frames(expected);
    the_start_frame_shows_the_sources();
    a_reset_gives_the_same_frame(expected);
}
