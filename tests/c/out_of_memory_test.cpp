// Every allocation of a run fails once: each time the call says so, nothing leaks or crashes, and the simulation goes
// on as if nothing had been.
//
//   out_of_memory_test FOLDER
#include <pthread.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <string>
#include <vector>

#include "fontana.h"

namespace {

// Allocations until the one that fails; below 0: none does. The library's own come here too.
std::atomic<long> allocations_left{-1};
// Only those with this alignment count, or a larger one.
std::atomic<std::size_t> least_alignment{0};
constexpr std::size_t k_of_buffers = 64;

void* allocate(std::size_t bytes, std::size_t alignment) {
    if (alignment >= least_alignment.load() && allocations_left.load() >= 0 && allocations_left.fetch_sub(1) == 0)
        throw std::bad_alloc();
    const std::size_t rounded = (bytes / alignment + 1) * alignment;
    if (void* memory = std::aligned_alloc(alignment, rounded)) return memory;
    throw std::bad_alloc();
}

}  // namespace

void* operator new(std::size_t bytes) { return allocate(bytes, __STDCPP_DEFAULT_NEW_ALIGNMENT__); }
void* operator new(std::size_t bytes, std::align_val_t alignment) {
    return allocate(bytes, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }

namespace {

[[noreturn]] void fail(const std::string& what) {
    std::fprintf(stderr, "out_of_memory_test: %s\n", what.c_str());
    std::exit(EXIT_FAILURE);
}

void require_ok(fontana_status status) {
    if (status != FONTANA_OK) fail(fontana_last_error());
}

class Run {
 public:
    Run(const std::string& folder, const char* method) : checkpoint_(folder + "/state.checkpoint") {
        require_ok(fontana_create(&simulation_));
        require_ok(fontana_set_text(simulation_, "solver.backend", "cpu"));
        require_ok(fontana_set_text(simulation_, "fluid.method", method));
        set_number("solver.threads", 3);
        set_number("time.frame_rate", 1000);
    }
    ~Run() { fontana_destroy(simulation_); }
    Run(const Run&) = delete;
    Run& operator=(const Run&) = delete;

    static constexpr int step_count = 10;
    // A frame that failed may stand between two substeps; everything else must be as before.
    static bool is_frame(int number) { return number == 4 || number == 6 || number == 9; }
    // Step `number` of a short life, each of which can be tried again after it failed.
    fontana_status take_step(int number) {
        const float position[6] = {0.0f, 0.0f, 0.0f, 0.05f, 0.0f, 0.0f},
                    force[6] = {0.0f, 1.0f, 0.0f, 0.0f, 1.0f, 0.0f};
        std::uint32_t neighbors[1000];
        switch (number) {
            case 0:
                return add_jet();
            case 1:
                return add_moving_floor();
            case 2:
                return fontana_add_particles(simulation_, 2, position, nullptr, nullptr);
            case 3:
                return fontana_set_force(simulation_, 2, force);
            case 4:
                return fontana_step_frame(simulation_, nullptr);
            case 5:
                return fontana_save_checkpoint(simulation_, checkpoint_.c_str(), "tag");
            case 6:
                return fontana_step_frame(simulation_, nullptr);
            case 7:
                return fontana_count_neighbors(simulation_, neighbors, fontana_particle_count(simulation_));
            case 8:
                return fontana_load_checkpoint(simulation_, checkpoint_.c_str());
            default:
                return fontana_step_frame(simulation_, nullptr);
        }
    }

    // Of all that can be read.
    std::uint64_t state_hash() {
        std::vector<std::uint64_t> hashes = {static_cast<std::uint64_t>(fontana_frame(simulation_))};
        for (std::size_t k = 0; k < fontana_attribute_count(); ++k) {
            const char* name = nullptr;
            int components = 0;
            require_ok(fontana_attribute_info(k, &name, nullptr, &components));
            std::vector<float> values(fontana_particle_count(simulation_) * static_cast<std::size_t>(components));
            require_ok(fontana_read_attribute(simulation_, name, values.data(), 4 * values.size()));
            hashes.push_back(fontana_hash(values.data(), 4 * values.size()));
        }
        return fontana_hash(hashes.data(), 8 * hashes.size());
    }

 private:
    // Two layers a frame: the arrays grow.
    fontana_status add_jet() {
        fontana_emitter jet;
        fontana_emitter_defaults(FONTANA_DISC, &jet);
        jet.radius = 0.1;
        jet.speed = 30.0;
        std::size_t index = 7;
        const fontana_status status = fontana_add_emitter(simulation_, &jet, &index);
        if (status == FONTANA_OK && index != 0) fail("a failed emitter was kept");
        return status;
    }

    fontana_status add_moving_floor() {
        fontana_collider ground;
        fontana_collider_defaults(FONTANA_PLANE_Y, &ground);
        std::size_t index = fontana_collider_count(simulation_);
        const fontana_status status = index > 0 ? FONTANA_OK : fontana_add_collider(simulation_, &ground, nullptr);
        const double time[2] = {0.0, 1.0}, centre[6] = {0.0, -1.0, 0.0, 0.0, 1.0, 0.0};
        return status != FONTANA_OK ? status : fontana_set_collider_keys(simulation_, 0, 2, time, centre);
    }

    void set_number(const char* name, double value) { require_ok(fontana_set_number(simulation_, name, &value, 1)); }

    std::string checkpoint_;
    fontana_simulation* simulation_ = nullptr;
};

class Sweep {
 public:
    // With `only_buffers` what lacks is a device's memory. Methods ask for that before they move anything; and mueller
    // for all memory.
    Sweep(std::string folder, std::string method, bool only_buffers)
        : folder_(std::move(folder)),
          method_(std::move(method)),
          only_buffers_(only_buffers),
          is_frame_exact_(method_ == "mueller" || only_buffers) {
        Run run(folder_, method_.c_str());
        for (int number = 0; number < Run::step_count; ++number) {
            require_ok(run.take_step(number));
            expected_.push_back(run.state_hash());
        }
    }

    // How many allocations there were to fail.
    long run() {
        long tried = 0;
        least_alignment = only_buffers_ ? k_of_buffers : 0;
        for (int number = 0; number < Run::step_count; ++number) {
            if (method_ != "mueller" && !Run::is_frame(number)) continue;  // all else is the same
            for (long index = 0; fails_and_goes_on(number, index); ++index) ++tried;
        }
        least_alignment = 0;
        return tried;
    }

 private:
    // Lets allocation number `index` of step `number` fail. False once there are not so many.
    bool fails_and_goes_on(int number, long index) {
        Run run(folder_, method_.c_str());
        for (int earlier = 0; earlier < number; ++earlier) require_ok(run.take_step(earlier));
        allocations_left = index;
        const fontana_status status = run.take_step(number);
        const bool was_reached = allocations_left < 0;
        allocations_left = -1;
        where_ = method_ + (only_buffers_ ? ", a buffer, step " : ", step ") + std::to_string(number) +
                 ", allocation " + std::to_string(index) + ": ";
        if (status != FONTANA_OK) {
            check_failure(status);
            const std::uint64_t before = number > 0 ? expected_[static_cast<std::size_t>(number - 1)]
                                                    : Run(folder_, method_.c_str()).state_hash();
            if (!Run::is_frame(number) && run.state_hash() != before) fail(where_ + "the simulation is not as before");
            require_ok(run.take_step(number));
        }
        const bool is_exact = is_frame_exact_ || !Run::is_frame(number);
        for (int later = number; later < Run::step_count; ++later) {
            if (later > number) require_ok(run.take_step(later));
            if (is_exact && run.state_hash() != expected_[static_cast<std::size_t>(later)])
                fail(where_ + "another result after step " + std::to_string(later));
        }
        return was_reached;
    }

    void check_failure(fontana_status status) const {
        if (status != FONTANA_OUT_OF_MEMORY) fail(where_ + "status " + std::to_string(status));
        if (std::string(fontana_last_error()).find("out of memory") == std::string::npos)
            fail(where_ + "said '" + fontana_last_error() + "'");
    }

    std::string folder_, method_, where_;
    const bool only_buffers_, is_frame_exact_;
    std::vector<std::uint64_t> expected_;  // hashes after each step of a run that lacks nothing
};

void create_fails() {
    for (long index = 0;; ++index) {
        fontana_simulation* simulation = nullptr;
        allocations_left = index;
        const fontana_status status = fontana_create(&simulation);
        allocations_left = -1;
        if (status == FONTANA_OK) {
            fontana_destroy(simulation);
            if (index == 0) fail("fontana_create allocates nothing");
            return;
        }
        if (status != FONTANA_OUT_OF_MEMORY || simulation) fail("fontana_create did not fail cleanly");
    }
}

// Threads need memory too. A default stack larger than any address space makes the system refuse them.
void threads_fail(const std::string& folder) {
#if defined(__GLIBC__)
    pthread_attr_t usual, absurd;
    pthread_getattr_default_np(&usual);
    pthread_getattr_default_np(&absurd);
    pthread_attr_setstacksize(&absurd, std::size_t{1} << 47);
    Run run(folder, "mueller");
    pthread_setattr_default_np(&absurd);
    const fontana_status status = run.take_step(2);
    pthread_setattr_default_np(&usual);
    if (status != FONTANA_OUT_OF_MEMORY) fail("threads that cannot start: status " + std::to_string(status));
    if (std::string(fontana_last_error()).find("solver.threads") == std::string::npos) fail(fontana_last_error());
    require_ok(run.take_step(2));
#else
    (void)folder;
#endif
}

}  // namespace

int main(int argument_count, char** arguments) {
    if (argument_count != 2) fail("expected a folder");
    const std::string folder = arguments[1];
    create_fails();
    threads_fail(folder);
    long tried = 0;
    for (const char* method : {"mueller", "wcsph", "pcisph", "dfsph"}) tried += Sweep(folder, method, false).run();
    for (const char* method : {"wcsph", "pcisph", "dfsph"}) tried += Sweep(folder, method, true).run();
    std::printf("%ld allocations failed, each once\n", tried);
    return tried > 400 ? EXIT_SUCCESS : EXIT_FAILURE;
}
