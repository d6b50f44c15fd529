// ThreadPool and RadixSort, from the inside: what they promise, for any number of threads and any sizes.
#include <algorithm>
#include <atomic>
#include <cstdio>
#include <memory>
#include <numeric>
#include <random>
#include <stdexcept>
#include <string>
#include <thread>

#include "backends/cpu/radix_sort.h"
#include "backends/cpu/thread_pool.h"
#include "check.h"

using fontana::RadixSort;
using fontana::ThreadPool;

namespace {

constexpr int k_thread_counts[] = {1, 2, 3, 8};

void every_index_is_visited_once() {
    for (const int thread_count : k_thread_counts) {
        ThreadPool pool(thread_count);
        CHECK(pool.thread_count() == thread_count);
        for (const std::size_t count : {0u, 1u, 7u, 64u, 1000u, 4097u}) {
            for (const std::size_t grain : {1u, 64u, 5000u}) {
                std::vector<int> visits(count, 0);  // plain: two threads on one index are a race
                pool.run(count, grain, [&](std::size_t begin, std::size_t end) {
                    CHECK(begin < end && end <= count);
                    for (std::size_t i = begin; i < end; ++i) ++visits[i];
                });
                CHECK(std::all_of(visits.begin(), visits.end(), [](int n) { return n == 1; }));
            }
        }
    }
}

// What one run wrote the next one reads, on other threads.
void runs_follow_each_other() {
    ThreadPool pool(4);
    std::vector<int> values(1000, 0);
    for (int round = 0; round < 200; ++round)
        pool.run(values.size(), 10, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) values[values.size() - 1 - i] += 1;
        });
    CHECK(std::all_of(values.begin(), values.end(), [](int n) { return n == 200; }));
}

void exceptions_come_out_of_run() {
    for (const int thread_count : k_thread_counts) {
        ThreadPool pool(thread_count);
        for (int round = 0; round < 50; ++round) {
            std::string caught;
            try {
                pool.run(1000, 10, [&](std::size_t begin, std::size_t) {
                    if (begin >= 300) throw std::runtime_error("from a body");
                });
            } catch (const std::runtime_error& error) {
                caught = error.what();
            }
            CHECK(caught == (thread_count == 1 ? "" : "from a body"));
            std::atomic<std::size_t> visited{0};  // and the pool goes on
            pool.run(1000, 10, [&](std::size_t begin, std::size_t end) { visited += end - begin; });
            CHECK(visited == 1000);
        }
    }
}

void pools_end_inside_the_bodies_of_others() {
    ThreadPool outer(3);
    std::atomic<std::size_t> visited{0};
    outer.run(20, 1, [&](std::size_t, std::size_t) {
        ThreadPool inner(3);
        inner.run(100, 5, [&](std::size_t begin, std::size_t end) {
            if (begin == 50) ThreadPool never_run(2);
            visited += end - begin;
        });
    });
    CHECK(visited == 2000);
    for (int round = 0; round < 100; ++round) ThreadPool unused(4);
}

// A pool belongs to one caller at a time, which need not be its maker.
void the_caller_may_change() {
    auto pool = std::make_unique<ThreadPool>(3);
    std::vector<int> values(500, 0);
    for (int round = 0; round < 10; ++round)
        std::thread([&] {
            pool->run(values.size(), 10, [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i) ++values[i];
            });
        }).join();
    std::thread([&] { pool.reset(); }).join();
    CHECK(std::all_of(values.begin(), values.end(), [](int n) { return n == 10; }));
}

void check_sort(RadixSort& sort, ThreadPool& pool, const std::vector<std::uint32_t>& key, std::size_t key_count) {
    std::vector<std::uint32_t> expected(key.size()), order(key.size(), 77), start(key_count + 1, 77);
    std::vector<RadixSort::Item> scratch(2 * key.size());
    std::iota(expected.begin(), expected.end(), 0u);
    std::stable_sort(expected.begin(), expected.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return key[a] < key[b]; });
    sort.sort(pool, key.data(), key.size(), key_count, order.data(), start.data(), scratch.data());
    CHECK(order == expected);
    std::vector<std::uint32_t> counted(key_count + 1, 0);
    for (const std::uint32_t k : key) ++counted[k + 1];
    std::partial_sum(counted.begin(), counted.end(), counted.begin());
    CHECK(start == counted);
}

void sorting_equals_the_standard_library() {
    std::mt19937 random(5);
    for (const int thread_count : k_thread_counts) {
        ThreadPool pool(thread_count);
        RadixSort sort;  // one for all sizes: it keeps its memory
        for (const std::size_t count : {0u, 1u, 2u, 100u, 16384u, 16385u, 70000u, 33u}) {
            for (const std::size_t key_count : {1u, 2u, 64u, 2048u, 2049u, 1u << 17}) {
                std::vector<std::uint32_t> key(count);
                for (std::uint32_t& k : key) k = static_cast<std::uint32_t>(random() % key_count);
                check_sort(sort, pool, key, key_count);
            }
        }
        for (int round = 0; round < 20; ++round) {
            const std::size_t count = random() % 5000, key_count = 1 + random() % 5000, used = 1 + random() % key_count;
            std::vector<std::uint32_t> key(count);
            for (std::uint32_t& k : key) k = static_cast<std::uint32_t>(random() % used);
            check_sort(sort, pool, key, key_count);
        }
    }
}

}  // namespace

int main() {
    every_index_is_visited_once();
    runs_follow_each_other();
    exceptions_come_out_of_run();
    pools_end_inside_the_bodies_of_others();
    the_caller_may_change();
    sorting_equals_the_standard_library();
    std::printf("%d failed checks\n", failed_checks.load());
    return failed_checks == 0 ? 0 : 1;
}
