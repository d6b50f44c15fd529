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

ThreadPool::ThreadPool(int thread_count) {
    try {
        for (int k = 1; k < thread_count; ++k) workers_.emplace_back([this] { work(); });
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
        count_ = count;
        grain_ = grain;
        next_ = 0;
        error_ = nullptr;
        busy_ = workers_.size();
        ++generation_;
    }
    start_.notify_all();
    take_pieces();
    const auto is_done = [this] { return busy_ == 0; };
    look_for(is_done);
    std::unique_lock<std::mutex> lock(mutex_);
    done_.wait(lock, is_done);
    body_ = nullptr;
    if (error_) std::rethrow_exception(error_);
}

// Shorter towards the end, so that all threads come to it together.
std::size_t ThreadPool::piece_after(std::size_t begin) const {
    const std::size_t left = count_ - begin, least = std::max<std::size_t>(1, grain_ / 8);
    const std::size_t fair = left / (2 * (workers_.size() + 1)) / least * least;
    return std::min(left, std::clamp(fair, least, grain_));
}

void ThreadPool::take_pieces() {
    try {
        for (;;) {
            std::size_t begin = next_, end;
            do {
                if (begin >= count_) return;
                end = begin + piece_after(begin);
            } while (!next_.compare_exchange_weak(begin, end));
            (*body_)(begin, end);
        }
    } catch (...) {
        std::lock_guard<std::mutex> lock(mutex_);
        if (!error_) error_ = std::current_exception();
        next_ = count_;
    }
}

void ThreadPool::work() {
    std::size_t seen = 0;
    for (;;) {
        wait_for_work(seen);
        if (stopping_) return;
        seen = generation_;
        take_pieces();
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
