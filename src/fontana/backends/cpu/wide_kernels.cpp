// The neighbour loops of the fast arithmetic, a vector of neighbours at once. Formulas are those of kernels/: pair.h
// and others are included a second time here, with vectors for REAL. Only the loops are this file's own, and each is
// tested against the plain one. Compiled once for each instruction set; FONTANA_WIDE is its name.
//
// Lists of neighbours are padded with the particle itself, which adds nothing to a gradient (x_ii = 0).
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
#include "kernels/anderson.h"
#include "kernels/coarse_pair.h"
#include "kernels/force_pair.h"
#include "kernels/pair.h"

// Hits of one particle collected before the forces are computed; flushed when full.
constexpr uint k_most_hits = 256;
// Farther than any particle can be from another and still be its neighbour, and its square is finite.
constexpr float k_far = 1.0e18f;

::Real3 sum_of(const Real3& v) { return {sum_of(v.x), sum_of(v.y), sum_of(v.z)}; }

// The candidates for neighbours of all the particles of one cell, in columns: read and turned round once, then tested
// by each of them from the first-level cache. Where there are more than fit, as with all pairs, each particle reads
// them for itself.
class Candidates {
 public:
    Candidates(const StepConstants& c, const float4* position, const uint* cell_start)
        : c_(c), position_(position), cell_start_(cell_start) {}

    // Calls visit(positions, their indices) for every vector of candidates of a particle at x_i. Lanes beyond the last
    // candidate are far from everything and weigh nothing.
    template <typename Visit>
    inline __attribute__((always_inline)) void for_all(const float4& x_i, const Visit& visit) {
        start(c_.use_grid ? cell_of(c_, x_i) : CellCoordinates{0u, 0u, 0u});
        if (fits_)
            for (uint k = 0; k < count_; k += width)
                visit(Vec4{load(x_ + k), load(y_ + k), load(z_ + k), load(w_ + k)}, index_ + k);
        else
            for_ranges([&](uint first, uint end) {
                alignas(64) uint index[width];
                store_indices(first, index);
                visit(blanked(load(position_ + first), end - first), index);
            });
    }

 private:
    // The cell before is often the cell still.
    void start(CellCoordinates cell) {
        if (cell.x == cell_.x && cell.y == cell_.y && cell.z == cell_.z) return;
        cell_ = cell;
        uint total = 0;
        for (uint k = 0; k < candidate_range_count(c_, cell); ++k) {
            const Range range = candidate_range(c_, cell, k, cell_start_);
            total += range.end - range.begin;
        }
        count_ = 0;
        fits_ = total <= k_room;
        if (!fits_) return;
        for_ranges([&](uint first, uint end) { take(load(position_ + first), first, end - first); });
        take(blanked(Vec4{}, 0), 0, 0);
    }

    // Calls visit(first, end of the range) for every vector of every range.
    template <typename Visit>
    inline __attribute__((always_inline)) void for_ranges(const Visit& visit) const {
        const uint range_count = candidate_range_count(c_, cell_);
        for (uint k = 0; k < range_count; ++k) {
            const Range range = candidate_range(c_, cell_, k, cell_start_);
            for (uint first = range.begin; first < range.end; first += width) visit(first, range.end);
        }
    }

    static Vec4 blanked(const Vec4& rows, uint valid) {
        if (valid >= width) return rows;
        const uint within = (1u << valid) - 1u;
        return {keep(within, rows.x) + keep(~within, k_far - Vec{}), keep(within, rows.y), keep(within, rows.z),
                keep(within, rows.w)};
    }

    void take(const Vec4& rows, uint first, uint valid) {
        store(x_ + count_, rows.x);
        store(y_ + count_, rows.y);
        store(z_ + count_, rows.z);
        store(w_ + count_, rows.w);
        store_indices(first, index_ + count_);
        count_ += valid < width ? valid : width;
    }

    static constexpr uint k_room = 512;
    const StepConstants& c_;
    const float4* position_;
    const uint* cell_start_;
    CellCoordinates cell_{~0u, ~0u, ~0u};
    uint count_ = 0;
    bool fits_ = false;
    alignas(64) float x_[k_room + width];
    alignas(64) float y_[k_room + width], z_[k_room + width], w_[k_room + width];
    alignas(64) uint index_[k_room + width];
};

Vec distance_squared(const float4& a, const Vec4& b) {
    const Vec dx = a.x - b.x, dy = a.y - b.y, dz = a.z - b.z;
    return dx * dx + dy * dy + dz * dz;
}

void density(uint begin, uint end, const StepConstants& c, const float4* position, const float4* velocity,
             const uint* cell_start, float* density_out, float4* packed_position, float4* packed_velocity) {
    Candidates candidates(c, position, cell_start);
    for (uint i = begin; i < end; ++i) {
        const float4 x_i = position[i];
        Vec sum{};
        candidates.for_all(x_i, [&](const Vec4& x_j, const uint*) {
            // At the support radius the kernel is zero.
            const Vec r_squared = min_f(distance_squared(x_i, x_j), c.support_radius_squared);
            sum += x_j.w * poly6(r_squared, c.support_radius_squared);
        });
        store_pressure_state(c, i, sum_of(sum), x_i, velocity[i], density_out, packed_position, packed_velocity);
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
        candidates.for_all(x_i, [&](const Vec4& x_j, const uint* index) {
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
                         uint* neighbor_count, uint* list) {
    Candidates candidates(c, position, cell_start);
    for (uint i = begin; i < end; ++i) {
        const float4 x_i = position[i];
        uint* const mine = list + std::size_t{i} * c.list_particle_stride;
        uint count = 0;
        candidates.for_all(x_i, [&](const Vec4& x_j, const uint* index) {
            uint hits = less_mask(distance_squared(x_i, x_j), c.support_radius_squared) & ~equal_mask(index, i);
            if (count + width <= c.list_capacity)
                count += compress_store(hits, index, mine + count);
            else
                for (; hits; hits &= hits - 1, ++count)
                    if (count < c.list_capacity) mine[count] = index[__builtin_ctz(hits)];
        });
        neighbor_count[i] = count;
        pad_list(c, list, i, count);
    }
}

// Calls visit(indices of a vector of neighbours, their volumes and positions, pair) along the list of particle i.
template <typename Visit>
inline __attribute__((always_inline)) void for_list(const StepConstants& c, uint i, const uint* neighbor_count,
                                                    const uint* list, const float4* volume_position,
                                                    const Visit& visit) {
    const uint* const mine = list + std::size_t{i} * c.list_particle_stride;
    const uint count = list_length(c, neighbor_count[i]);
    const float4 x_i = volume_position[i];
    for (uint k = 0; k < count; k += width) {
        const Vec4 x_j = gather(volume_position, mine + k);
        visit(mine + k, x_j, pair_of(x_i, x_j));
    }
}

void sum_neighborhood(uint begin, uint end, const StepConstants& c, const float4* position, const float4* velocity,
                      const uint* neighbor_count, const uint* list, const float4* volume_position,
                      const ColliderConstants* collider, float* density_out, float4* factor, float* wall_rate,
                      float* rate, float4* viscous) {
    for (uint i = begin; i < end; ++i) {
        const float4 v_i = velocity[i];
        Vec relative{}, squares{}, approach{};
        Real3 s = zero_vector(), shear = zero_vector();
        for_list(c, i, neighbor_count, list, volume_position, [&](const uint* j, const Vec4& x_j, const Pair& pair) {
            const Vec4 v_j = gather(velocity, j);
            relative += without(x_j.w * kernel_value(c, pair.r), j, i);
            s = add_gradient(s, c, x_j.w, pair);
            squares += gradient_squared_term(c, x_j.w, pair);
            approach += divergence_term(c, x_j.w, pair, v_j);
            shear = add_gradient(shear, c, viscosity_weight(c, x_j.w, pair, v_i, v_j), pair);
        });
        const WallTerm walls = walls_at(c, collider, position[i]);
        const float volume = volume_position[i].w;
        const float own = volume * ::kernel_value(c, 0.0f) + walls.share;
        store_density(c, i, volume, own + sum_of(relative), sum_of(s), sum_of(squares), walls, density_out, factor,
                      wall_rate);
        rate[i] = divergence_of(factor[i], v_i, sum_of(approach)) - walls.rate;
        store_viscosity(c, i, sum_of(shear), viscous);
    }
}

float divergence(const StepConstants& c, uint i, const uint* neighbor_count, const uint* list,
                 const float4* volume_position, const float4* factor, const float4* field) {
    Vec sum{};
    for_list(c, i, neighbor_count, list, volume_position, [&](const uint* j, const Vec4& x_j, const Pair& pair) {
        sum += divergence_term(c, x_j.w, pair, gather(field, j));
    });
    return divergence_of(factor[i], field[i], sum_of(sum));
}

void density_rate(uint begin, uint end, const StepConstants& c, const float4* velocity, const uint* neighbor_count,
                  const uint* list, const float4* volume_position, const float4* factor, const float* wall_rate,
                  float* rate) {
    for (uint i = begin; i < end; ++i)
        rate[i] = divergence(c, i, neighbor_count, list, volume_position, factor, velocity) - wall_rate[i];
}

void pressure_residual(uint begin, uint end, const StepConstants& c, const float4* gradient, const uint* neighbor_count,
                       const uint* list, const float4* volume_position, const float4* factor, const float* target,
                       float* residual) {
    for (uint i = begin; i < end; ++i) {
        const float k_u = divergence(c, i, neighbor_count, list, volume_position, factor, gradient);
        residual[i] = factor[i].w > 0.0f ? target[i] - k_u : 0.0f;
    }
}

void pressure_gradient(uint begin, uint end, const StepConstants& c, const float* u, const uint* neighbor_count,
                       const uint* list, const float4* volume_position, const float4* factor, float4* gradient) {
    for (uint i = begin; i < end; ++i) {
        Real3 sum = zero_vector();
        for_list(c, i, neighbor_count, list, volume_position, [&](const uint* j, const Vec4& x_j, const Pair& pair) {
            sum = add_gradient(sum, c, x_j.w * gather(u, j), pair);
        });
        store_gradient(i, u[i], factor[i], sum_of(sum), gradient);
    }
}

void correct_pressure(uint begin, uint end, const StepConstants& c, float delta, const float4* predicted,
                      const uint* neighbor_count, const uint* list, const ColliderConstants* collider,
                      const float4* factor, float* u, float* residual) {
    for (uint i = begin; i < end; ++i) {
        Vec relative{};
        for_list(c, i, neighbor_count, list, predicted, [&](const uint* j, const Vec4& x_j, const Pair& pair) {
            relative += without(x_j.w * kernel_value(c, pair.r), j, i);
        });
        const float4 x_i = predicted[i];
        const float own = x_i.w * ::kernel_value(c, 0.0f) + walls_at(c, collider, x_i).share;
        store_correction(c, i, delta, own + sum_of(relative), factor, u, residual);
    }
}

CoarseGradient coarse_gradient(const StepConstants& c, uint i, const float4* volume_position, const float* weight,
                               const uint* neighbor_count, const uint* list) {
    const uint* const mine = list + std::size_t{i} * c.list_particle_stride;
    const uint count = list_length(c, neighbor_count[i]);
    const float4 x_i = volume_position[i];
    CoarseGradient a = no_coarse_gradient();
    for (uint k = 0; k < count; k += width)
        a = add_coarse_gradient(a, c, gather(weight, mine + k), x_i, gather(volume_position, mine + k));
    return a;
}

void coarse_products(uint begin, uint end, const StepConstants& c, const uint&, const uint* cell_start,
                     const float4* volume_position, const float4* factor, const float* weight,
                     const uint* neighbor_count, const uint* list, float* table) {
    for (uint cell = begin; cell < end; ++cell) {
        const uint first = cell_start[cell], last = cell_start[cell + 1];
        if (last - first < COARSE_LEAST) continue;
        Vec8 product[8] = {};
        for (uint i = first; i < last; ++i) {
            const CoarseGradient a = coarse_gradient(c, i, volume_position, weight, neighbor_count, list);
            Vec8 x = sums_of(a.x), y = sums_of(a.y), z = sums_of(a.z);
            if (weight[i] > 0.0f) {
                x[0] += factor[i].x;
                y[0] += factor[i].y;
                z[0] += factor[i].z;
            }
            for (uint p = 0; p < 8; ++p) product[p] += x[p] * x + y[p] * y + z[p] * z;
        }
        float* out = table + first / COARSE_LEAST * COARSE_TABLE;
        for (uint p = 0; p < 8; ++p)
            for (uint q = p; q < 8; ++q) *out++ = product[p][q];
    }
}

// Neighbouring lanes of the sums at once, each in the order of the plain loop.
void anderson_sums(uint begin, uint end, const uint& count, const uint& lane_count, const float4* factor,
                   const float* residual, const float* u, const float* step, const float* step_1, const float* step_2,
                   float* sums) {
    uint lane = begin;
    for (; lane + width <= end && lane + width <= lane_count; lane += width) {
        SolveSums s = zero_sums();
        for (uint i = lane; i < count; i += lane_count) {
            const uint beyond = i + width > count ? i + width - count : 0;  // of the last row
            const uint within = ((1u << width) - 1u) >> beyond;
            s = add_to_sums(s, load(factor + i).w, keep(within, load(residual + i)), load(u + i),
                            keep(within, load(step + i)), keep(within, load(step_1 + i)),
                            keep(within, load(step_2 + i)));
        }
        store(sums + lane, s.residual);
        store(sums + lane_count + lane, s.m00);
        store(sums + 2 * lane_count + lane, s.m01);
        store(sums + 3 * lane_count + lane, s.m11);
        store(sums + 4 * lane_count + lane, s.y0);
        store(sums + 5 * lane_count + lane, s.y1);
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
        WIDE(density) WIDE(fluid_force) WIDE(build_neighbor_list) WIDE(sum_neighborhood) WIDE(density_rate)
            WIDE(pressure_residual) WIDE(pressure_gradient) WIDE(correct_pressure) WIDE(anderson_sums)
                WIDE(coarse_products)
#undef WIDE
    };
    for (const auto& row : table)
        if (__builtin_strcmp(row.name, kernel) == 0) return row.run;
    return nullptr;
}

}  // namespace fontana
