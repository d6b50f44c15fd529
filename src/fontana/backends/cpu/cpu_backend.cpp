#include "backends/cpu/cpu_backend.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <map>
#include <new>
#include <system_error>
#include <thread>

#include <sys/mman.h>
#include <unistd.h>

#include "backends/cpu/cpu_kernels.h"
#include "backends/cpu/device_types.h"
#include "backends/cpu/radix_sort.h"
#include "backends/cpu/thread_pool.h"
#include "util/error.h"

namespace fontana {
namespace {

// Particles a thread takes at a time: long enough to hide the counter, short enough to share out a splash evenly.
constexpr std::size_t k_grain = 512;
static_assert(k_grain / 8 % k_list_group == 0, "a thread takes whole lists");
constexpr int k_most_arguments = 16;

// Neighbours lie rows apart in several arrays at once: with pages of 4 KiB a processor would spend its time looking
// addresses up. Where the system has larger ones it may use them for a large array.
constexpr std::size_t k_large_page = std::size_t{2} << 20, k_large_array = 2 * k_large_page;

std::align_val_t alignment_of(std::size_t bytes) {
    return std::align_val_t{bytes >= k_large_array ? k_large_page : std::size_t{64}};
}

char* allocate_pages(std::size_t bytes) {
    void* data = ::operator new(bytes, alignment_of(bytes));
#ifdef MADV_HUGEPAGE
    if (bytes >= k_large_array) madvise(data, bytes, MADV_HUGEPAGE);  // advice: without it all works as well
#endif
    return static_cast<char*>(data);
}

class CpuBuffer : public Buffer {
 public:
    CpuBuffer(const std::string& name, std::size_t bytes)
        : Buffer(name, bytes), data_(allocate_pages(bytes + k_slack)), is_owner_(true) {
        std::fill_n(data_, bytes + k_slack, '\0');
    }
    CpuBuffer(const std::string& name, std::size_t bytes, char* data)
        : Buffer(name, bytes), data_(data), is_owner_(false) {}
    ~CpuBuffer() override {
        if (is_owner_) ::operator delete(data_, alignment_of(bytes() + k_slack));
    }
    char* data() const { return data_; }

 private:
    // A loop over vectors of sixteen particles reads, but does not use, up to fifteen beyond the last.
    static constexpr std::size_t k_slack = 16 * sizeof(float4);
    char* data_;
    bool is_owner_;
};

char* data_of(const Buffer& buffer) { return static_cast<const CpuBuffer&>(buffer).data(); }

struct KernelTable {
    std::vector<CpuKernel> kernels;  // indexed by Kernel
    const char* instruction_set;
    unsigned list_group = 1;
};

KernelTable choose_kernels(bool strict) {
    constexpr auto count = static_cast<std::size_t>(Kernel::count);
    if (strict) return {{strict_kernels(), strict_kernels() + count}, "strict arithmetic"};
#if defined(__x86_64__)
    // "baseline" or "avx2", not "best", runs what a lesser processor would: for tests, and to tell a compiler's fault
    // from ours.
    const char* given = std::getenv("FONTANA_CPU_INSTRUCTIONS");
    const std::string wanted = given ? given : "best";
    if (wanted != "baseline" && wanted != "avx2" && wanted != "best")
        fail(FONTANA_BAD_INPUT, "FONTANA_CPU_INSTRUCTIONS is '" + wanted + "'; expected baseline, avx2 or best");
    if (wanted != "baseline" && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
        const bool is_wider = wanted != "avx2" && __builtin_cpu_supports("avx512f");
        KernelTable table{{avx2_kernels(), avx2_kernels() + count}, is_wider ? "AVX-512" : "AVX2", k_list_group};
        for (std::size_t k = 0; k < count; ++k) {
            const char* name = kernel_facts(static_cast<Kernel>(k)).name;
            if (const KernelLoop loop = is_wider ? avx512_loop(name) : avx2_loop(name)) table.kernels[k].run = loop;
        }
        return table;
    }
#endif
    return {{baseline_kernels(), baseline_kernels() + count}, "baseline instructions"};
}

std::string processor_name() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);) {
        const std::size_t colon = line.find(": ");
        if (line.rfind("model name", 0) == 0 && colon != std::string::npos) return line.substr(colon + 2);
    }
    return "processor";
}

DeviceInfo describe(bool strict) {
    DeviceInfo info;
    info.backend = "cpu";
    info.neighbors = "grid|all-pairs";
    info.name = processor_name();
    const KernelTable table = choose_kernels(strict);
    info.driver = std::string("native, ") + table.instruction_set;
    info.list_group = table.list_group;
    const long pages = sysconf(_SC_PHYS_PAGES), page = sysconf(_SC_PAGE_SIZE);
    info.memory_bytes =
        pages > 0 && page > 0 ? static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(page) : 0;
    info.compute_units = std::max(1u, std::thread::hardware_concurrency());
    info.available = true;
    return info;
}

class CpuBackend : public Backend {
 public:
    explicit CpuBackend(const BackendOptions& options)
        : info_(describe(options.strict)),
          kernels_(choose_kernels(options.strict).kernels),
          profile_(options.profile),
          pool_(options.threads > 0 ? options.threads : static_cast<int>(info_.compute_units)) {}

    const DeviceInfo& device() const override { return info_; }

    std::unique_ptr<Buffer> allocate(const std::string& name, std::size_t bytes) override {
        try {
            return std::make_unique<CpuBuffer>(name, bytes);
        } catch (const std::bad_alloc&) {
            fail(FONTANA_OUT_OF_MEMORY, "out of memory: no " + std::to_string(bytes) + " bytes for '" + name + "'");
        }
    }

    std::unique_ptr<Buffer> part(Buffer& whole, const std::string& name, std::size_t offset,
                                 std::size_t bytes) override {
        check_range(whole, bytes, offset);
        return std::make_unique<CpuBuffer>(name, bytes, data_of(whole) + offset);
    }

    void write(Buffer& to, const void* from, std::size_t bytes, std::size_t offset) override {
        check_range(to, bytes, offset);
        if (bytes) std::memcpy(data_of(to) + offset, from, bytes);
    }

    void read(const Buffer& from, void* to, std::size_t bytes, std::size_t offset) override {
        check_range(from, bytes, offset);
        if (bytes) std::memcpy(to, data_of(from) + offset, bytes);
    }

    void copy(const Buffer& from, Buffer& to, std::size_t bytes) override {
        check_range(from, bytes, 0);
        write(to, data_of(from), bytes, 0);
    }

    void launch(Kernel kernel, std::size_t count, KernelArguments arguments) override {
        run(kernel_facts(kernel).name, kernels_[static_cast<std::size_t>(kernel)], count, arguments);
    }

    std::unique_ptr<CompiledKernel> compile(const KernelText& text) override {
        if (text.loop->argument_count > k_most_arguments)
            fail(FONTANA_BAD_INPUT, std::string("the kernel '") + text.name + "' has " +
                                        std::to_string(text.loop->argument_count) + " arguments: expected at most " +
                                        std::to_string(k_most_arguments));
        return std::make_unique<Compiled>(*this, text);
    }

    void sort(const Buffer& key, std::size_t count, std::size_t key_count, Buffer& order, Buffer& start,
              Buffer& scratch) override {
        check_range(key, count * 4, 0);
        check_range(order, count * 4, 0);
        check_range(start, (key_count + 1) * 4, 0);
        check_range(scratch, count * sizeof(RadixSort::Item) * 2, 0);
        timed("sort", count, [&] {
            sorter_.sort(pool_, reinterpret_cast<const std::uint32_t*>(data_of(key)), count, key_count,
                         reinterpret_cast<std::uint32_t*>(data_of(order)),
                         reinterpret_cast<std::uint32_t*>(data_of(start)),
                         reinterpret_cast<RadixSort::Item*>(data_of(scratch)));
        });
    }

    void finish() override {}

    std::vector<ProfileRow> profile() const override {
        std::vector<ProfileRow> rows;
        for (const auto& entry : rows_) rows.push_back(entry.second);
        return rows;
    }

 private:
    class Compiled : public CompiledKernel {
     public:
        Compiled(CpuBackend& backend, const KernelText& text) : backend_(backend), text_(text) {}
        void launch(std::size_t count, KernelArguments arguments) override {
            backend_.run(text_.name, *text_.loop, count, arguments);
        }

     private:
        CpuBackend& backend_;
        KernelText text_;
    };

    void run(const char* name, const CpuKernel& code, std::size_t count, KernelArguments arguments) {
        void* addresses[k_most_arguments];
        collect(name, code, arguments, addresses);
        timed(name, element_count(arguments), [&] {
            pool_.run(count, k_grain, [&](std::size_t begin, std::size_t end) { code.run(addresses, begin, end); });
        });
    }

    static void check_range(const Buffer& buffer, std::size_t bytes, std::size_t offset) {
        if (bytes > buffer.bytes() || offset > buffer.bytes() - bytes)
            fail(FONTANA_INTERNAL, "access beyond the end of buffer '" + buffer.name() + "'");
    }

    static void collect(const char* name, const CpuKernel& code, KernelArguments arguments, void** addresses) {
        if (static_cast<int>(arguments.size()) != code.argument_count)
            fail(FONTANA_INTERNAL, std::string("kernel '") + name + "' was launched with " +
                                       std::to_string(arguments.size()) + " arguments, not " +
                                       std::to_string(code.argument_count));
        int k = 0;
        for (const KernelArgument& argument : arguments) {
            const std::size_t bytes = argument.buffer() ? 0 : argument.value_bytes();
            if (bytes != code.value_bytes[k])
                fail(FONTANA_INTERNAL, std::string("kernel '") + name + "': argument " + std::to_string(k) +
                                           " has the wrong kind or size");
            addresses[k] = argument.buffer() ? static_cast<void*>(data_of(*argument.buffer()))
                                             : const_cast<void*>(argument.value());
            ++k;
        }
    }

    template <typename Work>
    void timed(const char* name, std::uint64_t elements, const Work& work) {
        if (!profile_) {
            work();
            return;
        }
        const auto begin = std::chrono::steady_clock::now();
        work();
        ProfileRow& row = rows_[name];
        row.name = name;
        ++row.launches;
        row.elements += elements;
        row.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    }

    DeviceInfo info_;
    std::vector<CpuKernel> kernels_;
    bool profile_;
    ThreadPool pool_;
    RadixSort sorter_;
    std::map<std::string, ProfileRow> rows_;
};

}  // namespace

std::vector<DeviceInfo> list_cpu_devices() { return {describe(false)}; }

std::unique_ptr<Backend> make_cpu_backend(const BackendOptions& options) {
    try {
        return std::make_unique<CpuBackend>(options);
    } catch (const std::system_error& error) {
        fail(FONTANA_OUT_OF_MEMORY, std::string("out of memory or threads: the system does not start as many as "
                                                "solver.threads asks for (") +
                                        error.what() + ")");
    }
}

}  // namespace fontana
