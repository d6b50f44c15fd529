// The thesis's first grid (III.4, Fig. 4) beside the sorted one that Fontana uses: the time to build each and to sum
// the density over it, and the memory of both. One thread; pointer_grid.py builds this program and runs it.
//
//   pointer_grid COUNT lattice|shuffled CAPACITY COMPRESSION REPEATS
//
// Prints one JSON object. Exit code 0; 1 if the two densities disagree; 2 for bad arguments; 3 if cells of the pointer
// grid are full, with how many and how many particles found no place.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <random>
#include <vector>

#include "pointer_grid.h"
#include "solver/constants.h"
#include "sorted_grid.h"

namespace {

using namespace fontana;

constexpr double k_tolerance = 1e-5;  // of the largest density

struct Options {
    std::size_t count;
    bool shuffled;
    std::size_t capacity;  // pointers of a cell
    float compression;     // of the lattice: 0.5 packs eight times as many particles into a cell
    int repeats;
};

bool parse(int count, char** words, Options& options) {
    if (count != 6) return false;
    options.count = std::strtoull(words[1], nullptr, 10);
    options.shuffled = std::strcmp(words[2], "shuffled") == 0;
    options.capacity = std::strtoull(words[3], nullptr, 10);
    options.compression = std::strtof(words[4], nullptr);
    options.repeats = std::atoi(words[5]);
    return options.count > 0 && options.count <= 100000000 && options.capacity > 0 && options.capacity <= 4096 &&
           options.compression > 0.0f && options.compression <= 1.0f && options.repeats > 0 &&
           (options.shuffled || std::strcmp(words[2], "lattice") == 0);
}

// A cube of fluid on a jittered lattice. Shuffled: in the order of nothing, as particles that never move in memory are
// after the fluid has been stirred.
std::vector<float4> make_fluid(const Options& options, const Parameters& parameters) {
    const auto side = static_cast<std::size_t>(std::ceil(std::cbrt(static_cast<double>(options.count)) - 1e-9));
    std::mt19937 random(1);
    std::uniform_real_distribution<float> jitter(-0.2f, 0.2f);
    const float step = options.compression * static_cast<float>(parameters.fluid_particle_spacing);
    const auto mass = static_cast<float>(particle_mass(parameters));
    std::vector<float4> fluid(options.count);
    for (std::size_t i = 0; i < options.count; ++i) {
        const auto along = [&](std::size_t cell) { return (static_cast<float>(cell) + 0.5f + jitter(random)) * step; };
        fluid[i] = {along(i % side), along(i / side / side), along(i / side % side), mass};
    }
    if (options.shuffled) std::shuffle(fluid.begin(), fluid.end(), random);
    return fluid;
}

template <typename Work>
double milliseconds(const Work& work) {
    const auto begin = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

// As `fontana bench` writes them.
void print_statistics(const char* name, std::vector<double> values) {
    std::sort(values.begin(), values.end());
    std::printf("\"%s\": {\"median\": %.5g, \"minimum\": %.5g, \"maximum\": %.5g, \"repeats\": %zu}, ", name,
                values[values.size() / 2], values.front(), values.back(), values.size());
}

struct Times {
    std::vector<double> build, density;  // ms
};

void print(const char* name, const Times& times, std::size_t grid_bytes, std::size_t particle_bytes) {
    std::vector<double> together(times.build.size());
    for (std::size_t k = 0; k < together.size(); ++k) together[k] = times.build[k] + times.density[k];
    std::printf(", \"%s\": {", name);
    print_statistics("build_milliseconds", times.build);
    print_statistics("density_milliseconds", times.density);
    print_statistics("milliseconds", together);
    std::printf("\"grid_bytes\": %zu, \"particle_bytes\": %zu}", grid_bytes, particle_bytes);
}

double disagreement(const std::vector<float>& a, const std::vector<float>& b) {
    double largest = 0.0, difference = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        largest = std::max(largest, static_cast<double>(std::fabs(b[i])));
        const double here = std::fabs(static_cast<double>(a[i]) - static_cast<double>(b[i]));
        if (!(here <= difference)) difference = here;
    }
    return difference / largest;
}

}  // namespace

int main(int argument_count, char** arguments) {
    Options options;
    if (!parse(argument_count, arguments, options)) {
        std::fprintf(stderr, "expected: pointer_grid COUNT lattice|shuffled CAPACITY COMPRESSION REPEATS\n");
        return 2;
    }
    const Parameters parameters;  // the defaults
    const StepConstants constants = make_constants(parameters);
    const std::vector<float4> fluid = make_fluid(options, parameters);
    // Room to splash, as a box has: twice as wide and one and a half times as high as the fluid.
    const double edge = std::cbrt(static_cast<double>(options.count)) * parameters.fluid_particle_spacing;
    const auto depth = static_cast<float>(edge);
    PointerGrid pointers(fluid, constants, 2.0f * depth, 1.5f * depth, depth, options.capacity);
    SortedGrid sorted(fluid, constants);

    Times pointer_times, sorted_times;
    for (int k = 0; k < options.repeats + 1; ++k) {
        const double build = milliseconds([&] { pointers.build(); });
        if (pointers.overflow().particles > 0) break;
        const double density = milliseconds([&] { pointers.sum_density(); });
        const double sorted_build = milliseconds([&] { sorted.build(); });
        const double sorted_density = milliseconds([&] { sorted.sum_density(); });
        if (k == 0) continue;  // the first touches the memory
        pointer_times.build.push_back(build);
        pointer_times.density.push_back(density);
        sorted_times.build.push_back(sorted_build);
        sorted_times.density.push_back(sorted_density);
    }
    std::printf("{\"particles\": %zu, \"order\": \"%s\", \"capacity\": %zu, \"compression\": %g", options.count,
                options.shuffled ? "shuffled" : "lattice", options.capacity, static_cast<double>(options.compression));
    if (pointers.overflow().particles > 0) {
        std::printf(", \"full_cells\": %zu, \"particles_without_place\": %zu}\n", pointers.overflow().cells,
                    pointers.overflow().particles);
        return 3;
    }
    const double difference = disagreement(pointers.density(), sorted.density());
    std::printf(", \"fullest_cell\": %zu, \"disagreement\": %.3g", pointers.fullest_cell(), difference);
    print("pointer_grid", pointer_times, pointers.grid_bytes(), pointers.particle_bytes());
    print("sorted_grid", sorted_times, sorted.grid_bytes(), sorted.particle_bytes());
    std::printf("}\n");
    return difference <= k_tolerance ? 0 : 1;
}
