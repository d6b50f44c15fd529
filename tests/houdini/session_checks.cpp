// The session by itself, without nodes: a device that is lost, an input that wavers, a stop from another thread.
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
    SourcePoints points(std::int64_t, PointsWanted wanted) override {
        SourcePoints points;
        if (wanted == PointsWanted::all)
            for (int k = 0; k < 30; ++k) points.position.push_back(0.05f * static_cast<float>(k % 7));
        else if (wavers)
            points.position = {5.0f, 5.0f, 0.1f * static_cast<float>(++times_asked)};
        return points;
    }
    std::uint64_t steady_points_key() override { return wavers ? 0 : 1; }
    bool is_interrupted(double) override {
        if (to_stop) to_stop->request_stop();
        return false;
    }

    bool wavers = false;
    int times_asked = 0;
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

void an_input_that_wavers_is_named() {
    PlainHost host;
    host.wavers = true;
    Session session;
    session.set_memory_limit(1);  // so that going back simulates again
    CHECK(session.cook(6, 1, host).status == CookStatus::done);
    const CookResult result = session.cook(4, 1, host);
    CHECK(result.status == CookStatus::done);
    session.cook(6, 1, host);
    CHECK(session.cook(3, 1, host).status == CookStatus::done);
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
    an_input_that_wavers_is_named();
    a_stop_ends_the_cook();
    the_history_thins_out();
}
