// Lists of neighbours for loops over vectors: one for every k_list_group particles in a row, of all that are a
// neighbour of at least one of them, themselves included. Each is read and turned round once for the group, and takes a
// third of the memory of its members' own lists. That a few on it are farther than the support radius from some member
// costs arithmetic and changes nothing: there W and its gradient are zero.
//
// Word 2 g of `list_start` is where the list of group g begins, word 2 g + 1 how long it is, and behind them stands the
// length of all of them. Included once per instruction set, by wide_kernels.cpp.
#pragma once

namespace fontana::FONTANA_WIDE {

// Up to k_list_group particles in a row; the last stands in for those beyond the end.
struct Members {
    Members(uint first_member, uint end, const float4* position) : first(first_member) {
        count = end - first < k_list_group ? end - first : k_list_group;
        for (uint s = 0; s < k_list_group; ++s) x[s] = position[first + (s < count ? s : count - 1)];
    }
    uint first, count;
    float4 x[k_list_group];
};

inline Vec least_distance_squared(const Members& members, const Vec4& x_j) {
    Vec least = distance_squared(members.x[0], x_j);
    for (uint s = 1; s < k_list_group; ++s) least = min_of(least, distance_squared(members.x[s], x_j));
    return least;
}

// Gathers lists and puts them, many at once, behind what other threads have put there. Where they lie depends on the
// threads; what they say does not.
class ListWriter {
 public:
    ListWriter(const StepConstants& c, uint* list_start, uint* list) : c_(c), list_start_(list_start), list_(list) {}

    void write(const Members& members, const Candidates& candidates) {
        const uint group = members.first / k_list_group;
        if (!candidates.are_few()) {
            flush();
            write_long(group, members, candidates);
            return;
        }
        if (count_ + Candidates::k_room > k_room) flush();
        if (count_ == 0) first_group_ = group;
        const uint begin = count_;
        candidates.for_all([&](const Vec4& x_j, const uint* index) {
            count_ += compress_store(hits(members, x_j), index, found_ + count_);
        });
        list_start_[2 * group] = begin;
        list_start_[2 * group + 1] = count_ - begin;
        next_group_ = group + 1;
    }

    void flush() {
        if (count_ == 0) return;
        const uint start = place(count_);
        for (uint group = first_group_; group < next_group_; ++group) list_start_[2 * group] += start;
        if (fits(start, count_)) __builtin_memcpy(list_ + start, found_, count_ * sizeof(uint));
        count_ = 0;
    }

 private:
    uint hits(const Members& members, const Vec4& x_j) const {
        return less_mask(least_distance_squared(members, x_j), c_.support_radius_squared);
    }

    uint place(uint count) const {
        return take_words(list_start_ + 2 * ((c_.particle_count + k_list_group - 1) / k_list_group), count);
    }

    // If not, the host sees the length of all of them and builds them anew.
    bool fits(uint start, uint count) const { return start <= c_.list_capacity && count <= c_.list_capacity - start; }

    // With more candidates than there is room for: counted first.
    void write_long(uint group, const Members& members, const Candidates& candidates) {
        uint count = 0;
        candidates.for_all(
            [&](const Vec4& x_j, const uint*) { count += static_cast<uint>(__builtin_popcount(hits(members, x_j))); });
        const uint start = place(count);
        list_start_[2 * group] = start;
        list_start_[2 * group + 1] = count;
        if (!fits(start, count)) return;
        uint* out = list_ + start;
        candidates.for_all([&](const Vec4& x_j, const uint* index) {
            uint found[2 * width];
            const uint more = compress_store(hits(members, x_j), index, found);
            __builtin_memcpy(out, found, more * sizeof(uint));
            out += more;
        });
    }

    static constexpr uint k_room = 4 * Candidates::k_room;
    const StepConstants& c_;
    uint* const list_start_;
    uint* const list_;
    uint count_ = 0, first_group_ = 0, next_group_ = 0;
    uint found_[k_room + width];
};

inline uint list_length_of(uint first, const uint* list_start) { return list_start[2 * (first / k_list_group) + 1]; }

// Calls visit(their indices, their positions) for every vector of neighbours on the list of the group that begins at
// particle `first`. Lanes beyond the end of the list have valid indices and weigh nothing.
template <typename Visit>
inline __attribute__((always_inline)) void for_list(uint first, const uint* list_start, const short* list,
                                                    const float4* position, const Visit& visit) {
    const uint count = list_length_of(first, list_start);
    const uint* const mine = reinterpret_cast<const uint*>(list) + list_start[2 * (first / k_list_group)];
    for (uint k = 0; k < count; k += width) {
        Vec4 x_j = gather(position, mine + k);
        if (count - k < width) x_j.w = keep((1u << (count - k)) - 1u, x_j.w);
        visit(mine + k, x_j);
    }
}

// The indices alone, one after the other.
template <typename Visit>
inline void for_indices(uint first, const uint* list_start, const short* list, const Visit& visit) {
    const uint* const mine = reinterpret_cast<const uint*>(list) + list_start[2 * (first / k_list_group)];
    for (uint k = 0; k < list_length_of(first, list_start); ++k) visit(mine[k]);
}

// Calls visit(its first particle, the one behind its last) for every group of which a member is marked.
template <typename Visit>
inline void for_marked_groups(const uint* mark, uint begin, uint end, const Visit& visit) {
    for (uint first = begin; first < end; first += k_list_group) {
        const uint last = end - first < k_list_group ? end : first + k_list_group;
        bool is_marked = false;
        for (uint i = first; i < last; ++i) is_marked = is_marked || mark[i] != 0u;
        if (is_marked) visit(first, last);
    }
}

}  // namespace fontana::FONTANA_WIDE
