// A live simulation behind a timeline: it plays, goes back, jumps ahead and follows edits, and knows no Houdini.
//
// A cook asks for a frame. What the frame depends on is compared with what it depended on when it was simulated; an
// edit forgets the frames. A frame in the history is put back on the device as it was, byte for byte; the others are
// simulated from the nearest one before. So a frame is the same whichever way it was reached.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "fontana.h"
#include "frame_history.h"
#include "frame_host.h"

namespace fontana::houdini {

enum class CookStatus { done, interrupted, failed };

struct CookResult {
    CookStatus status = CookStatus::done;
    std::int64_t frame = 0;  // the one that can be read now
    std::string sentence;    // what went wrong, or what the user should know; may be empty
};

// What is known of a frame, also after its state was dropped.
struct FrameRecord {
    std::uint64_t keyed_key = 0, points_key = 0;
    double time = 0.0;  // s since the first frame
    std::size_t particle_count = 0;
    fontana_frame_report report{};
    std::string dt_limit;
};

class Session {
 public:
    using StepFrame = fontana_status (*)(fontana_simulation*, fontana_frame_report*);

    // Tests hand in a step that fails as they wish.
    explicit Session(StepFrame step_frame = fontana_step_frame) : step_frame_(step_frame) {}

    // One thread at a time. Shows `frame`, or the start frame where that is later. Whatever goes wrong is in the
    // result.
    CookResult cook(std::int64_t frame, std::int64_t start_frame, FrameHost& host);
    // Forgets every frame; the next cook begins anew.
    void reset();
    // From any thread: the cook under way ends at its next substep, as after Esc.
    void request_stop() { stop_ = true; }
    void set_memory_limit(std::size_t bytes) { history_.set_limit(bytes); }

    // Of the frame that the last cook shows, in order of id.
    std::size_t particle_count() const;
    // As fontana_read_attribute; throws std::runtime_error with its sentence.
    void read(const char* attribute, void* out, std::size_t bytes);
    std::vector<float> ages() const;  // s since a particle came, as it was at the end of a frame
    double particle_radius() const;   // m of the scene
    // Null for a frame that was not simulated.
    const FrameRecord* record(std::int64_t frame) const;
    const FrameHistory& history() const { return history_; }
    // "" before the first particle.
    std::string device_name() const;
    std::uint64_t device_bytes() const;

 private:
    struct Destroy {
        void operator()(fontana_simulation* simulation) const { fontana_destroy(simulation); }
    };

    void follow_edits(std::int64_t frame, FrameHost& host);
    bool keys_have_changed(FrameHost& host) const;
    std::uint64_t points_key_of(const SourcePoints& points) const { return steady_key_ ? 0 : key_of_points(points); }
    static std::uint64_t key_of_points(const SourcePoints& points);
    void go_to(std::int64_t frame, FrameHost& host);
    void seek(std::int64_t frame, FrameHost& host);
    void begin(FrameHost& host);
    void restore(std::int64_t frame, FrameHost& host);
    void advance(FrameHost& host);
    void step(FrameHost& host, FrameRecord& record);
    void emit(const SourcePoints& points);
    void keep(FrameRecord&& record);
    void make_simulation();
    void apply(const std::vector<Setting>& settings);
    void place_colliders(const std::vector<ColliderSetting>& colliders);
    double frame_duration() const;
    CookResult show_last_complete(std::int64_t frame, FrameHost& host);
    std::string memory_note() const;
    static int on_progress(void* user, double frame_fraction);

    StepFrame step_frame_;
    std::atomic<bool> stop_{false};
    std::unique_ptr<fontana_simulation, Destroy> simulation_;
    std::vector<std::byte> blank_;      // the state without particles
    std::vector<FrameRecord> records_;  // from the start frame on
    FrameHistory history_;
    std::int64_t start_frame_ = 1;
    std::int64_t position_ = 0;   // the frame that lies on the device
    bool is_positioned_ = false;  // false: what lies there is no whole frame
    std::uint64_t steady_key_ = 0, edit_key_ = 0;
    FrameHost* host_ = nullptr;  // during a cook
    std::int64_t cook_from_ = 0, cook_to_ = 0;
};

}  // namespace fontana::houdini
