// Checks of a GPU backend from inside, where the library has no border: the sort against std::stable_sort, and what
// buffers, launches and the profile promise. Prints a line for each failure and the number of checks at the end; the
// exit status is 0 if all hold. One text for every such backend, which says through `Device` what its classes are:
//
//   Queue, Program, Kernel              types
//   Queue make_queue(bool profile)      on the first device
//   Program build(Queue&)               the device program
//   Kernel kernel(Queue&, Program&, function, label)
//   std::size_t group_size(Queue&)      threads in a group, for which the program was built
//   std::size_t too_many_bytes(Queue&)  more than one buffer can have
//   const char* missing_kernel          part of the error for a kernel that is not in the program
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "backends/gpu/device_sort.h"
#include "util/error.h"

namespace gpu_checks {

using Words = std::vector<std::uint32_t>;

struct Sorted {
    Words order, start;
    bool operator==(const Sorted& other) const { return order == other.order && start == other.start; }
};

inline Sorted sort_on_host(const Words& key, std::size_t key_count) {
    Sorted sorted{Words(key.size()), Words(key_count + 1)};
    std::iota(sorted.order.begin(), sorted.order.end(), 0u);
    std::stable_sort(sorted.order.begin(), sorted.order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return key[a] < key[b]; });
    for (std::uint32_t k : key) ++sorted.start[k + 1];
    std::partial_sum(sorted.start.begin(), sorted.start.end(), sorted.start.begin());
    return sorted;
}

class Checks {
 public:
    void expect(bool holds, const std::string& what) {
        ++count_;
        if (holds) return;
        ++failures_;
        std::printf("fails: %s\n", what.c_str());
    }

    // That `action` throws an Error with this status, whose sentence has this part.
    void expect_error(fontana::Status status, const std::string& part, const std::function<void()>& action) {
        try {
            action();
            expect(false, "no error: " + part);
        } catch (const fontana::Error& error) {
            const std::string sentence = error.what();
            expect(error.status() == status && sentence.find(part) != std::string::npos, part + ", got: " + sentence);
        }
    }

    int report() const {
        std::printf("%d checks, %d failed\n", count_, failures_);
        return failures_ == 0 ? 0 : 1;
    }

 private:
    int count_ = 0, failures_ = 0;
};

template <typename Device>
class SortChecks {
 public:
    using Queue = typename Device::Queue;
    using Kernel = typename Device::Kernel;

    SortChecks(Checks& checks, Device& device, Queue& queue, typename Device::Program& program)
        : checks_(checks), queue_(queue), sort_(device.group_size(queue), [&](const char* function, const char* label) {
              return device.kernel(queue, program, function, label);
          }) {}

    void check(const std::string& name, const Words& key, std::size_t key_count) {
        checks_.expect(sort_on_device(key, key_count) == sort_on_host(key, key_count),
                       "the sort of " + name + ": " + std::to_string(key.size()) + " values, " +
                           std::to_string(key_count) + " keys");
    }

 private:
    Sorted sort_on_device(const Words& key, std::size_t key_count) {
        const auto keys = queue_.allocate("key", key.size() * 4);
        const auto order = queue_.allocate("order", key.size() * 4);
        const auto start = queue_.allocate("start", (key_count + 1) * 4);
        const auto rank = queue_.allocate("rank", key.size() * 4);
        queue_.write(*keys, key.data(), key.size() * 4, 0);
        sort_.sort(queue_, *keys, key.size(), key_count, *order, *start, *rank);
        Sorted sorted{Words(key.size()), Words(key_count + 1)};
        queue_.read(*order, sorted.order.data(), key.size() * 4, 0);
        queue_.read(*start, sorted.start.data(), (key_count + 1) * 4, 0);
        return sorted;
    }

    Checks& checks_;
    Queue& queue_;
    fontana::DeviceSort<Queue, Kernel> sort_;
};

inline Words random_keys(std::size_t count, std::uint32_t key_count) {
    std::mt19937 generator(static_cast<std::uint32_t>(count) + key_count);
    Words keys(count);
    for (std::uint32_t& key : keys) key = static_cast<std::uint32_t>(generator()) % key_count;
    return keys;
}

// Sizes around a group of 64 or 128 threads with 4 values each, and around a block of such blocks.
template <typename Device>
void check_sizes(SortChecks<Device>& checks) {
    for (std::size_t count : {0u, 1u, 2u, 255u, 256u, 257u, 5000u})
        for (std::uint32_t key_count : {1u, 2u, 255u, 256u, 257u, 511u, 512u, 513u, 65535u, 65536u, 262145u})
            checks.check("random", random_keys(count, key_count), key_count);
}

// `share` keys become one: about count / key_count * share values each, to both sides of where a heap takes over.
template <typename Device>
void check_crowds(SortChecks<Device>& checks) {
    constexpr std::uint32_t k_keys = 1u << 16;
    for (std::uint32_t share : {16u, 32u, 64u, 128u, 4096u}) {
        Words keys = random_keys(100000, k_keys);
        for (std::uint32_t& key : keys) key = key / share * share;
        checks.check("crowded, " + std::to_string(share), keys, k_keys);
    }
    Words keys = random_keys(100000, k_keys);
    for (std::size_t i = 0; i < keys.size(); i += 2) keys[i] = 4321;
    checks.check("half in one", keys, k_keys);
    std::sort(keys.begin(), keys.end());
    checks.check("sorted", keys, k_keys);
    std::reverse(keys.begin(), keys.end());
    checks.check("reversed", keys, k_keys);
}

template <typename Device>
void check_sort(Checks& checks, Device& device, typename Device::Queue& queue, typename Device::Program& program) {
    SortChecks<Device> sort(checks, device, queue, program);
    check_sizes(sort);
    check_crowds(sort);
    // More levels of the scan, and after it fewer than what the buffers have grown to.
    sort.check("sparse", random_keys(1000, 1u << 24), 1u << 24);
    sort.check("small again", random_keys(10, 5), 5);
}

template <typename Device>
void check_buffers(Checks& checks, Device& device, typename Device::Queue& queue) {
    Words words(1000, 7u);
    {
        queue.write(*queue.allocate("used", 4000), words.data(), 4000, 0);
    }
    queue.read(*queue.allocate("fresh", 4000), words.data(), 4000, 0);
    checks.expect(words == Words(1000, 0u), "a buffer begins as zeros");

    const auto buffer = queue.allocate("some", 40);
    queue.write(*buffer, Words{1, 2, 3}.data(), 12, 28);
    queue.read(*buffer, words.data(), 40, 0);
    checks.expect(words[6] == 0 && words[7] == 1 && words[9] == 3, "a write goes to its offset");
    checks.expect(buffer->bytes() == 40, "a buffer has the bytes asked for");
    queue.read(*queue.allocate("empty", 0), words.data(), 0, 0);

    checks.expect_error(FONTANA_INTERNAL, "beyond the buffer some", [&] { queue.read(*buffer, words.data(), 44, 0); });
    checks.expect_error(FONTANA_INTERNAL, "beyond the buffer some",
                        [&] { queue.write(*buffer, words.data(), 4, SIZE_MAX); });
    for (std::size_t bytes : {device.too_many_bytes(queue), std::size_t{SIZE_MAX}})
        checks.expect_error(FONTANA_OUT_OF_MEMORY, "the buffer cell start needs",
                            [&] { queue.allocate("cell start", bytes); });
    queue.read(*buffer, words.data(), 40, 0);  // a lack of memory leaves the device as it was
}

template <typename Device>
void check_launches(Checks& checks, Device& device, typename Device::Queue& queue, typename Device::Program& program) {
    auto scatter = device.kernel(queue, program, "sort_scatter", "scatter");
    const auto buffer = queue.allocate("some", 40);
    const std::uint32_t count = 10;
    checks.expect_error(FONTANA_INTERNAL, "the kernel scatter takes 5 arguments and was given 2",
                        [&] { scatter.launch(queue, count, {count, *buffer}); });
    checks.expect_error(FONTANA_INTERNAL, "argument 0 of the kernel scatter has 8 bytes",
                        [&] { scatter.launch(queue, count, {std::uint64_t{10}, *buffer, *buffer, *buffer, *buffer}); });
    checks.expect_error(FONTANA_DEVICE_UNAVAILABLE, device.missing_kernel,
                        [&] { device.kernel(queue, program, "no_such_kernel", "none"); });
}

// More launches than events may wait to be read.
template <typename Device>
void check_profile(Checks& checks, Device& device) {
    auto queue = device.make_queue(true);
    auto program = device.build(queue);
    auto add_offsets = device.kernel(queue, program, "sort_add_offsets", "add offsets");
    const auto value = queue.allocate("value", 40), offset = queue.allocate("offset", 40);
    const std::uint32_t count = 10;
    for (int i = 0; i < 2500; ++i) add_offsets.launch(queue, count, {count, *value, *offset});
    const std::vector<fontana::ProfileRow> rows = queue.profile();
    checks.expect(rows.size() == 1 && rows[0].name == "add offsets", "the profile has a row for each name");
    checks.expect(rows.size() == 1 && rows[0].launches == 2500 && rows[0].seconds > 0.0, "it counts every launch once");
    checks.expect(rows.size() == 1 && rows[0].elements == 25000, "it counts what the launches went through");
}

template <typename Device>
int run(Device device) {
    auto queue = device.make_queue(false);
    auto program = device.build(queue);
    Checks checks;
    check_sort(checks, device, queue, program);
    check_buffers(checks, device, queue);
    check_launches(checks, device, queue, program);
    check_profile(checks, device);
    return checks.report();
}

// As a program's main.
template <typename Device>
int run_checks(Device device) {
    try {
        return run(device);
    } catch (const fontana::Error& error) {
        std::printf("error: %s\n", error.what());
        return 2;
    }
}

}  // namespace gpu_checks
