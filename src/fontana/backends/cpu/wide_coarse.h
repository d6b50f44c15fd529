// The products for the coarse matrix (kernels/coarse.h) by vectors of neighbours. Included once per instruction set, by
// wide_kernels.cpp.
#pragma once

namespace fontana::FONTANA_WIDE {

// Neighbours as the coarse levels see them, a few vectors of them turned round for all particles of a cell that share
// their list.
struct CoarseNeighbors {
    static constexpr uint k_room = 8;
    Vec4 x[k_room];
    Vec weight[k_room];
    CoarseShares shares[k_room];
    uint count = 0;
};

// The columns of G P at one particle.
struct CoarseColumns {
    Vec8 x{}, y{}, z{};
};

// The sums of one axis of `pull`, by coarse cell.
template <REAL Real3::* axis>
Vec8 coarse_column(const CoarseNeighbors& neighbors, const Real3* pull) {
    CoarseSums sums{};
    for (uint k = 0; k < neighbors.count; ++k) sums = add_shared(sums, pull[k].*axis, neighbors.shares[k]);
    return sums_of(sums.of);
}

inline void add_coarse_neighbors(const StepConstants& c, const CoarseNeighbors& neighbors, const float4& x_i,
                                 CoarseColumns& a) {
    Real3 pull[CoarseNeighbors::k_room];
    for (uint k = 0; k < neighbors.count; ++k)
        pull[k] = coarse_pull(c, neighbors.weight[k], quick_pair_of(x_i, neighbors.x[k]));
    a.x += coarse_column<&Real3::x>(neighbors, pull);
    a.y += coarse_column<&Real3::y>(neighbors, pull);
    a.z += coarse_column<&Real3::z>(neighbors, pull);
}

// For the members of a group from the one numbered `from` on, which are in one cell.
inline void coarse_columns(const StepConstants& c, const Members& members, uint from, const float4* position,
                           const float* weight, const uint* list_start, const short* list, CoarseColumns* a) {
    CoarseNeighbors neighbors;
    const auto add_all = [&] {
        for (uint s = from; s < members.count; ++s) add_coarse_neighbors(c, neighbors, members.x[s], a[s]);
        neighbors.count = 0;
    };
    const float4 home = ::home_place(c, members.x[from]);
    for_list(members.first, list_start, list, position, [&](const uint* j, const Vec4& x_j) {
        const uint k = neighbors.count++;
        neighbors.x[k] = x_j;
        // What is beyond the end of the list has no mass.
        neighbors.weight[k] = x_j.w > 0.0f ? c.gradient_scale * gather(weight, j) : Vec{};
        neighbors.shares[k] = coarse_shares(home, coarse_place(c, x_j));
        if (neighbors.count == CoarseNeighbors::k_room) add_all();
    });
    add_all();
}

inline void coarse_products(uint begin, uint end, const StepConstants& c, const uint&, const uint* cell_start,
                            const float4* position, const float4* factor, const float* weight, const uint* list_start,
                            const short* list, float* table) {
    for (uint cell = begin; cell < end; ++cell) {
        const uint first = cell_start[cell], last = cell_start[cell + 1];
        if (last - first < COARSE_LEAST) continue;
        Vec8 product[8] = {};
        for (uint group = first / k_list_group * k_list_group; group < last; group += k_list_group) {
            const Members members(group, last, position);
            const uint from = first > group ? first - group : 0;
            CoarseColumns a[k_list_group];
            coarse_columns(c, members, from, position, weight, list_start, list, a);
            for (uint s = from; s < members.count; ++s) {
                const float4 own = weight[group + s] > 0.0f ? factor[group + s] : float4{};
                a[s].x[0] += own.x;
                a[s].y[0] += own.y;
                a[s].z[0] += own.z;
                for (uint p = 0; p < 8; ++p) product[p] += a[s].x[p] * a[s].x + a[s].y[p] * a[s].y + a[s].z[p] * a[s].z;
            }
        }
        float* out = table + first / COARSE_LEAST * COARSE_TABLE;
        for (uint p = 0; p < 8; ++p)
            for (uint q = p; q < 8; ++q) *out++ = product[p][q];
    }
}

}  // namespace fontana::FONTANA_WIDE
