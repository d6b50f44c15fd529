#include "backends/cpu/thread_pool.h"

#include <algorithm>

namespace fontana {
namespace {

// A substep is dozens of short loops, and waking a thread that sleeps costs as much as some of them: for about as long
// as that a thread looks for the next loop before it lies down.
constexpr int k_looks = 4000;

template <typename Condition>
bool look_for(const Condition& condition) {
    for (int k = 0; k < k_looks; ++k) {
        if (condition()) return true;
#if defined(__x86_64__)
        __builtin_ia32_pause();
#endif
    }
    return false;
}

}  // namespace

ThreadPool::ThreadPool(int thread_count) : shares_(static_cast<std::size_t>(std::max(1, thread_count))) {
    try {
        for (std::size_t k = 1; k < shares_.size(); ++k) workers_.emplace_back([this, k] { work(k); });
    } catch (...) {
        stop();  // a running thread must not be destroyed
        throw;
    }
}

ThreadPool::~ThreadPool() { stop(); }

void ThreadPool::stop() {
    {
        std::lock_guard<std::mutex> lock(mutex_);
        stopping_ = true;
    }
    start_.notify_all();
    for (std::thread& worker : workers_) worker.join();
}

void ThreadPool::run(std::size_t count, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body) {
    if (count == 0) return;
    if (workers_.empty() || count <= grain) {
        body(0, count);
        return;
    }
    {
        std::lock_guard<std::mutex> lock(mutex_);
        body_ = &body;
        grain_ = grain;
        share_out(count);
        error_ = nullptr;
        busy_ = workers_.size();
        ++generation_;
    }
    start_.notify_all();
    take_pieces(0);
    const auto is_done = [this] { return busy_ == 0; };
    look_for(is_done);
    std::unique_lock<std::mutex> lock(mutex_);
    done_.wait(lock, is_done);
    body_ = nullptr;
    if (error_) std::rethrow_exception(error_);
}

void ThreadPool::share_out(std::size_t count) {
    const std::size_t unit = std::max<std::size_t>(1, grain_ / 8), units = (count + unit - 1) / unit;
    for (std::size_t k = 0; k < shares_.size(); ++k) {
        shares_[k].next = units * k / shares_.size() * unit;
        shares_[k].end = std::min(count, units * (k + 1) / shares_.size() * unit);
    }
}

// Shorter towards the end of a share, so that all threads come to it together.
std::size_t ThreadPool::piece_of(std::size_t left) const {
    const std::size_t least = std::max<std::size_t>(1, grain_ / 8);
    return std::min(left, std::clamp(left / 4 / least * least, least, grain_));
}

void ThreadPool::take_pieces(std::size_t thread) {
    try {
        for (std::size_t k = 0; k < shares_.size(); ++k) take_pieces_of(shares_[(thread + k) % shares_.size()]);
    } catch (...) {
        std::lock_guard<std::mutex> lock(mutex_);
        if (!error_) error_ = std::current_exception();
        for (Share& share : shares_) share.next = share.end;
    }
}

void ThreadPool::take_pieces_of(Share& share) {
    for (;;) {
        std::size_t begin = share.next, end;
        do {
            if (begin >= share.end) return;
            end = begin + piece_of(share.end - begin);
        } while (!share.next.compare_exchange_weak(begin, end));
        (*body_)(begin, end);
    }
}

void ThreadPool::work(std::size_t thread) {
    std::size_t seen = 0;
    for (;;) {
        wait_for_work(seen);
        if (stopping_) return;
        seen = generation_;
        take_pieces(thread);
        if (--busy_ == 0) {
            std::lock_guard<std::mutex> lock(mutex_);  // whoever waits has either seen it or is asleep by now
            done_.notify_one();
        }
    }
}

void ThreadPool::wait_for_work(std::size_t seen) {
    const auto is_work = [&] { return stopping_ || generation_ != seen; };
    if (look_for(is_work)) return;
    std::unique_lock<std::mutex> lock(mutex_);
    start_.wait(lock, is_work);
}

}  // namespace fontana
