// The session by itself, without nodes: a device that is lost, an edit found late, a stop from another thread.
#include "session.h"

#include <cstring>

#include "checks.h"
#include "io/checks.h"

using namespace fontana::houdini;

namespace {

int failures_left = 0;
int steps_taken = 0;

// The device fails as often as asked, then works.
fontana_status failing_step(fontana_simulation* simulation, fontana_frame_report* report) {
    ++steps_taken;
    if (failures_left > 0) {
        --failures_left;
        return FONTANA_DEVICE_LOST;
    }
    return fontana_step_frame(simulation, report);
}

class PlainHost : public FrameHost {
 public:
    FrameSettings settings(std::int64_t) override {
        FrameSettings all;
        all.settings.push_back({"solver.backend", {}, 0, "cpu", false});
        all.settings.push_back({"solver.threads", {1.0}, 1, "", false});
        all.settings.push_back({"fluid.particle_spacing", {0.05}, 1, "", false});
        all.settings.push_back({"time.frame_rate", {240.0}, 1, "", false});
        return all;
    }
    FrameSettings keyed_settings(std::int64_t) override { return {}; }
    SourcePoints points(std::int64_t frame, PointsWanted wanted) override {
        SourcePoints points;
        if (wanted == PointsWanted::all)
            for (int k = 0; k < 30; ++k) points.position.push_back(0.05f * static_cast<float>(k % 7));
        else if (frame == extra_frame)
            points.position = {5.0f, 5.0f, 5.0f};
        return points;
    }
    std::uint64_t steady_points_key() override { return is_steady ? 1 : 0; }
    bool is_interrupted(double) override {
        if (to_stop) to_stop->request_stop();
        return false;
    }

    bool is_steady = true;
    std::int64_t extra_frame = 0;  // adds a particle
    Session* to_stop = nullptr;
};

std::vector<float> positions(Session& session) {
    std::vector<float> result(3 * session.particle_count());
    session.read("position", result.data(), result.size() * sizeof(float));
    return result;
}

void a_lost_device_is_replaced_once() {
    PlainHost host;
    Session whole;
    CHECK(whole.cook(8, 1, host).status == CookStatus::done);

    Session session(failing_step);
    CHECK(session.cook(5, 1, host).status == CookStatus::done);
    failures_left = 1;
    CHECK(session.cook(8, 1, host).status == CookStatus::done);
    CHECK(failures_left == 0 && positions(session) == positions(whole));

    failures_left = 2;
    steps_taken = 0;
    CHECK(session.cook(9, 1, host).status == CookStatus::failed && steps_taken == 2);
    failures_left = 0;
    CHECK(session.cook(8, 1, host).status == CookStatus::done && positions(session) == positions(whole));
}

// Frames 1, 5 and 9 are kept. Frame 7 has the points it had; frame 6, simulated again on the way to it, has not, and so
// neither 7 nor 9 is what it was.
void an_edit_found_on_the_way_starts_over() {
    PlainHost host;
    host.is_steady = false;
    Session session;
    session.cook(1, 1, host);
    session.set_memory_limit(4 * session.history().bytes());
    CHECK(session.cook(10, 1, host).status == CookStatus::done && session.history().stride() == 4);
    host.extra_frame = 6;
    CHECK(session.cook(7, 1, host).status == CookStatus::done);
    CHECK(session.cook(9, 1, host).status == CookStatus::done);
    Session fresh;
    CHECK(fresh.cook(9, 1, host).status == CookStatus::done);
    CHECK(session.particle_count() == 11 && positions(session) == positions(fresh));
}

void a_stop_ends_the_cook() {
    PlainHost host;
    Session session;
    CHECK(session.cook(3, 1, host).status == CookStatus::done);
    host.to_stop = &session;
    const CookResult result = session.cook(1000000, 1, host);
    CHECK(result.status == CookStatus::interrupted && result.frame >= 3 && result.frame < 6);
    host.to_stop = nullptr;
    CHECK(session.cook(7, 1, host).status == CookStatus::done);
}

void the_history_thins_out() {
    FrameHistory history;
    history.set_limit(10 * 100);
    const std::vector<char> state(100);
    for (int frame = 5; frame <= 40; ++frame) {
        history.store(frame, state.data(), state.size());
        CHECK(history.bytes() <= 1000 && history.nearest(frame) == frame);
    }
    CHECK(history.stride() == 4 && history.nearest(5) == 5 && history.nearest(12) == 9);
    history.set_limit(1);
    history.store(41, state.data(), state.size());
    CHECK(history.frame_count() == 2 && history.nearest(40) == 5 && history.nearest(99) == 41);
}

}  // namespace

void check_session() {
    a_lost_device_is_replaced_once();
    an_edit_found_on_the_way_starts_over();
    a_stop_ends_the_cook();
    the_history_thins_out();
}
