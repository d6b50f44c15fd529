// The states of simulated frames, within a limit of memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <map>
#include <vector>

namespace fontana::houdini {

// Keeps every frame while there is room, then every second one, every fourth, and so on. A frame that was dropped is
// simulated again from the nearest one before it. The first frame and the one stored last are always kept, even where
// these two are more than the limit.
class FrameHistory {
 public:
    void set_limit(std::size_t bytes) { limit_ = bytes; }
    void clear();
    void store(std::int64_t frame, const void* state, std::size_t bytes);

    bool is_empty() const { return states_.empty(); }
    // The last stored frame that is not after `frame`; there must be one.
    std::int64_t nearest(std::int64_t frame) const { return std::prev(states_.upper_bound(frame))->first; }
    const std::vector<std::byte>& state(std::int64_t frame) const { return states_.at(frame); }

    std::size_t bytes() const { return bytes_; }
    std::size_t frame_count() const { return states_.size(); }
    std::int64_t stride() const { return stride_; }

 private:
    bool is_on_stride(std::int64_t frame) const { return (frame - states_.begin()->first) % stride_ == 0; }
    void erase(std::int64_t frame);
    void thin_out();

    std::map<std::int64_t, std::vector<std::byte>> states_;
    std::size_t limit_ = SIZE_MAX, bytes_ = 0;
    std::int64_t stride_ = 1, newest_ = 0;
};

}  // namespace fontana::houdini
