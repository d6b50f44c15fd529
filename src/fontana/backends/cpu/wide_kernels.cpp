// The neighbour loops of the fast arithmetic, eight neighbours at once. Formulas are those of kernels/: pair.h and
// force_pair.h are included a second time here, with vectors for REAL. Only the loops are this file's own, and each is
// tested against the plain one.
//
// Lists of neighbours are padded with the particle itself, which adds nothing to a gradient (x_ii = 0).
#include "backends/cpu/cpu_kernels.h"
#include "backends/cpu/wide.h"
#include "kernels/kernels.h"

namespace fontana {
namespace wide {

#undef REAL
#undef REAL4
#undef REAL_ZERO
#undef SQRT
#undef FONTANA_SMOOTHING_H
#undef FONTANA_FORCE_PAIR_H
#undef FONTANA_SPLINE_H
#undef FONTANA_PAIR_H
#define REAL Vec8
#define REAL4 Vec8x4
#define REAL_ZERO \
    Vec8 {}
#define SQRT(a) wide_sqrt(a)
#include "kernels/force_pair.h"
#include "kernels/pair.h"

// Hits of one particle collected before the forces are computed; flushed when full.
constexpr uint k_most_hits = 256;

::Real3 sum_of(const Real3& v) { return {sum_of(v.x), sum_of(v.y), sum_of(v.z)}; }

// Lanes of a vector that starts at j and are still within the range.
uint lanes_within(uint j, uint end) { return end - j >= width ? 0xffu : (1u << (end - j)) - 1u; }

Vec8 distance_squared(const float4& a, const Vec8x4& b) {
    const Vec8 dx = a.x - b.x, dy = a.y - b.y, dz = a.z - b.z;
    return dx * dx + dy * dy + dz * dz;
}

// Calls visit(first index of the vector, mask of hits, neighbours, squared distances) over the candidates of particle
// i.
template <typename Visit>
inline __attribute__((always_inline)) void for_hits(const StepConstants& c, const float4* position,
                                                    const uint* cell_start, const float4& x_i, const Visit& visit) {
    const CellCoordinates cell = cell_of(c, x_i);
    const uint range_count = candidate_range_count(c, cell);
    for (uint k = 0; k < range_count; ++k) {
        const Range range = candidate_range(c, cell, k, cell_start);
        for (uint j = range.begin; j < range.end; j += width) {
            const Vec8x4 x_j = load(position + j);
            const Vec8 r_squared = distance_squared(x_i, x_j);
            const uint hits = less_mask(r_squared, c.support_radius_squared) & lanes_within(j, range.end);
            if (hits) visit(j, hits, x_j, r_squared);
        }
    }
}

// As a mask of whole lanes.
Vec8 keep(uint mask, Vec8 a) {
    const __m256i bits = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
    const __m256i set = _mm256_and_si256(_mm256_set1_epi32(static_cast<int>(mask)), bits);
    return _mm256_and_ps(_mm256_castsi256_ps(_mm256_cmpeq_epi32(set, bits)), a);
}

void density(uint begin, uint end, const StepConstants& c, const float4* position, const float4* velocity,
             const uint* cell_start, float* density_out, float4* packed_position, float4* packed_velocity) {
    for (uint i = begin; i < end; ++i) {
        const float4 x_i = position[i];
        Vec8 sum{};
        for_hits(c, position, cell_start, x_i, [&](uint, uint hits, const Vec8x4& x_j, Vec8 r_squared) {
            sum += keep(hits, x_j.w * poly6(r_squared, c.support_radius_squared));
        });
        store_pressure_state(c, i, sum_of(sum), x_i, velocity[i], density_out, packed_position, packed_velocity);
    }
}

void fluid_force(uint begin, uint end, const StepConstants& c, const float4* packed_position,
                 const float4* packed_velocity, const float* density_in, const uint* cell_start, float4* acceleration) {
    for (uint i = begin; i < end; ++i) {
        const float4 x_i = packed_position[i], v_i = packed_velocity[i];
        uint hit[k_most_hits + width], count = 0;
        ForceSum sum = zero_force();
        const auto flush = [&] {
            for (uint k = count; k % width != 0; ++k) hit[k] = i;
            for (uint k = 0; k < count; k += width)
                sum = add_force(sum, c, x_i, v_i, gather(packed_position, hit + k), gather(packed_velocity, hit + k));
            count = 0;
        };
        for_hits(c, packed_position, cell_start, x_i, [&](uint j, uint hits, const Vec8x4&, Vec8) {
            count += compress_store(hits, j, hit + count);
            if (count > k_most_hits - width) flush();
        });
        flush();
        const ::ForceSum total = {sum_of(sum.pressure_x), sum_of(sum.pressure_y), sum_of(sum.pressure_z),
                                  sum_of(sum.viscous_x),  sum_of(sum.viscous_y),  sum_of(sum.viscous_z)};
        acceleration[i] = force_to_acceleration(c, total, density_in[i]);
    }
}

void build_neighbor_list(uint begin, uint end, const StepConstants& c, const float4* position, const uint* cell_start,
                         uint* neighbor_count, uint* list) {
    for (uint i = begin; i < end; ++i) {
        uint* const mine = list + std::size_t{i} * c.list_particle_stride;
        uint count = 0;
        for_hits(c, position, cell_start, position[i], [&](uint j, uint hits, const Vec8x4&, Vec8) {
            if (i - j < width) hits &= ~(1u << (i - j));
            if (count + width <= c.list_capacity)
                count += compress_store(hits, j, mine + count);
            else
                for (; hits; hits &= hits - 1, ++count)
                    if (count < c.list_capacity) mine[count] = j + static_cast<uint>(__builtin_ctz(hits));
        });
        neighbor_count[i] = count;
        pad_list(c, list, i, count);
    }
}

// Calls visit(indices of eight neighbours, their volumes and positions, pair) along the list of particle i.
template <typename Visit>
inline __attribute__((always_inline)) void for_list(const StepConstants& c, uint i, const uint* neighbor_count,
                                                    const uint* list, const float4* volume_position,
                                                    const Visit& visit) {
    const uint* const mine = list + std::size_t{i} * c.list_particle_stride;
    const uint count = list_length(c, neighbor_count[i]);
    const float4 x_i = volume_position[i];
    for (uint k = 0; k < count; k += width) {
        const Vec8x4 x_j = gather(volume_position, mine + k);
        visit(mine + k, x_j, pair_of(x_i, x_j));
    }
}

void spline_density(uint begin, uint end, const StepConstants& c, const float4* position, const uint* neighbor_count,
                    const uint* list, const float4* volume_position, const ColliderConstants* collider,
                    float* density_out, float4* factor, float* wall_rate) {
    for (uint i = begin; i < end; ++i) {
        Vec8 relative{}, squares{};
        Real3 s = zero_vector();
        for_list(c, i, neighbor_count, list, volume_position, [&](const uint* j, const Vec8x4& x_j, const Pair& pair) {
            relative += without(x_j.w * kernel_value(c, pair.r), j, i);
            s = add_gradient(s, c, x_j.w, pair);
            squares += gradient_squared_term(c, x_j.w, pair);
        });
        const WallTerm walls = walls_at(c, collider, position[i]);
        const float volume = volume_position[i].w;
        const float own = volume * ::kernel_value(c, 0.0f) + walls.share;
        store_density(c, i, volume, own + sum_of(relative), sum_of(s), sum_of(squares), walls, density_out, factor,
                      wall_rate);
    }
}

float divergence(const StepConstants& c, uint i, const uint* neighbor_count, const uint* list,
                 const float4* volume_position, const float4* factor, const float4* field) {
    Vec8 sum{};
    for_list(c, i, neighbor_count, list, volume_position, [&](const uint* j, const Vec8x4& x_j, const Pair& pair) {
        sum += divergence_term(c, x_j.w, pair, gather(field, j));
    });
    const float4 s = factor[i], a = field[i];
    return s.x * a.x + s.y * a.y + s.z * a.z - sum_of(sum);
}

void density_rate(uint begin, uint end, const StepConstants& c, const float4* velocity, const uint* neighbor_count,
                  const uint* list, const float4* volume_position, const float4* factor, const float* wall_rate,
                  float* rate) {
    for (uint i = begin; i < end; ++i)
        rate[i] = divergence(c, i, neighbor_count, list, volume_position, factor, velocity) - wall_rate[i];
}

void jacobi_step(uint begin, uint end, const StepConstants& c, float relaxation, const float4* gradient,
                 const uint* neighbor_count, const uint* list, const float4* volume_position, const float4* factor,
                 const float* target, const float* u, float* residual, float* step) {
    for (uint i = begin; i < end; ++i)
        store_jacobi_step(i, relaxation, divergence(c, i, neighbor_count, list, volume_position, factor, gradient),
                          factor, target, u, residual, step);
}

void pressure_gradient(uint begin, uint end, const StepConstants& c, const float* u, const uint* neighbor_count,
                       const uint* list, const float4* volume_position, const float4* factor, float4* gradient) {
    for (uint i = begin; i < end; ++i) {
        Real3 sum = zero_vector();
        for_list(c, i, neighbor_count, list, volume_position, [&](const uint* j, const Vec8x4& x_j, const Pair& pair) {
            sum = add_gradient(sum, c, x_j.w * gather(u, j), pair);
        });
        store_gradient(i, u[i], factor[i], sum_of(sum), gradient);
    }
}

void laplacian_viscosity(uint begin, uint end, const StepConstants& c, const float4* velocity,
                         const uint* neighbor_count, const uint* list, const float4* volume_position,
                         float4* acceleration) {
    for (uint i = begin; i < end; ++i) {
        const float4 v_i = velocity[i];
        Real3 sum = zero_vector();
        for_list(c, i, neighbor_count, list, volume_position, [&](const uint* j, const Vec8x4& x_j, const Pair& pair) {
            sum = add_gradient(sum, c, viscosity_weight(c, x_j.w, pair, v_i, gather(velocity, j)), pair);
        });
        store_viscosity(c, i, sum_of(sum), acceleration);
    }
}

void correct_pressure(uint begin, uint end, const StepConstants& c, float delta, const float4* predicted,
                      const uint* neighbor_count, const uint* list, const ColliderConstants* collider,
                      const float4* factor, float* u, float* residual) {
    for (uint i = begin; i < end; ++i) {
        Vec8 relative{};
        for_list(c, i, neighbor_count, list, predicted, [&](const uint* j, const Vec8x4& x_j, const Pair& pair) {
            relative += without(x_j.w * kernel_value(c, pair.r), j, i);
        });
        const float4 x_i = predicted[i];
        const float own = x_i.w * ::kernel_value(c, 0.0f) + walls_at(c, collider, x_i).share;
        store_correction(c, i, delta, own + sum_of(relative), factor, u, residual);
    }
}

}  // namespace wide

namespace {

// A wide loop takes the arguments of the plain kernel of the same name, with a range in place of the thread's index;
// the compiler holds it to that.
template <typename Plain, typename Wide>
struct Loop;

template <typename... P, typename... W>
struct Loop<void (*)(uint, P...), void (*)(uint, uint, W...)> {
    static_assert((std::is_same_v<P, std::remove_cv_t<std::remove_reference_t<W>>> && ...));

    template <void (*loop)(uint, uint, W...)>
    static void run(void* const* arguments, std::size_t begin, std::size_t end) {
        run_with<loop>(arguments, begin, end, std::index_sequence_for<W...>());
    }

    template <void (*loop)(uint, uint, W...), std::size_t... k>
    static void run_with(void* const* arguments, std::size_t begin, std::size_t end, std::index_sequence<k...>) {
        loop(static_cast<uint>(begin), static_cast<uint>(end), KernelValue<P>::get(arguments[k])...);
    }
};

}  // namespace

KernelLoop wide_loop(const char* kernel) {
    const struct {
        const char* name;
        KernelLoop run;
    } table[] = {
#define WIDE(function) {#function, &Loop<decltype(&::function), decltype(&wide::function)>::run<&wide::function>},
        WIDE(density) WIDE(fluid_force) WIDE(build_neighbor_list) WIDE(spline_density) WIDE(density_rate)
            WIDE(jacobi_step) WIDE(pressure_gradient) WIDE(laplacian_viscosity) WIDE(correct_pressure)
#undef WIDE
    };
    for (const auto& row : table)
        if (__builtin_strcmp(row.name, kernel) == 0) return row.run;
    return nullptr;
}

}  // namespace fontana
