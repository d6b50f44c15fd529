// The neighbour loops of the fast arithmetic, a vector of neighbours at once. Formulas are those of kernels/: pair.h
// and others are included a second time here, with vectors for REAL. Only the loops are this file's own, and each is
// tested against the plain one. Compiled once for each instruction set; FONTANA_WIDE is its name.
//
// Loops over candidates take one particle at a time (wide_candidates.h), loops over lists the few that share one
// (wide_lists.h).
#include "backends/cpu/cpu_kernels.h"
#if defined(__AVX512F__)
#include "backends/cpu/wide_avx512.h"
#else
#include "backends/cpu/wide_avx2.h"
#endif
#include "kernels/kernels.h"

namespace fontana {
namespace FONTANA_WIDE {

#undef REAL
#undef REAL4
#undef REAL_ZERO
#undef INVERSE_SQRT
#undef REAL_FLOOR
#undef QUICK_INVERSE_SQRT
#undef FONTANA_SMOOTHING_H
#undef FONTANA_FORCE_PAIR_H
#undef FONTANA_SPLINE_H
#undef FONTANA_PAIR_H
#undef FONTANA_ANDERSON_H
#undef FONTANA_COARSE_PAIR_H
#define REAL Vec
#define REAL4 Vec4
#define REAL_ZERO \
    Vec {}
#define INVERSE_SQRT(a) inverse_sqrt(a)
#define REAL_FLOOR(a) floor_of(a)
#define QUICK_INVERSE_SQRT(a) quick_inverse_sqrt(a)
#include "kernels/anderson.h"
#include "kernels/coarse_pair.h"
#include "kernels/force_pair.h"
#include "kernels/pair.h"

}  // namespace FONTANA_WIDE
}  // namespace fontana

#include "backends/cpu/wide_candidates.h"
#include "backends/cpu/wide_lists.h"

#include "backends/cpu/wide_coarse.h"

namespace fontana {
namespace FONTANA_WIDE {

// Hits of one particle collected before the forces are computed; flushed when full.
constexpr uint k_most_hits = 256;

void density(uint begin, uint end, const StepConstants& c, const float4* position, const float4* velocity,
             const uint* cell_start, float* density_out, float4* packed_position, float4* packed_velocity,
             float* pressure) {
    Candidates candidates(c, position, cell_start);
    for (uint i = begin; i < end; ++i) {
        const float4 x_i = position[i];
        Vec sum{};
        candidates.choose(&x_i, 1);
        candidates.for_all([&](const Vec4& x_j, const uint*) {
            // At the support radius the kernel is zero.
            const Vec r_squared = min_f(distance_squared(x_i, x_j), c.support_radius_squared);
            sum += x_j.w * poly6(r_squared, c.support_radius_squared);
        });
        store_pressure_state(c, i, sum_of(sum), x_i, velocity[i], density_out, packed_position, packed_velocity,
                             pressure);
    }
}

void fluid_force(uint begin, uint end, const StepConstants& c, const float4* packed_position,
                 const float4* packed_velocity, const float* density_in, const uint* cell_start, float4* acceleration) {
    Candidates candidates(c, packed_position, cell_start);
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
        candidates.choose(&x_i, 1);
        candidates.for_all([&](const Vec4& x_j, const uint* index) {
            const uint hits = less_mask(distance_squared(x_i, x_j), c.support_radius_squared);
            count += compress_store(hits, index, hit + count);
            if (count > k_most_hits - width) flush();
        });
        flush();
        const ::ForceSum total = {sum_of(sum.pressure_x), sum_of(sum.pressure_y), sum_of(sum.pressure_z),
                                  sum_of(sum.viscous_x),  sum_of(sum.viscous_y),  sum_of(sum.viscous_z)};
        acceleration[i] = force_to_acceleration(c, total, density_in[i]);
    }
}

void build_neighbor_list(uint begin, uint end, const StepConstants& c, const float4* position, const uint* cell_start,
                         uint* list_start, short* list) {
    Candidates candidates(c, position, cell_start);
    ListWriter writer(c, list_start, reinterpret_cast<uint*>(list));
    for (uint first = begin; first < end; first += k_list_group) {
        const Members members(first, end, position);
        candidates.choose(members.x, members.count);
        writer.write(members, candidates);
    }
    writer.flush();
}

// Adds all neighbours to the sums of every member. They are turned round a few vectors at a time, then visited by each
// member from the first-level cache: the sums of all members at once are more than there are registers.
void add_neighbors(const StepConstants& c, const Members& members, const Members& motion, const float4* position,
                   const float4* velocity, const uint* list_start, const short* list, NeighborhoodSums* sums) {
    constexpr uint k_room = 8;
    Vec4 x[k_room], v[k_room];
    uint count = 0;
    const auto visit_all = [&] {
        for (uint s = 0; s < members.count; ++s) {
            NeighborhoodSums sum = sums[s];
            for (uint k = 0; k < count; ++k)
                sum = add_neighbor(sum, c, x[k].w, pair_of(members.x[s], x[k]), motion.x[s], v[k]);
            sums[s] = sum;
        }
        count = 0;
    };
    for_list(members.first, list_start, list, position, [&](const uint* j, const Vec4& x_j) {
        x[count] = x_j;
        v[count] = gather(velocity, j);
        if (++count == k_room) visit_all();
    });
    visit_all();
}

void sum_neighborhood(uint begin, uint end, const StepConstants& c, const float4* position, const float4* velocity,
                      const uint* list_start, const short* list, const ColliderConstants* collider, float* density_out,
                      float4* factor, float* wall_rate, float* rate, float4* viscous) {
    for (uint first = begin; first < end; first += k_list_group) {
        const Members members(first, end, position), motion(first, end, velocity);
        NeighborhoodSums sums[k_list_group];
        for (NeighborhoodSums& zero : sums) zero = no_neighborhood();
        add_neighbors(c, members, motion, position, velocity, list_start, list, sums);
        for (uint s = 0; s < members.count; ++s) {
            const uint i = first + s;
            const float4 g = sums_of(sums[s].gradient.x, sums[s].gradient.y, sums[s].gradient.z, sums[s].squares);
            const float4 shear = sums_of(sums[s].shear.x, sums[s].shear.y, sums[s].shear.z, sums[s].density);
            const WallTerm walls = walls_at(c, collider, members.x[s]);
            const float4 factor_i = factor_of(c, members.x[s].w, {g.x, g.y, g.z}, g.w, walls);
            density_out[i] = shear.w + c.rest_density * walls.share;
            factor[i] = factor_i;
            wall_rate[i] = walls.rate;
            rate[i] = divergence_of(c, factor_i, motion.x[s], sum_of(sums[s].flow)) - walls.rate;
            viscous[i] = viscosity_of(c, {shear.x, shear.y, shear.z});
        }
    }
}

void sum_changed(uint begin, uint end, const StepConstants& c, const uint* changed, const float4* position,
                 const float4* velocity, const uint* list_start, const short* list, const ColliderConstants* collider,
                 float* density_out, float4* factor, float* wall_rate, float* rate, float4* viscous) {
    for_marked_groups(changed, begin, end, [&](uint first, uint last) {
        sum_neighborhood(first, last, c, position, velocity, list_start, list, collider, density_out, factor, wall_rate,
                         rate, viscous);
    });
}

void pressure_residual(uint begin, uint end, const StepConstants& c, const float4* pressed_velocity,
                       const uint* list_start, const short* list, const float4* position, const float4* factor,
                       const float* excess, float* residual) {
    for (uint first = begin; first < end; first += k_list_group) {
        const Members members(first, end, position);
        Vec sum[k_list_group] = {};
        for_list(first, list_start, list, position, [&](const uint* j, const Vec4& x_j) {
            const Vec4 v_j = gather(pressed_velocity, j);
            for (uint s = 0; s < k_list_group; ++s)
                sum[s] += divergence_term(c, x_j.w, quick_pair_of(members.x[s], x_j), v_j);
        });
        const float4 sums = sums_of(sum[0], sum[1], sum[2], sum[3]);
        for (uint s = 0; s < members.count; ++s) {
            const uint i = first + s;
            const float rate = divergence_of(c, factor[i], pressed_velocity[i], (&sums.x)[s]);
            residual[i] = factor[i].w > 0.0f ? excess[i] + rate : 0.0f;
        }
    }
}

// G u at every particle: store(i, the result).
template <typename Store>
inline __attribute__((always_inline)) void for_gradient(uint begin, uint end, const StepConstants& c, const float* u,
                                                        const uint* list_start, const short* list,
                                                        const float4* position, const float4* factor,
                                                        const Store& store) {
    for (uint first = begin; first < end; first += k_list_group) {
        const Members members(first, end, position);
        Real3 sum[k_list_group];
        for (Real3& zero : sum) zero = zero_vector();
        for_list(first, list_start, list, position, [&](const uint* j, const Vec4& x_j) {
            const Vec weight = x_j.w * gather(u, j);
            for (uint s = 0; s < k_list_group; ++s)
                sum[s] = add_gradient(sum[s], c, weight, quick_pair_of(members.x[s], x_j));
        });
        for (uint s = 0; s < members.count; ++s) {
            const uint i = first + s;
            const float4 g = sums_of(sum[s].x, sum[s].y, sum[s].z, Vec{});
            store(i, gradient_of(c, u[i], factor[i], {g.x, g.y, g.z}));
        }
    }
}

void pressure_gradient(uint begin, uint end, const StepConstants& c, const float* u, const uint* list_start,
                       const short* list, const float4* position, const float4* factor, float4* gradient) {
    for_gradient(begin, end, c, u, list_start, list, position, factor, [&](uint i, float4 g) { gradient[i] = g; });
}

void pressed_velocity(uint begin, uint end, const StepConstants& c, const float* u, const uint* list_start,
                      const short* list, const float4* position, const float4* factor, const float4* velocity,
                      float4* out) {
    for_gradient(begin, end, c, u, list_start, list, position, factor,
                 [&](uint i, float4 g) { out[i] = pressed(c, velocity[i], g); });
}

void crowding_gradient(uint begin, uint end, const StepConstants& c, const uint* moved, const float* lambda,
                       const uint* list_start, const short* list, const float4* position, const float4* factor,
                       float4* gradient) {
    for_marked_groups(moved, begin, end, [&](uint first, uint last) {
        pressure_gradient(first, last, c, lambda, list_start, list, position, factor, gradient);
    });
}

// A shared list may have a few more than a particle's own: these get a move, or a change, of nothing.
void mark_crowded(uint begin, uint end, const StepConstants& c, const float* lambda, const uint* list_start,
                  const short* list, uint* moved) {
    (void)c;
    for (uint i = begin; i < end; ++i)
        if (lambda[i] > 0.0f) for_indices(i, list_start, list, [&](uint j) { STORE_SAME(moved + j, 1u); });
}

void move_apart(uint begin, uint end, const StepConstants& c, const uint* moved, const float4* gradient,
                const uint* list_start, const short* list, float4* position, uint* changed) {
    for (uint i = begin; i < end; ++i) {
        if (moved[i] == 0u) continue;
        position[i] = moved_down(c, position[i], gradient[i]);
        for_indices(i, list_start, list, [&](uint j) { STORE_SAME(changed + j, 1u); });
    }
}

void correct_pressure(uint begin, uint end, const StepConstants& c, float delta, const float4* position,
                      const float4* predicted, const uint* list_start, const short* list,
                      const ColliderConstants* collider, const float4* factor, float* u, float* residual) {
    for (uint first = begin; first < end; first += k_list_group) {
        const Members members(first, end, position), then(first, end, predicted);
        Vec density[k_list_group] = {};
        for_list(first, list_start, list, position, [&](const uint* j, const Vec4& x_j) {
            const Vec4 y_j = gather(predicted, j);
            for (uint s = 0; s < k_list_group; ++s) {
                const uint is_near = less_mask(distance_squared(members.x[s], x_j), c.support_radius_squared);
                density[s] += keep(is_near, x_j.w * kernel_value(c, pair_of(then.x[s], y_j).r));
            }
        });
        for (uint s = 0; s < members.count; ++s) {
            const float wall_share = walls_at(c, collider, then.x[s]).share;
            store_correction(c, first + s, delta, sum_of(density[s]), wall_share, factor, u, residual);
        }
    }
}

// The coarse correction of `count` particles from `first` on; 0 where it is not for them. A cell's share one.
void coarse_corrections(uint first, uint count, const StepConstants& c, const CoarseLevel& level,
                        const float4* position, const uint* cell_start, const float* weight, const float* residual,
                        const float* z, const float* u, float* corrections) {
    for (uint k = 0; k < count;) {
        const float4 x = position[first + k];
        const uint cell_end = cell_start[cell_key(c, cell_of(c, x)) + 1];
        const float z_here = coarse_correction(c, level, x, cell_start, z);
        for (; k < count && first + k < cell_end; ++k) {
            const uint i = first + k;
            corrections[k] = is_pressed(weight[i], residual[i], u[i]) ? z_here : 0.0f;
        }
    }
}

// By whole vectors to the end of the range: a remainder in other instructions would be rounded otherwise, and where a
// range ends depends on the threads.
void relax(uint begin, uint end, const StepConstants& c, const float& relaxation, const uint& with_coarse,
           const CoarseLevel& level, const float4* position, const uint* cell_start, const float4* factor,
           const float* weight, const float* residual, const float* z, const float* u, float* step) {
    for (uint i = begin; i < end; i += width) {
        const uint count = end - i < width ? end - i : width;
        float corrections[width] = {};
        if (with_coarse)
            coarse_corrections(i, count, c, level, position, cell_start, weight, residual, z, u, corrections);
        float steps[width];
        store(steps, relaxed_step(relaxation, load(factor + i).w, load(residual + i), load(corrections), load(u + i)));
        __builtin_memcpy(step + i, steps, count * sizeof(float));
    }
}

// Neighbouring lanes at once, so that memory is read in rows.
void reduce_step(uint begin, uint end, const StepConstants& c, const uint& lane_count, const float4* position,
                 const float4* velocity, const float4* acceleration, const float* density_in, float4* extremes) {
    constexpr uint k_lanes = 512;
    for (uint lane = begin; lane < end; lane += k_lanes) {
        const uint lanes = end - lane < k_lanes ? end - lane : k_lanes;
        float4 e[k_lanes] = {};
        for (uint first = lane; first < c.particle_count; first += lane_count)
            for (uint k = 0; k < lanes && first + k < c.particle_count; ++k)
                e[k] = add_to_step(c, e[k], position[first + k].w, velocity[first + k], acceleration[first + k],
                                   density_in[first + k]);
        for (uint k = 0; k < lanes; ++k) extremes[lane + k] = e[k];
    }
}

// Neighbouring lanes at once, each in the order of the plain loop, so that memory is read in rows.
void anderson_sums(uint begin, uint end, const uint& count, const uint& lane_count, const float4* factor,
                   const float* residual, const float* u, const float* step, const float* step_1, const float* step_2,
                   float* sums) {
    constexpr uint k_vectors = 16;
    uint lane = begin;
    for (; lane + width <= end && lane + width <= lane_count; lane += k_vectors * width) {
        const uint fitting = (end < lane_count ? end : lane_count) - lane;
        const uint vectors = fitting / width < k_vectors ? fitting / width : k_vectors;
        SolveSums s[k_vectors];
        for (SolveSums& zero : s) zero = zero_sums();
        for (uint row = lane; row < count; row += lane_count)
            for (uint k = 0; k < vectors && row + k * width < count; ++k) {
                const uint i = row + k * width;
                const uint beyond = i + width > count ? i + width - count : 0;  // of the last row
                const uint within = ((1u << width) - 1u) >> beyond;
                s[k] = add_to_sums(s[k], load(factor + i).w, keep(within, load(residual + i)), load(u + i),
                                   keep(within, load(step + i)), keep(within, load(step_1 + i)),
                                   keep(within, load(step_2 + i)));
            }
        for (uint k = 0; k < vectors; ++k) {
            const uint first = lane + k * width;
            store(sums + first, s[k].residual);
            store(sums + lane_count + first, s[k].m00);
            store(sums + 2 * lane_count + first, s[k].m01);
            store(sums + 3 * lane_count + first, s[k].m11);
            store(sums + 4 * lane_count + first, s[k].y0);
            store(sums + 5 * lane_count + first, s[k].y1);
        }
        if (vectors < k_vectors) {
            lane += vectors * width;
            break;
        }
    }
    for (; lane < end; ++lane)
        ::anderson_sums(lane, count, lane_count, factor, residual, u, step, step_1, step_2, sums);
}

}  // namespace FONTANA_WIDE

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

KernelLoop FONTANA_WIDE_LOOP(const char* kernel) {
    const struct {
        const char* name;
        KernelLoop run;
    } table[] = {
#define WIDE(function) \
    {#function, &Loop<decltype(&::function), decltype(&FONTANA_WIDE::function)>::run<&FONTANA_WIDE::function>},
        WIDE(density) WIDE(fluid_force) WIDE(build_neighbor_list) WIDE(sum_neighborhood) WIDE(pressed_velocity)
            WIDE(pressure_residual) WIDE(pressure_gradient) WIDE(mark_crowded) WIDE(crowding_gradient) WIDE(move_apart)
                WIDE(sum_changed) WIDE(correct_pressure) WIDE(relax) WIDE(reduce_step) WIDE(anderson_sums)
                    WIDE(coarse_products)
#undef WIDE
    };
    for (const auto& row : table)
        if (__builtin_strcmp(row.name, kernel) == 0) return row.run;
    return nullptr;
}

}  // namespace fontana
