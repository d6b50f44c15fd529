#include "frame_history.h"

namespace fontana::houdini {

void FrameHistory::clear() {
    states_.clear();
    bytes_ = 0;
    stride_ = 1;
}

void FrameHistory::erase(std::int64_t frame) {
    const auto found = states_.find(frame);
    if (found == states_.end()) return;
    bytes_ -= found->second.size();
    states_.erase(found);
}

void FrameHistory::store(std::int64_t frame, const void* state, std::size_t bytes) {
    if (!is_empty() && newest_ != frame && !is_on_stride(newest_)) erase(newest_);
    erase(frame);
    const auto* first = static_cast<const std::byte*>(state);
    states_.emplace(frame, std::vector<std::byte>(first, first + bytes));
    bytes_ += bytes;
    newest_ = frame;
    while (bytes_ > limit_ && states_.size() > 2) thin_out();
}

void FrameHistory::thin_out() {
    stride_ *= 2;
    for (auto place = std::next(states_.begin()); place != states_.end();) {
        const std::int64_t frame = (place++)->first;
        if (frame != newest_ && !is_on_stride(frame)) erase(frame);
    }
}

}  // namespace fontana::houdini
