// A solver node as its session sees it: parameters and input points at any frame.
#pragma once

#include <OP/OP_Context.h>
#include <UT/UT_Interrupt.h>

#include <optional>
#include <string>

#include "frame_host.h"

class SOP_Node;

namespace fontana::houdini {

// Points of an input that does not change with time: read once, until an edit gives them other data ids.
struct SteadyInput {
    std::vector<std::int64_t> data_ids;
    std::string group;
    SourcePoints all, continuous;
    std::uint64_t key = 0;
};

// Lives as long as a cook.
class SolverHost : public FrameHost {
 public:
    SolverHost(SOP_Node& node, const OP_Context& context, SteadyInput& steady);

    FrameSettings settings(std::int64_t frame) override { return read_settings(frame, false); }
    FrameSettings keyed_settings(std::int64_t frame) override { return read_settings(frame, true); }
    SourcePoints points(std::int64_t frame, PointsWanted wanted) override;
    std::uint64_t steady_points_key() override { return is_steady_ ? steady_.key : 0; }
    bool is_interrupted(double fraction) override;

 private:
    // Calls read(detail) with the first input cooked at `frame`; not at all where nothing is wired.
    template <typename Read>
    void with_input(std::int64_t frame, const Read& read);
    void look_at_input();
    FrameSettings read_settings(std::int64_t frame, bool keyed_only) const;
    Setting read_setting(std::size_t row, double time) const;
    ColliderSetting read_collider(int instance, std::int64_t frame) const;
    bool is_keyed(std::size_t row) const;
    bool is_collider_keyed(int instance) const;

    SOP_Node& node_;
    OP_Context context_;
    SteadyInput& steady_;
    std::string group_;
    bool is_steady_ = false;
    UT_AutoInterrupt boss_;
};

std::int64_t frame_at(double time);
double time_at(std::int64_t frame);

}  // namespace fontana::houdini
