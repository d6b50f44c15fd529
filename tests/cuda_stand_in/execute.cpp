#include "execute.h"

#include <ucontext.h>
#include <csetjmp>

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <memory>
#include <string>

namespace stand_in {
namespace {

constexpr int k_launch_failed = 719;
constexpr std::size_t k_stack_bytes = 64u << 10;
constexpr int k_pattern = 0xA5;

// The launch at work; the driver runs one at a time.
DeviceMemory* memory_at_work;

[[noreturn]] void stop_with(const Thread& thread, int code, const std::string& what) {
    throw DeviceFault(code, "kernel " + std::string(thread.launch->kernel) + ", block " + std::to_string(thread.block) +
                                ", thread " + std::to_string(thread.lane) + ": " + what);
}

void find(const Thread& thread, Site& site, std::uint64_t address, std::size_t bytes, Access access) {
    try {
        memory_at_work->find(thread.launch->number, site, address, bytes, access);
    } catch (const DeviceFault& fault) {
        stop_with(thread, fault.code(), fault.what());
    }
}

void stop(const Thread& thread, const char* what) { stop_with(thread, k_launch_failed, what); }

bool is_reversed;

unsigned placed(unsigned index, unsigned count) { return is_reversed ? count - 1 - index : index; }

// A thread of a block with barriers, on a stack of its own: it leaves at a barrier and comes back when all have. A
// stack is made once and serves one thread after the other.
struct Fiber {
    enum State { fresh, running, waiting, ended };

    Thread thread;
    const KernelCode* kernel = nullptr;
    State state = fresh;
    std::exception_ptr fault;
    std::unique_ptr<char[]> stack{new char[k_stack_bytes]};
    // Switching by jumps spares the system call with which swapcontext saves signals: a sort switches a million times.
    jmp_buf place, scheduler;
    bool has_begun = false;
};

Fiber* fiber_at_work;

void leave(Fiber& fiber, Fiber::State state) {
    fiber.state = state;
    if (_setjmp(fiber.place) == 0) _longjmp(fiber.scheduler, 1);
}

[[noreturn]] void run_threads() {
    Fiber& fiber = *fiber_at_work;
    for (;;) {
        try {
            fiber.kernel->run(fiber.thread);
        } catch (...) {
            fiber.fault = std::current_exception();
        }
        leave(fiber, Fiber::ended);
    }
}

void wait_at_barrier(Thread&) { leave(*fiber_at_work, Fiber::waiting); }

void begin(Fiber& fiber) {
    static ucontext_t unused;
    ucontext_t context;
    getcontext(&context);
    context.uc_stack.ss_sp = fiber.stack.get();
    context.uc_stack.ss_size = k_stack_bytes;
    context.uc_link = nullptr;
    makecontext(&context, run_threads, 0);
    fiber.has_begun = true;
    swapcontext(&unused, &context);
}

// Comes back when the fiber's thread waits or has ended.
void enter(Fiber& fiber) {
    fiber_at_work = &fiber;
    fiber.state = Fiber::running;
    if (_setjmp(fiber.scheduler) != 0) return;
    if (fiber.has_begun) _longjmp(fiber.place, 1);
    begin(fiber);
}

// Runs all up to their next barrier or their end. Returns how many wait.
unsigned run_round(std::vector<Fiber>& fibers, unsigned count) {
    unsigned waiting = 0;
    for (unsigned index = 0; index < count; ++index) {
        Fiber& fiber = fibers[placed(index, count)];
        if (fiber.state == Fiber::ended) continue;
        enter(fiber);
        if (fiber.fault) std::rethrow_exception(fiber.fault);
        waiting += fiber.state == Fiber::waiting;
    }
    return waiting;
}

void run_with_barriers(const KernelCode& kernel, Thread thread) {
    static std::vector<Fiber> kept;
    const unsigned count = thread.launch->block_size;
    std::vector<Fiber> fibers;
    fibers.swap(kept);  // those of a block that a fault has stopped are not used again
    if (fibers.size() < count) fibers = std::vector<Fiber>(count);
    for (unsigned lane = 0; lane < count; ++lane) {
        fibers[lane].thread = thread;
        fibers[lane].thread.lane = lane;
        fibers[lane].kernel = &kernel;
        fibers[lane].state = Fiber::fresh;
    }
    while (const unsigned waiting = run_round(fibers, count))
        if (waiting != count)
            stop_with(thread, k_launch_failed,
                      "a barrier that " + std::to_string(count - waiting) + " threads of the block never reach");
    kept.swap(fibers);
}

void run_block(const KernelCode& kernel, Thread thread) {
    if (kernel.has_barriers) return run_with_barriers(kernel, thread);
    const unsigned count = thread.launch->block_size;
    for (unsigned index = 0; index < count; ++index) {
        thread.lane = placed(index, count);
        kernel.run(thread);
    }
}

}  // namespace

void execute(const KernelCode& kernel, unsigned grid_size, unsigned block_size,
             const std::vector<unsigned char>& parameters, DeviceMemory& memory) {
    static std::uint64_t launch_count = 0;
    Launch launch;
    launch.kernel = kernel.name;
    launch.number = ++launch_count;
    launch.block_size = block_size;
    launch.grid_size = grid_size;
    launch.parameters = parameters.data();
    launch.parameter_bytes = parameters.size();
    launch.shared_bytes = kernel.shared_bytes;
    launch.find = find;
    launch.barrier = wait_at_barrier;
    launch.stop = stop;
    memory_at_work = &memory;
    const char* order = std::getenv("FONTANA_STAND_IN_ORDER");
    is_reversed = order && std::string(order) == "reversed";
    std::vector<unsigned char> shared(kernel.shared_bytes);
    for (unsigned index = 0; index < grid_size; ++index) {
        std::fill(shared.begin(), shared.end(), static_cast<unsigned char>(k_pattern));
        Thread thread;
        thread.launch = &launch;
        thread.block = placed(index, grid_size);
        thread.shared = shared.data();
        run_block(kernel, thread);
    }
}

}  // namespace stand_in
