// A fixed team of threads that runs one loop at a time.
//
// Our own, because the ready ones do not fit a library that lives inside other programs: oneTBB would meet the host's
// own copy, OpenMP's runtime does not survive a fork and blinds the thread sanitizer, and neither tells which thread
// count a simulation asked for without global state.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace fontana {

class ThreadPool {
 public:
    // thread_count includes the caller of run(). Throws std::system_error where the system has no more threads to give.
    explicit ThreadPool(int thread_count);
    ~ThreadPool();
    ThreadPool(const ThreadPool&) = delete;
    ThreadPool& operator=(const ThreadPool&) = delete;

    int thread_count() const { return static_cast<int>(workers_.size()) + 1; }

    // Calls body(begin, end) for pieces of [0, count) of at most `grain`, on all threads, in any order; every piece
    // begins at a multiple of an eighth of the grain. Returns when all is done; the first exception of a body is thrown
    // here. A thread begins with the same share of [0, count) in every loop, which its cache may still hold, and helps
    // with what is left of the others' when it is through.
    void run(std::size_t count, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body);

 private:
    // On a cache line of its own, since threads write to it.
    struct alignas(64) Share {
        std::atomic<std::size_t> next{0};
        std::size_t end = 0;
    };

    void work(std::size_t thread);
    void stop();
    void share_out(std::size_t count);
    void take_pieces(std::size_t thread);
    void take_pieces_of(Share& share);
    std::size_t piece_of(std::size_t left) const;
    void wait_for_work(std::size_t seen);

    std::vector<Share> shares_;  // by thread; the caller's is the first
    std::vector<std::thread> workers_;
    std::mutex mutex_;
    std::condition_variable start_, done_;
    const std::function<void(std::size_t, std::size_t)>* body_ = nullptr;
    std::size_t grain_ = 1;
    std::atomic<std::size_t> generation_{0}, busy_{0};
    std::exception_ptr error_;
    std::atomic<bool> stopping_{false};
};

}  // namespace fontana
